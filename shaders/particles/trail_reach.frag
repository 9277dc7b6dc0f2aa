#version 330 core
// How far back each particle's trail reaches: as long as its length allows, as far as memory goes, and not beyond
// the place where it was born. Notes lie behind the particle at known ages, so that no life is mistaken for another.
#include "particles/paths.glsl"
#include "generated/look.glsl"
#include "particles/life_color.glsl"
#include "particles/sprite_kinds.glsl"
#include "particles/telling_color.glsl"

uniform sampler2D u_motion, u_velocity, u_nature, u_origin, u_launch;   // see step.frag
uniform int u_notes;                // that have been taken, at most one for each block
uniform int u_newest;               // the block of the newest
uniform float u_newest_age;         // how long ago it was taken, in seconds
uniform float u_gap;                // seconds from one to the next
uniform float u_late;               // what is taken so much after a birth, in seconds, tells less than the birthplace
uniform float u_trail_seconds, u_trail_length, u_trail_width, u_trail_opacity;
uniform float u_opacity, u_glow;

layout(location = 0) out vec4 out_end;      // where it ends, and how many notes lie before
layout(location = 1) out vec4 out_reach;    // the way from birth to the particle, the trail's length, half its width
layout(location = 2) out vec4 out_light;    // linear, and opacity

const int HALVINGS = 7;

float age_of(int note) {
    return note == 0 ? 0.0 : u_newest_age + float(note - 1) * u_gap;
}

vec4 noted(ivec2 slot, int note) {
    int block = u_newest - note + 1;
    return path_point(slot, block < 0 ? block + PATH_POINTS : block);
}

void main() {
    ivec2 slot = ivec2(gl_FragCoord.xy);
    vec4 motion = texelFetch(u_motion, slot, 0), nature = texelFetch(u_nature, slot, 0);
    vec3 birthplace = texelFetch(u_origin, slot, 0).xyz;
    float age = nature.x - motion.w, own = age - u_late;

    float oldest = min(own, u_trail_seconds);
    int most = oldest <= u_newest_age ? 0 : int(ceil((oldest - u_newest_age) / u_gap));
    most = clamp(most, 0, u_notes);
    vec4 latest = texelFetch(u_latest, slot, 0);
    bool has_latest = u_notes > 0 && u_newest_age < own;
    float way = has_latest ? latest.w + distance(motion.xyz, latest.xyz) : distance(motion.xyz, birthplace);

    int last = 0, beyond = most;            // the last note that is near enough
    for (int step = 0; step < HALVINGS; ++step) {
        int middle = (last + beyond + 1) / 2;
        bool near = way - noted(slot, max(middle, 1)).w <= u_trail_length;
        last = near ? middle : last;
        beyond = near ? beyond : middle - 1;
    }
    vec4 here = last == 0 ? vec4(motion.xyz, way) : noted(slot, last);
    bool has_next = last < u_notes && age_of(last + 1) < own;
    bool meets_birth = age_of(last + 1) >= own;
    vec3 next = has_next ? noted(slot, last + 1).xyz : birthplace;
    float next_age = has_next ? age_of(last + 1) : age;
    float stretch = distance(here.xyz, next), gone = way - here.w;
    float by_length = (u_trail_length - gone) / max(stretch, 1e-9);
    float by_time = (u_trail_seconds - age_of(last)) / max(next_age - age_of(last), 1e-9);
    float part = has_next || meets_birth ? clamp(min(by_length, by_time), 0.0, 1.0) : 0.0;

    float over = age / max(nature.x, 1e-9), extent = gone + part * stretch;
    vec2 size_and_opacity = over_life(over, 0).xy;
    float width = motion.w > 0.0 ? u_trail_width * nature.y * size_and_opacity.x : 0.0;
    width *= smoothstep(0.0, 2.0 * width + 1e-9, extent);       // what rests shrinks to nothing
    vec4 velocity = texelFetch(u_velocity, slot, 0);
    float family = texelFetch(u_launch, slot, 0).w;
    Qualities of = Qualities(uint(abs(velocity.w)), int(family), fract(family), over, length(velocity.xyz), nature.z,
                             nature.y, width);
    vec4 light = vec4(u_glow * own_shade(life_color(over, of.generation), of.identity, of.kin),
                      size_and_opacity.y * u_opacity);
    if (COLOURING != BY_LOOK)
        light = vec4(telling_color(of), 1.0);
    out_end = vec4(mix(here.xyz, next, part), float(last));
    out_reach = vec4(way, extent, 0.5 * width, 0.0);
    out_light = vec4(light.rgb, light.a * u_trail_opacity);
}
