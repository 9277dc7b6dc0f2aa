// Colours that tell something of a particle instead of its own.
// vec3 telling_color(Qualities of): linear light, as COLOURING in generated/look.glsl asks.
#include "lib/color.glsl"

uniform vec2 u_colouring_range;

struct Qualities {
    uint identity;
    int generation;
    float kin;                      // which of its ranges' places its family has, 0 to 1
    float over;                     // how much of its life is over, 0 to 1
    float speed, mass, size;
    float diameter;                 // its size as it now is
};

vec3 telling_color(Qualities of) {
    if (COLOURING == BY_GENERATION)
        return okabe_ito(1 + of.generation);
    float value = COLOURING == BY_AGE ? of.over : COLOURING == BY_SPEED ? of.speed :
                  COLOURING == BY_MASS ? of.mass : of.size;
    return viridis((value - u_colouring_range.x) / (u_colouring_range.y - u_colouring_range.x));
}
