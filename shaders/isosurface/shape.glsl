// What a field's surface is like at a place: which way it faces and how it bends.
// vec3 surface_normal(vec3 place): towards larger values, of length one; zero where there is none.
// float mean_curvature(vec3 place): half the divergence of the normal, positive where the inside bulges out.

vec3 surface_normal(vec3 place) {
    vec3 slope = field_gradient(place);
    float size = length(slope);
    return size > 0.0 && size < 3.0e38 ? slope / size : vec3(0.0);
}

float mean_curvature(vec3 place) {
    float reach = 0.1 * min(u_grid_step.x, min(u_grid_step.y, u_grid_step.z));
    float divergence = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        vec3 aside = vec3(0.0);
        aside[axis] = reach;
        divergence += surface_normal(place + aside)[axis] - surface_normal(place - aside)[axis];
    }
    return divergence / (4.0 * reach);
}
