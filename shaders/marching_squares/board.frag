#version 330 core
// The board: samples as pixels, their signs, the cells with their cases; or the sheet of all sixteen cases.
#include "lib/lighting.glsl"
#include "marching_squares/square.glsl"
#include "marching_squares/place.glsl"
#include "marching_squares/digits.glsl"

uniform int u_view;               // 0 the board, 1 the sheet of cases
uniform int u_show;               // 0 values, 1 signs, 2 cases, 3 crossings, 4 segments
uniform ivec2 u_chosen;           // the cell under the microscope, -1 for none
uniform int u_present;            // bit c: there are cells of case c
uniform int u_chosen_case;        // the case asked for, -1 for all

const float CASE_SIZE = 0.36;      // of a case's number, in cells

in vec3 v_position;
in vec3 v_normal;
in vec2 v_square;

out vec4 out_color;

// Lines of the grid, one pixel wide, as long as the cells are wide enough.
float grid_ink(vec2 g, float pixel) {
    vec2 from_line = abs(g - round(g));
    return cover(0.5 * pixel - min(from_line.x, from_line.y), pixel) * smoothstep(0.14, 0.05, pixel);
}

// Lines of `width` around a cell, on its inner side; g is the place in cells, from the cell's corner.
float border_ink(vec2 g, float width, float pixel) {
    vec2 inwards = 0.5 - abs(g - 0.5);
    float depth = min(inwards.x, inwards.y);
    return cover(min(depth, width - depth), pixel);
}

vec3 cells_drawn(vec3 color, vec2 g, float pixel) {
    ivec2 cell = clamp(ivec2(floor(g)), ivec2(0), ivec2(u_cell_count - 1));
    uint known = texelFetch(u_cells, cell, 0).r;
    vec2 within = g - vec2(cell);
    bool crossed = (known & CROSSED) != 0u && (known & FADED) == 0u;
    if ((known & NO_CURVE) != 0u) {
        float stripe = abs(fract(3.0 * (within.x + within.y)) - 0.5) / 3.0;
        color = mix(color, INK, 0.75 * mix(cover(0.045 - stripe, pixel), 0.5, smoothstep(0.1, 0.2, pixel)));
    }
    if (u_show == 2 && crossed) {
        color = mix(color, PAPER, 0.45);
        float digits = number_distance((within - 0.5) / CASE_SIZE, int(known & 15u)) * CASE_SIZE;
        color = mix(color, INK, smoothstep(0.09, 0.055, pixel) * cover(0.11 * CASE_SIZE - digits, pixel));
    }
    if (u_show > 2 && crossed && u_colouring == 0)
        color = mix(color, PAPER, 0.28);
    if (u_show >= 2 && crossed && (known & AMBIGUOUS) != 0u)
        color = mix(color, okabe_ito(7), border_ink(within, min(0.07, picture_units(5.0) * pixel), pixel));
    bool hidden = (known & FADED) != 0u;
    return hidden ? mix(vec3(dot(color, vec3(0.2, 0.7, 0.1))), color, 0.25) * 0.55 + 0.18 : color;
}

vec3 square_drawn(vec2 p) {
    float pixel = 0.5 * (length(dFdx(p)) + length(dFdy(p)));
    vec2 g = p * float(u_cell_count);
    float pixel_in_cells = pixel * float(u_cell_count);
    ivec2 nearest = clamp(ivec2(round(g)), ivec2(0), ivec2(u_cell_count));
    vec2 from_edge = 0.5 - abs(p - 0.5);
    float on_square = cover(min(from_edge.x, from_edge.y), pixel);
    vec3 color = cells_drawn(sampled_color(nearest), g, pixel_in_cells);
    if (u_show >= 1)
        color = mix(color, readable_on(color), 0.45 * grid_ink(g, pixel_in_cells));
    color = mix(PAPER, color, on_square);
    if (u_show >= 1) {
        float size = min(min(0.13, 0.022 * float(u_cell_count)), picture_units(11.0) * pixel_in_cells);
        float strength = (u_show == 1 ? 1.0 : 0.6) * smoothstep(0.09, 0.05, pixel_in_cells);
        float ink = strength * sign_ink(g - vec2(nearest), nearest, size, pixel_in_cells);
        color = mix(color, readable_on(color), ink);
    }
    if (u_chosen.x >= 0) {
        vec2 out_by = abs(g - vec2(u_chosen) - 0.5) - 0.5;
        float from_border = abs(max(out_by.x, out_by.y)) / pixel_in_cells;
        color = mix(color, vec3(0.9), cover(picture_units(4.5) - from_border, 1.0));
        color = mix(color, INK, cover(picture_units(2.5) - from_border, 1.0));
    }
    return color;
}

// Four by four tiles, case 0 at the upper left. In each a cell with its corners; the segments are drawn over it.
vec3 sheet_drawn(vec2 p) {
    float pixel = 0.5 * (length(dFdx(p)) + length(dFdy(p)));
    ivec2 tile = ivec2(floor(4.0 * clamp(p, 0.0, 0.9999)));
    int number = tile.x + 4 * (3 - tile.y);
    bool present = (u_present >> number & 1) == 1;
    vec2 within = (4.0 * p - vec2(tile) - vec2(0.24, 0.34)) / 0.52;
    float pixel_in_tile = pixel * 4.0 / 0.52;
    vec2 from_tile = 0.5 - abs(4.0 * p - vec2(tile) - 0.5);
    float on_tile = cover(min(from_tile.x, from_tile.y) - 0.025, 4.0 * pixel);
    vec3 color = mix(PAPER, present ? vec3(0.93) : vec3(0.62), on_tile);
    if (number == u_chosen_case)
        color = mix(color, okabe_ito(1), on_tile * cover(0.065 - min(from_tile.x, from_tile.y), 4.0 * pixel));
    ivec2 corner = clamp(ivec2(floor(within + 0.5)), 0, 1);
    bool inside = (number >> (corner.x + 2 * corner.y) & 1) == 1;
    vec3 half_tone = inside ? vec3(0.28, 0.46, 0.66) : vec3(0.88, 0.70, 0.38);
    vec2 in_cell = 0.5 - abs(within - 0.5);
    float depth = min(in_cell.x, in_cell.y);
    color = mix(color, mix(half_tone, color, present ? 0.0 : 0.5), cover(depth, pixel_in_tile));
    color = mix(color, INK, 0.6 * cover(0.012 - abs(depth), pixel_in_tile));
    vec2 bar = vec2(0.075, 0.018) - abs(within - vec2(corner));
    vec2 upright = vec2(0.018, 0.075) - abs(within - vec2(corner));
    float glyph = max(min(bar.x, bar.y), inside ? -1.0 : min(upright.x, upright.y));
    float plate = 0.13 - length(within - vec2(corner));
    color = mix(color, inside ? vec3(0.10, 0.25, 0.48) : vec3(0.80, 0.48, 0.08), cover(plate, pixel_in_tile));
    return mix(color, vec3(0.95), cover(glyph, pixel_in_tile));
}

void main() {
    if (v_normal.z < 0.5) {
        out_color = vec4(studio_light(v_position, normalize(v_normal), PAPER, 0.6), 1.0);
        return;
    }
    out_color = vec4(u_view == 1 ? sheet_drawn(v_square) : square_drawn(v_square), 1.0);
}
