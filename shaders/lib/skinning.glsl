// Skinning: a vertex follows several bones at once, by weights. viewer/engine/skin.py sends the bones, one row each
// of a texture, and says in generated/skinning.glsl how they are blended:
//     SKINNING_METHOD     LINEAR_BLEND or DUAL_QUATERNION
//     BONES_STRETCH       whether bones also scale or shear; where they do not, less of them is read
//     INFLUENCES          4 or 8, the most that a vertex has
// void skinned(inout vec3 position, inout vec3 normal, uvec4 joints, vec4 weights)
// void skinned(inout vec3 position, inout vec3 normal, uvec4 joints, vec4 weights,
//              uvec4 more_joints, vec4 more_weights)

const int LINEAR_BLEND = 0;
const int DUAL_QUATERNION = 1;
#include "generated/skinning.glsl"

uniform sampler2D u_bones;

// Texels of a bone's row: its matrix by rows; its motion as a dual quaternion; what it stretches before, by rows.
// Where matrices are blended that do not stretch, the dual part's place has where the bone takes the origin.
const int MATRIX = 0, REAL = 3, DUAL = 4, STRETCH = 5, SHIFT = 4;

struct Rows { vec4 x, y, z; };              // the upper three rows of a matrix

void add_rows(inout Rows sum, int first, uvec4 joints, vec4 weights) {
    for (int i = 0; i < 4; i++) {
        int bone = int(joints[i]);
        sum.x += weights[i] * texelFetch(u_bones, ivec2(first, bone), 0);
        sum.y += weights[i] * texelFetch(u_bones, ivec2(first + 1, bone), 0);
        sum.z += weights[i] * texelFetch(u_bones, ivec2(first + 2, bone), 0);
    }
}

// A rigid bone is told by two texels instead of three, and reading them is most of the work: its quaternion, whose
// products make up its matrix, and where it takes the origin. Sums of products make up the sum of matrices.
struct Products { vec3 squares, mixed, real; vec3 shift; float weight; };

void add_products(inout Products sum, uvec4 joints, vec4 weights) {
    for (int i = 0; i < 4; i++) {
        int bone = int(joints[i]);
        vec4 turn = texelFetch(u_bones, ivec2(REAL, bone), 0), weighed = weights[i] * turn;
        sum.squares += weighed.xyz * turn.xyz;
        sum.mixed += weighed.xxy * turn.yzz;
        sum.real += weighed.w * turn.xyz;
        sum.shift += weights[i] * texelFetch(u_bones, ivec2(SHIFT, bone), 0).xyz;
        sum.weight += weights[i];
    }
}

Rows rows_of(Products sum) {
    vec3 diagonal = sum.weight - 2.0 * (sum.squares.yxx + sum.squares.zzy);
    vec3 above = 2.0 * (sum.mixed + vec3(-sum.real.z, sum.real.y, -sum.real.x));
    vec3 below = 2.0 * (sum.mixed - vec3(-sum.real.z, sum.real.y, -sum.real.x));
    return Rows(vec4(diagonal.x, above.x, above.y, sum.shift.x), vec4(below.x, diagonal.y, above.z, sum.shift.y),
                vec4(below.y, below.z, diagonal.z, sum.shift.z));
}

// A direction of length one, or where there is none, on a limb that collapsed onto its axis, the one before.
vec3 direction_or(vec3 direction, vec3 before) {
    float size = length(direction);
    return size > 0.0 ? direction / size : before;
}

// Linear blending: the blended matrix moves the point; its cofactors turn the normal.
void move_linearly(inout vec3 position, inout vec3 normal, Rows m) {
    vec4 p = vec4(position, 1.0);
    position = vec3(dot(m.x, p), dot(m.y, p), dot(m.z, p));
    vec3 turned = vec3(dot(cross(m.y.xyz, m.z.xyz), normal), dot(cross(m.z.xyz, m.x.xyz), normal),
                       dot(cross(m.x.xyz, m.y.xyz), normal));
    normal = direction_or(turned, normal);
}

// Dual quaternions: a motion and its negative are the same; each counts with the sign nearer to `like`.
void add_motions(inout vec4 real, inout vec4 dual, vec4 like, uvec4 joints, vec4 weights) {
    for (int i = 0; i < 4; i++) {
        int bone = int(joints[i]);
        vec4 turn = texelFetch(u_bones, ivec2(REAL, bone), 0);
        float weight = dot(turn, like) < 0.0 ? -weights[i] : weights[i];
        real += weight * turn;
        dual += weight * texelFetch(u_bones, ivec2(DUAL, bone), 0);
    }
}

vec3 turned_by(vec4 q, vec3 v) {
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

void move_rigidly(inout vec3 position, inout vec3 normal, vec4 real, vec4 dual) {
    float size = max(length(real), 1e-30);
    real /= size;
    dual /= size;
    vec3 moved = 2.0 * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
    position = turned_by(real, position) + moved;
    normal = direction_or(turned_by(real, normal), normal);
}

// The first of the heaviest of four bones: its weight, and its number.
void heaviest(uvec4 joints, vec4 weights, inout float weight, inout uint joint) {
    for (int i = 0; i < 4; i++) {
        if (weights[i] > weight) {
            weight = weights[i];
            joint = joints[i];
        }
    }
}

void skinned(inout vec3 position, inout vec3 normal, uvec4 joints, vec4 weights,
             uvec4 more_joints, vec4 more_weights) {
    if (BONES_STRETCH) {
        int first = SKINNING_METHOD == LINEAR_BLEND ? MATRIX : STRETCH;
        Rows blended = Rows(vec4(0.0), vec4(0.0), vec4(0.0));
        add_rows(blended, first, joints, weights);
        if (INFLUENCES == 8)
            add_rows(blended, first, more_joints, more_weights);
        move_linearly(position, normal, blended);
    } else if (SKINNING_METHOD == LINEAR_BLEND) {
        Products blended = Products(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
        add_products(blended, joints, weights);
        if (INFLUENCES == 8)
            add_products(blended, more_joints, more_weights);
        move_linearly(position, normal, rows_of(blended));
    }
    if (SKINNING_METHOD == DUAL_QUATERNION) {
        float weight = 0.0;
        uint joint = joints.x;
        heaviest(joints, weights, weight, joint);
        if (INFLUENCES == 8)
            heaviest(more_joints, more_weights, weight, joint);
        vec4 like = texelFetch(u_bones, ivec2(REAL, int(joint)), 0);
        vec4 real = vec4(0.0), dual = vec4(0.0);
        add_motions(real, dual, like, joints, weights);
        if (INFLUENCES == 8)
            add_motions(real, dual, like, more_joints, more_weights);
        move_rigidly(position, normal, real, dual);
    }
}

void skinned(inout vec3 position, inout vec3 normal, uvec4 joints, vec4 weights) {
    skinned(position, normal, joints, weights, uvec4(0u), vec4(0.0));
}
