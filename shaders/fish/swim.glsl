// How a fish swims: its middle line bends as a wave that runs from head to tail, and the body goes along with it.
// void swim(inout vec3 position, inout vec3 normal, float phase, float turn): from the straight fish to the bent one.
//
// The straight fish is one body length long: x from -0.5 at the tail to 0.5 at the nose, y up, z to its right.
// A place along it is s = 0.5 - x, from 0 at the nose to 1 at the tail. `phase` grows by 2 pi with each beat of the
// tail; `turn` is the angle between tail and nose, in radians, positive to the left. What the uniforms hold comes
// from viewer/kit/swim.py, which has the same in NumPy.

uniform float u_swim_amplitude;         // how far the tail swings to either side, in body lengths
uniform float u_swim_wave_number;       // 2 pi over the wavelength
uniform vec4 u_swim_envelope;           // the swing along the body, by the tail's: x + y s + z s^2 + w s^4
uniform float u_swim_sway;              // the whole body to the side, in body lengths
uniform float u_swim_yaw;               // the whole body about the vertical, in radians
uniform float u_swim_roll;              // the whole body about its own length
uniform float u_swim_twist;             // the same at the tail, as a wave along the body

const float MIDDLE = 0.5;               // the place that stays where it is along x, and keeps its heading in a turn
// Gauss and Legendre's rule for an integral from 0 to 1: good to 1e-5 of the body for waves of 0.6 and longer.
const int NODES = 10;
const float NODE_PLACES[NODES] = float[](
    0.013046736, 0.067468317, 0.160295216, 0.283302303, 0.425562831,
    0.574437169, 0.716697697, 0.839704784, 0.932531683, 0.986953264);
const float NODE_WEIGHTS[NODES] = float[](
    0.033335672, 0.074725675, 0.109543181, 0.134633360, 0.147762112,
    0.147762112, 0.134633360, 0.109543181, 0.074725675, 0.033335672);

struct BodyPlace {
    vec2 place;         // of the middle line, x and z
    vec2 forward;       // unit vector along it towards the nose, x and z
    float bend;         // how fast that turns for each body length
    float roll;         // the body's turn about its own length
    float roll_rate;    // how fast that changes along the body
};

// How far the body swings at s, by the tail's swing: the value, its first and its second derivative.
vec3 swing(float s) {
    vec4 c = u_swim_envelope;
    float s2 = s * s;
    return vec3(c.x + s * c.y + s2 * (c.z + s2 * c.w), c.y + s * (2.0 * c.z + s2 * 4.0 * c.w),
                2.0 * c.z + s2 * 12.0 * c.w);
}

// The wave h(s) = swing(s) sin(phase - k s), where the swing at the tail is 1, and its two derivatives.
vec3 wave(float s, float phase) {
    float k = u_swim_wave_number, angle = phase - k * s;
    float sine = sin(angle), cosine = cos(angle);
    vec3 e = swing(s);
    return vec3(e.x * sine, e.y * sine - k * e.x * cosine, (e.z - k * k * e.x) * sine - 2.0 * k * e.y * cosine);
}

// A line that moves sideways by slope for each unit of its own length moves ahead by sqrt(1 - slope^2): so the
// body never stretches. The turn bends the whole into an arc of a circle besides.
vec2 forward_at(float s, float slope, float turn) {
    vec2 forward = vec2(sqrt(1.0 - slope * slope), -slope);
    float angle = turn * (MIDDLE - s), sine = sin(angle), cosine = cos(angle);
    return vec2(cosine * forward.x + sine * forward.y, cosine * forward.y - sine * forward.x);
}

BodyPlace body_at(float s, float phase, float turn) {
    vec2 way = vec2(0.0);
    for (int i = 0; i < NODES; ++i) {
        float between = mix(MIDDLE, s, NODE_PLACES[i]);
        way += NODE_WEIGHTS[i] * forward_at(between, u_swim_amplitude * wave(between, phase).y, turn);
    }
    vec3 here = wave(s, phase), sideways = u_swim_amplitude * here;
    float ahead = sqrt(1.0 - sideways.y * sideways.y);
    BodyPlace body;
    body.place = vec2(0.0, u_swim_amplitude * wave(MIDDLE, phase).x) + (MIDDLE - s) * way;
    body.forward = forward_at(s, sideways.y, turn);
    body.bend = turn - sideways.z / ahead;
    body.roll = u_swim_roll * sin(phase) + u_swim_twist * here.x;
    body.roll_rate = u_swim_twist * here.y;
    return body;
}

vec2 rotated(vec2 v, float angle) {
    return vec2(cos(angle) * v.x - sin(angle) * v.y, sin(angle) * v.x + cos(angle) * v.y);
}

// From the frame that goes along with a place of the body (ahead, up, right) to the fish's own.
vec3 out_of_body(vec3 v, BodyPlace body, float yaw) {
    vec2 across = rotated(v.yz, body.roll);
    vec2 level = v.x * body.forward + across.y * vec2(-body.forward.y, body.forward.x);
    level = rotated(level, -yaw);
    return vec3(level.x, across.x, level.y);
}

// Along x the deformation stretches what lies outside the bend, a, and shears what rolls, b and c. An area's normal is
// turned by the cofactors of that Jacobian, whose columns are (a, b, c), (0, 1, 0) and (0, 0, 1).
vec3 normal_in_body(vec3 normal, vec3 position, BodyPlace body) {
    float a = 1.0 + body.bend * rotated(position.yz, body.roll).y;
    float b = body.roll_rate * position.z, c = -body.roll_rate * position.y;
    return vec3(normal.x - b * normal.y - c * normal.z, a * normal.y, a * normal.z);
}

void swim(inout vec3 position, inout vec3 normal, float phase, float turn) {
    float s = clamp(MIDDLE - position.x, 0.0, 1.0), yaw = u_swim_yaw * sin(phase);
    BodyPlace body = body_at(s, phase, turn);
    if (abs(position.x) <= 0.5)             // before the nose and behind the tail it goes on straight
        normal = normal_in_body(normal, position, body);
    vec2 middle = rotated(body.place, -yaw) + vec2(0.0, u_swim_sway * sin(phase));
    position = vec3(middle.x, 0.0, middle.y) + out_of_body(position - vec3(MIDDLE - s, 0.0, 0.0), body, yaw);
    normal = normalize(out_of_body(normal, body, yaw));
}
