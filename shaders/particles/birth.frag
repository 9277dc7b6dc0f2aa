#version 330 core
// Newborn particles, one a pixel: from the emitter, or from a parent. Each of their qualities is drawn from its range
// by a random number that depends on the seed and on how many were born before, and on nothing else.
#include "particles/emitter.glsl"
#include "particles/collider.glsl"

uniform sampler2D u_motion, u_velocity, u_launch;   // of the particles that may be parents
uniform usampler2D u_parents;                       // for each newborn its parent's slot
uniform int u_width;                                // slots in a row
uniform int u_batch_width;                          // newborns in a row
uniform int u_count;                                // of newborns
uniform bool u_from_parents;
uniform uint u_serial;                              // of the first newborn
uniform uint u_seed;
uniform float u_first_lived;                        // how much of the step the first newborn has lived, in seconds
uniform float u_between;                            // seconds from one birth to the next
uniform float u_step;

uniform vec2 u_lifetime, u_children_lifetime, u_grandchildren_lifetime, u_great_grandchildren_lifetime;
uniform vec2 u_speed, u_children_speed, u_grandchildren_speed, u_great_grandchildren_speed;
uniform vec2 u_size, u_children_size, u_grandchildren_size, u_great_grandchildren_size;
uniform float u_spread, u_children_spread, u_grandchildren_spread, u_great_grandchildren_spread;
uniform float u_children_inherit, u_grandchildren_inherit, u_great_grandchildren_inherit;
uniform vec2 u_mass, u_drag;
uniform float u_wave_width;
uniform float u_wave_reach;                         // how far the wave has come, in metres; negative for no wave

const int MOST_PUSHES = 8;
const float FAMILIES = 0.99;        // what is beside the generation tells a family, and never makes another one

layout(location = 0) out vec4 out_motion;
layout(location = 1) out vec4 out_velocity;
layout(location = 2) out vec4 out_nature;
layout(location = 3) out vec4 out_origin;
layout(location = 4) out vec4 out_launch;

struct Plan {           // what the ranges are for a generation
    vec2 lifetime, speed, size;
    float spread, inherit;
};

Plan plan_of(int generation) {
    if (generation == 0)
        return Plan(u_lifetime, u_speed, u_size, u_spread, 0.0);
    if (generation == 1)
        return Plan(u_children_lifetime, u_children_speed, u_children_size, u_children_spread, u_children_inherit);
    if (generation == 2)
        return Plan(u_grandchildren_lifetime, u_grandchildren_speed, u_grandchildren_size, u_grandchildren_spread,
                    u_grandchildren_inherit);
    return Plan(u_great_grandchildren_lifetime, u_great_grandchildren_speed, u_great_grandchildren_size,
                u_great_grandchildren_spread, u_great_grandchildren_inherit);
}

float drawn(vec2 range, inout uint random_state) {
    return mix(range.x, range.y, next_random(random_state));
}

// A place on a sphere moved into the ring, as wide as the wave, that has run so far from the top; evenly by area.
void ride_wave(inout vec3 place, inout vec3 normal) {
    vec3 up = turned(vec3(0.0, 1.0, 0.0));
    float height = dot(normal, up);
    float nearest = cos(clamp((u_wave_reach - u_wave_width) / u_emitter_size, 0.0, 3.14159265));
    float farthest = cos(clamp(u_wave_reach / u_emitter_size, 0.0, 3.14159265));
    float raised = mix(farthest, nearest, 0.5 * height + 0.5);
    vec3 around = normalize(normal - height * up + 1e-6 * turned(vec3(1.0, 0.0, 0.0)));
    vec3 moved = raised * up + sqrt(max(0.0, 1.0 - raised * raised)) * around;
    float depth = dot(place - vec3(0.0, u_emitter_height, 0.0), normal);     // from the centre
    place += depth * (moved - normal);
    normal = moved;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int index = pixel.y * u_batch_width + pixel.x;
    uint identity = pcg(u_serial + uint(index) + pcg(u_seed));
    uint random_state = identity;
    float lived = clamp(u_first_lived - float(index) * u_between, 0.0, u_step);

    vec3 place, normal, carried = vec3(0.0);
    int generation = 0;
    float kin = random_of(identity, 61u);
    emission_place(random_state, place, normal);
    if (u_wave_reach >= 0.0)
        ride_wave(place, normal);
    if (u_from_parents) {
        int parent = int(texelFetch(u_parents, pixel, 0).r);
        ivec2 slot = ivec2(parent % u_width, parent / u_width);
        vec4 launch = texelFetch(u_launch, slot, 0);
        vec3 velocity = texelFetch(u_velocity, slot, 0).xyz;
        generation = int(launch.w) + 1;
        kin = fract(launch.w) / FAMILIES;
        lived = u_step * next_random(random_state);
        place = texelFetch(u_motion, slot, 0).xyz;
        bool alight = HAS_COLLIDER && collider_distance(place) < 0.02;
        if (!alight)
            place -= lived * velocity;
        float quickness = length(velocity);
        normal = alight ? collider_normal(place) : quickness > 1e-4 ? velocity / quickness : vec3(0.0, 1.0, 0.0);
        carried = velocity;
    }
    Plan plan = plan_of(generation);
    vec3 direction = emission_direction(random_state, normal, plan.spread);
    vec3 velocity = plan.inherit * carried + drawn(plan.speed, random_state) * direction;
    float lifetime = drawn(plan.lifetime, random_state);
    float size = drawn(plan.size, random_state), mass = drawn(u_mass, random_state), drag = drawn(u_drag, random_state);
    if (HAS_COLLIDER) {                         // whoever is born inside something is pushed out of it, or not born
        for (int push = 0; push < MOST_PUSHES; ++push)      // sampled distances are smaller than true ones
            place += max(0.0, collider_clearance(place) - collider_distance(place)) * collider_normal(place);
        if (collider_distance(place) < 0.0)
            lifetime = 0.0;
    }
    out_motion = vec4(place, index < u_count ? lifetime : 0.0);
    out_velocity = vec4(velocity, float((identity >> 8u) | 1u));
    out_nature = vec4(lifetime, size, mass, drag);
    out_origin = vec4(place, lived);
    out_launch = vec4(velocity, float(generation) + FAMILIES * kin);
}
