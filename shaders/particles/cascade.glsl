// How many particles a particle now gives rise to.
// int brood(int generation, uint identity, float left_before, float left_after, bool struck, bool died)
#include "generated/cascade.glsl"
#include "particles/random.glsl"

uniform vec2 u_children;
uniform vec2 u_grandchildren;
uniform vec2 u_great_grandchildren;

const int NEVER = 0, DURING_LIFE = 1, ON_IMPACT = 2, AT_DEATH = 3;
const int MOST_CHILDREN = 4095;         // of one particle in one step: what fits into its status

vec2 brood_range(int generation) {
    return generation == 0 ? u_children : generation == 1 ? u_grandchildren : u_great_grandchildren;
}

int brood_moment(int generation) {
    return generation == 0 ? CHILDREN_WHEN : generation == 1 ? GRANDCHILDREN_WHEN :
           generation == 2 ? GREAT_GRANDCHILDREN_WHEN : NEVER;
}

int brood(int generation, uint identity, float left_before, float left_after, bool struck, bool died) {
    int moment = brood_moment(generation);
    vec2 range = brood_range(generation);
    float number = mix(range.x, range.y, random_of(identity, 40u));
    if (moment == DURING_LIFE) {        // one each time that 1/number has gone by, since a moment of its own
        float since = random_of(identity, 43u);
        return clamp(int(floor(number * left_before + since) - floor(number * left_after + since)), 0, MOST_CHILDREN);
    }
    if ((moment == ON_IMPACT && struck) || (moment == AT_DEATH && died)) {
        uint event = identity ^ floatBitsToUint(left_before);
        number = mix(range.x, range.y, random_of(event, 41u));
        int whole = int(number);
        return clamp(random_of(event, 42u) < number - float(whole) ? whole + 1 : whole, 0, MOST_CHILDREN);
    }
    return 0;
}
