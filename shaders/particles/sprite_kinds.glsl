// What the constants in generated/look.glsl mean: the order of the choices in viewer/engine/particles/look.py, and of
// the shapes in viewer/engine/particles/sprites.py.

const int FACES_CAMERA = 0, FOLLOWS_VELOCITY = 1, TUMBLES = 2;
const int SPOT = 0, BALL = 1, PUFF = 2, FLAKE = 3, LEAF = 4, STAR = 5, RING = 6, PICTURE = 7;
const float AREAS[8] = float[](0.2618, 0.785, 0.164, 0.19, 0.22, 0.038, 0.15, 0.5);   // covered, of a square around it
const int POINT = 0, TRIANGLE = 1, SQUARE = 2;
const float FADES_AS_ONE = 4.0;     // pixels of radius: below, a sprite fades towards what is solid as a whole
const int BY_LOOK = 0, BY_AGE = 1, BY_GENERATION = 2, BY_SPEED = 3, BY_MASS = 4, BY_SIZE = 5;
