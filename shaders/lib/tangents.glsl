// Two directions along a surface.
// void tangents(vec3 normal, out vec3 first, out vec3 second): at right angles, such that cross(first, second) is
// the normal, for a normal of length one.

void tangents(vec3 normal, out vec3 first, out vec3 second) {
    vec3 helper = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    first = normalize(cross(helper, normal));
    second = cross(normal, first);
}
