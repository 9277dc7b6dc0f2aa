// Where particles are born: on the surface, the edges or in the volume of a shape, as likely in one part as in
// another of the same size. Turned and lifted into the world; normals point outwards and have length 1.
// void emission_place(inout uint random_state, out vec3 place, out vec3 normal)
// vec3 emission_direction(inout uint random_state, vec3 normal, float spread_degrees): within that angle of the
// normal, uniform by solid angle; 0 is the normal itself, 180 every direction.
//
// A shape stands around the y axis. Flat shapes have no volume: the surface stands for it. Where faces meet in
// an edge the normal is their mean, at the rim of a flat shape the face's own. In a volume it points away from
// the centre (sphere), from the ring (torus) or the axis (cone), along the axis (box), or as at a surface near
// by (mesh).

#include "particles/random.glsl"
#include "generated/emitter.glsl"

uniform float u_emitter_size;
uniform float u_emitter_thickness;
uniform float u_emitter_scale;
uniform float u_emitter_height;
uniform float u_emitter_tilt;
uniform float u_emitter_heading;
uniform int u_emitter_entries;              // of the table that a mesh's points are drawn from
uniform sampler2D u_emitter_places;         // see viewer/kit/surface_sampling.py
uniform sampler2D u_emitter_normals;

const float FULL_TURN = 6.283185307179586;

vec3 on_circle(float angle) {
    return vec3(sin(angle), 0.0, cos(angle));
}

vec3 any_direction(inout uint random_state) {
    float y = 2.0 * next_random(random_state) - 1.0;
    float angle = FULL_TURN * next_random(random_state);
    return normalize(vec3(0.0, y, 0.0) + sqrt(max(0.0, 1.0 - y * y)) * on_circle(angle));
}

void in_square(inout uint random_state, out vec3 place, out vec3 normal) {
    float across = 2.0 * next_random(random_state) - 1.0;
    float along = 2.0 * next_random(random_state) - 1.0;
    normal = vec3(0.0, 1.0, 0.0);
    if (EMIT_FROM == FROM_EDGE) {
        uint side = (random_state = pcg(random_state)) >> 30u;
        float border = (side & 1u) == 0u ? -1.0 : 1.0;
        place = u_emitter_size * (side < 2u ? vec3(across, 0.0, border) : vec3(border, 0.0, along));
    } else {
        place = u_emitter_size * vec3(across, 0.0, along);
    }
}

void in_disc(inout uint random_state, out vec3 place, out vec3 normal) {
    float reach = EMIT_FROM == FROM_EDGE ? 1.0 : sqrt(next_random(random_state));
    place = u_emitter_size * reach * on_circle(FULL_TURN * next_random(random_state));
    normal = vec3(0.0, 1.0, 0.0);
}

void in_sphere(inout uint random_state, out vec3 place, out vec3 normal) {
    if (EMIT_FROM == FROM_EDGE) {           // a sphere has none: its equator
        normal = on_circle(FULL_TURN * next_random(random_state));
    } else {
        normal = any_direction(random_state);
    }
    float reach = EMIT_FROM == FROM_VOLUME ? pow(next_random(random_state), 1.0 / 3.0) : 1.0;
    place = u_emitter_size * reach * normal;
}

// The farther from the axis, the longer is a circle around it: at the angle a around the tube by 1 + k cos(a),
// k the part of the ring's radius. To hit that exactly, a point that is one too many on one side of the tube
// changes to the opposite one: with a chance of (1 - k cos(a)) / 2.
void in_torus(inout uint random_state, out vec3 place, out vec3 normal) {
    float tube = min(u_emitter_thickness, u_emitter_size);
    float reach = EMIT_FROM == FROM_VOLUME ? sqrt(next_random(random_state)) : 1.0;
    vec3 outward = on_circle(FULL_TURN * next_random(random_state));
    vec2 turn = vec2(1.0, 0.0);
    if (EMIT_FROM != FROM_EDGE) {           // its outermost circle
        float angle = FULL_TURN * next_random(random_state);
        turn = vec2(cos(angle), sin(angle));
        float share = 0.5 + 0.5 * reach * tube / u_emitter_size * turn.x;
        if (next_random(random_state) >= share) {
            turn = -turn;
        }
    }
    normal = normalize(turn.x * outward + vec3(0.0, turn.y, 0.0));
    place = u_emitter_size * outward + reach * tube * normal;
}

// (a, b, c) with the first of them at place `axis`.
vec3 starting_at(int axis, vec3 numbers) {
    return axis == 0 ? numbers.xyz : axis == 1 ? numbers.zxy : numbers.yzx;
}

int chosen_axis(vec3 weights, float chance) {
    float level = chance * (weights.x + weights.y + weights.z);
    return level < weights.x ? 0 : level < weights.x + weights.y ? 1 : 2;
}

void in_box(inout uint random_state, out vec3 place, out vec3 normal) {
    vec3 extents = vec3(u_emitter_size, u_emitter_thickness, u_emitter_size);
    float first = 2.0 * next_random(random_state) - 1.0;
    float second = 2.0 * next_random(random_state) - 1.0;
    float third = 2.0 * next_random(random_state) - 1.0;
    normal = vec3(0.0, 1.0, 0.0);
    if (EMIT_FROM == FROM_VOLUME) {
        place = extents * vec3(first, second, third);
        return;
    }
    float chance = next_random(random_state);
    float side = third < 0.0 ? -1.0 : 1.0;
    if (EMIT_FROM == FROM_EDGE) {
        int axis = chosen_axis(extents, chance);
        float other = second < 0.0 ? -1.0 : 1.0;
        place = extents * starting_at(axis, vec3(first, other, side));
        normal = starting_at(axis, vec3(0.0, other, side)) * sqrt(0.5);
    } else {
        int axis = chosen_axis(extents.yzx * extents.zxy, chance);
        place = extents * starting_at(axis, vec3(side, first, second));
        normal = starting_at(axis, vec3(side, 0.0, 0.0));
    }
}

void in_cone(inout uint random_state, out vec3 place, out vec3 normal) {
    float radius = u_emitter_size, height = u_emitter_thickness;
    float slant = length(vec2(radius, height));
    vec3 outward = on_circle(FULL_TURN * next_random(random_state));
    vec3 mantle = (height * outward + vec3(0.0, radius, 0.0)) / slant;
    float across = sqrt(next_random(random_state));         // from the apex, or from the middle of the base
    if (EMIT_FROM == FROM_EDGE) {
        place = radius * outward;
        normal = normalize(mantle - vec3(0.0, 1.0, 0.0));
    } else if (EMIT_FROM == FROM_VOLUME) {
        float below = pow(next_random(random_state), 1.0 / 3.0);
        place = radius * below * across * outward + vec3(0.0, height * (1.0 - below), 0.0);
        normal = outward;
    } else if (next_random(random_state) * (radius + slant) < radius) {
        place = radius * across * outward;
        normal = vec3(0.0, -1.0, 0.0);
    } else {
        place = radius * across * outward + vec3(0.0, height * (1.0 - across), 0.0);
        normal = mantle;
    }
}

ivec2 texel_of(uint number) {
    return ivec2(number % EMITTER_TABLE_WIDTH, number / EMITTER_TABLE_WIDTH);
}

vec4 table_place(uint entry, uint corner) {
    uint corners = EMIT_FROM == FROM_SURFACE ? 3u : EMIT_FROM == FROM_EDGE ? 2u : 1u;
    return texelFetch(u_emitter_places, texel_of(entry * corners + corner), 0);
}

vec3 table_normal(uint number) {
    return texelFetch(u_emitter_normals, texel_of(number), 0).xyz;
}

// An entry of the table, by its area or length: each is as likely, and hands some of those who come to its alias.
uint chosen_entry(inout uint random_state) {
    random_state = pcg(random_state);
    uint entry = random_state % uint(max(u_emitter_entries, 1));
    if (EMIT_FROM != FROM_VOLUME && next_random(random_state) >= table_place(entry, 0u).w) {
        entry = uint(table_place(entry, 1u).w);
    }
    return entry;
}

void in_mesh(inout uint random_state, out vec3 place, out vec3 normal) {
    uint entry = chosen_entry(random_state);
    float first = next_random(random_state);
    if (EMIT_FROM == FROM_VOLUME) {
        vec4 ball = table_place(entry, 0u);
        place = ball.xyz + 0.99 * ball.w * pow(first, 1.0 / 3.0) * any_direction(random_state);
        normal = table_normal(entry);
    } else if (EMIT_FROM == FROM_EDGE) {
        place = mix(table_place(entry, 0u).xyz, table_place(entry, 1u).xyz, first);
        normal = table_normal(entry);
    } else {
        // Osada et al., "Shape Distributions", 2002: uniform in a triangle.
        float across = sqrt(first), second = next_random(random_state);
        vec3 part = vec3(1.0 - across, across * (1.0 - second), across * second);
        place = part.x * table_place(entry, 0u).xyz + part.y * table_place(entry, 1u).xyz
              + part.z * table_place(entry, 2u).xyz;
        normal = part.x * table_normal(3u * entry) + part.y * table_normal(3u * entry + 1u)
               + part.z * table_normal(3u * entry + 2u);
    }
    place *= u_emitter_scale;
    normal = normalize(normal);
}

// The axis leans from up towards +x by the tilt, and goes around y, seen from above counter-clockwise, by the heading.
vec3 turned(vec3 vector) {
    float tilt = radians(u_emitter_tilt), heading = radians(u_emitter_heading);
    vec3 leaning = vec3(cos(tilt) * vector.x + sin(tilt) * vector.y, cos(tilt) * vector.y - sin(tilt) * vector.x, vector.z);
    return vec3(cos(heading) * leaning.x + sin(heading) * leaning.z, leaning.y,
                cos(heading) * leaning.z - sin(heading) * leaning.x);
}

void emission_place(inout uint random_state, out vec3 place, out vec3 normal) {
    place = vec3(0.0);
    normal = vec3(0.0, 1.0, 0.0);
    if (EMITTER_SHAPE == SHAPE_DISC) {
        in_disc(random_state, place, normal);
    } else if (EMITTER_SHAPE == SHAPE_SPHERE) {
        in_sphere(random_state, place, normal);
    } else if (EMITTER_SHAPE == SHAPE_TORUS) {
        in_torus(random_state, place, normal);
    } else if (EMITTER_SHAPE == SHAPE_BOX) {
        in_box(random_state, place, normal);
    } else if (EMITTER_SHAPE == SHAPE_CONE) {
        in_cone(random_state, place, normal);
    } else if (EMITTER_SHAPE == SHAPE_GROUND) {
        in_square(random_state, place, normal);
    } else if (EMITTER_SHAPE == SHAPE_MESH || EMITTER_SHAPE == SHAPE_FISH) {
        in_mesh(random_state, place, normal);
    }
    if (EMITTER_SHAPE != SHAPE_GROUND) {        // which stays level
        place = turned(place);
        normal = turned(normal);
    }
    place.y += u_emitter_height;
}

// Two directions at right angles to a unit vector and to each other, without a branch that jumps but at z = 0:
// Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
vec3 emission_direction(inout uint random_state, vec3 normal, float spread_degrees) {
    float half_sine = sin(0.5 * radians(spread_degrees));
    float drop = 2.0 * half_sine * half_sine * next_random(random_state);     // 1 less the cosine, without its rounding
    float across = sqrt(max(0.0, drop * (2.0 - drop)));
    float angle = FULL_TURN * next_random(random_state);
    float side = normal.z < 0.0 ? -1.0 : 1.0;
    float scale = -1.0 / (side + normal.z), product = normal.x * normal.y * scale;
    vec3 first = vec3(1.0 + side * normal.x * normal.x * scale, side * product, -side * normal.x);
    vec3 second = vec3(product, side + normal.y * normal.y * scale, -normal.y);
    return (1.0 - drop) * normal + across * (cos(angle) * first + sin(angle) * second);
}
