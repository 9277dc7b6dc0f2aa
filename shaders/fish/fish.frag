#version 330 core
// The skin of the fish: pattern, scales, face, fins and eyes, wet, in the light under water.
// From generated/drawn.glsl: BODY to EYE, the parts of a fish; COLOURING, what the colours tell; and FINE, whether
// scales and rays are large enough to show. What a species' file leaves out, such as eyes of its own, stands here.
#include "lib/underwater.glsl"
#include "lib/color.glsl"
#include "particles/random.glsl"
#include "generated/drawn.glsl"

uniform int u_school;
uniform int u_pattern_seed;
uniform float u_girth;            // around the body where it is largest, in body lengths
uniform float u_iridescence;
uniform vec3 u_ground_color;      // what the pattern lies on
uniform vec3 u_pattern_color;     // bars, clouds, patches or finlets

in vec3 v_position;
in vec3 v_normal;
in vec3 v_rest;
in vec2 v_coordinates;            // along and around the body, along the root and out on a fin, ahead and up on an eye
in vec2 v_lattice;                // girths from the nose; on fins, how many rays they have
in vec4 v_telling;
in vec4 v_light;                  // on a fish that is far: the light that falls on it, and how much the water hides
flat in vec3 v_ahead;
flat in int v_part;
flat in uint v_fish;

out vec4 out_color;

// In a school everybody is another fish of its kind.
float pattern_start() {
    return float(u_pattern_seed + (u_school > 1 ? int(v_fish & 255u) : 0));
}

#include "generated/fish.glsl"
#include "fish/scales.glsl"
#include "fish/face.glsl"
#include "fish/fin_rays.glsl"
#include "fish/eye.glsl"
#include "fish/iridescence.glsl"

Spot spot_here() {
    float pixel = 2.0 / (gl_FragCoord.w * u_frame.projection[1][1] * u_frame.resolution.y);
    float back = cos(6.2831853 * v_coordinates.y), around = v_coordinates.y;
    if (v_part != BODY) {
        back = v_part == DORSAL ? 1.0 : v_part == ANAL ? -1.0 : 0.0;
        around = v_part == DORSAL ? -0.3 * v_coordinates.y : 0.5 + 0.3 * v_coordinates.y;
    }
    float slant = v_part == DORSAL ? FIN_SLANT * v_coordinates.y : 0.0;
    return Spot(v_rest, 0.5 - v_rest.x + slant, back, vec2(v_lattice.x, around), pixel);
}

Finish body_finish(Spot spot, vec3 color, inout vec3 normal, vec3 to_eye) {
    Skin skin = body_skin(spot, color);
    if (!FINE)
        return Finish(skin.color, vec3(skin.mirror), skin.roughness, 0.0);
    Face face = face_at(spot);
    Scale scale = scale_at(float(u_columns) * spot.lattice);
    float scale_pixels = u_girth / (float(u_columns) * spot.pixel);
    float shown = skin.scales * (1.0 - face.bare) * smoothstep(1.5, 5.0, scale_pixels);
    float chance = float(scale.identity >> 8u) / 16777216.0;
    skin.color *= 1.0 + shown * (0.22 * (chance - 0.5) - 0.40 * scale.rim);
    skin.color *= 1.0 - 0.6 * face.crease;
    skin.color = mix(skin.color, skin.color * vec3(0.9, 0.75, 0.7), 0.7 * face.lips);
    skin.color = mix(skin.color, vec3(0.02, 0.008, 0.008), face.gap);

    float facing = abs(dot(normal, to_eye));
    normal = tilted(normal, v_ahead, 0.34 * shown * scale.slope);
    float thickness = 165.0 + 45.0 * chance * shown + 40.0 * spot.back;       // nanometres
    vec3 film = film_color(thickness, facing);
    float strength = u_iridescence * skin.film * (1.0 - face.gap);
    vec3 mirror = skin.mirror * mix(vec3(1.0), 0.35 + 1.5 * film, strength);
    return Finish(skin.color + 0.10 * strength * film, mirror, skin.roughness, 0.0);
}

Finish fin_finish(Spot spot, vec3 color, out float cover) {
    Fin fin = fin_skin(spot, v_part, v_coordinates, color);
    cover = 1.0;
    if (FINE) {
        Rays rays = rays_at(v_coordinates, v_lattice.y);
        float shown = smoothstep(1.0, 4.0, 0.12 / (v_lattice.y * spot.pixel));
        fin.color *= mix(1.0, mix(1.08, 0.70, rays.ray) * mix(1.0, 0.85, rays.joint * rays.ray), shown);
        cover = mix(fin.cover * mix(0.72, 1.0, rays.ray), 1.0, 1.0 - smoothstep(0.0, 0.25, v_coordinates.y));
    }
    return Finish(fin.color, vec3(0.7), 0.42, 0.75);
}

Finish skin_finish(inout vec3 normal, out float cover) {
    Spot spot = spot_here();
    vec3 color = coat(spot) * (u_school > 1 ? 0.86 + 0.28 * float((v_fish >> 8u) & 255u) / 255.0 : 1.0);
    cover = 1.0;
    if (v_part == BODY)
        return body_finish(spot, color, normal, normalize(u_frame.eye - v_position));
    if (v_part == EYE)
        return FINE ? eye_finish(v_coordinates, IRIS) : Finish(vec3(0.03), vec3(1.0), 0.3, 0.0);
    return fin_finish(spot, color, cover);
}

void main() {
    vec3 normal = normalize(v_normal);
    float cover = 1.0;
    Finish finish = Finish(vec3(0.5), vec3(1.0), 0.4, 0.0);
    if (COLOURING == SKIN)
        finish = skin_finish(normal, cover);
    if (COLOURING == PARTS)
        finish.albedo = okabe_ito(1 + v_part);
    if (COLOURING == WEIGHTS)
        finish.albedo = v_telling.rgb;
    vec3 light = underwater_light(v_position, normal, finish);
    if (COLOURING == SKIN && v_part == EYE)
        light += 0.75 * catchlight(normal, normalize(u_frame.eye - v_position));
    if (COLOURING == NORMALS)
        light = linear_light(0.5 + 0.5 * normal);
    if (COLOURING == SWING)
        light = viridis(v_telling.x);
    if (COLOURING == SKIN)
        light = FINE ? veiled(light, v_position)
                     : mix(v_light.rgb * (finish.albedo + 0.02 * finish.mirror), u_frame.backdrop_low.rgb, v_light.a);
    out_color = vec4(light, cover);
}
