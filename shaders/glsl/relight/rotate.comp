#version 460
#extension GL_GOOGLE_include_directive : require
// Rotates SH RGB vectors by unit quaternions: rotated(s) = f(q^-1 s q), or f(-q^-1 s q) with an inversion, for
// which Y_lm(-s) = (-1)^l Y_lm(s), each band times a factor. q and -q are one rotation, so the sign of w says whether
// the inversion follows. One workgroup a rotation: it makes the matrices of all bands together, then each invocation
// makes one coefficient.
//
// ORDER  1-6

#define COEFFICIENTS (ORDER * ORDER)

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Source {
    vec4 coefficients[];
} source;

layout(std430, set = 0, binding = 1) readonly buffer Turns {
    vec4 quaternions[]; // x, y, z, w; w below 0, and negative zero: with an inversion
} turns;

layout(std430, set = 0, binding = 2) buffer Rotated {
    vec4 coefficients[];
} rotated;

layout(push_constant) uniform Frame {
    // Distances between two vectors, in vec4; a source distance of 0 rotates one vector by every quaternion.
    uint source_stride;
    uint rotated_stride;
    float factors[18]; // of each band, red, green and blue
} frame;

shared float rotation_elements[ORDER * (4 * ORDER * ORDER - 1) / 3];
#define SH_ROTATION(i) rotation_elements[i]
#include "common/sh_rotation.glsl"

// The rotation of space by a unit quaternion.
mat3 rotation_matrix(vec4 q)
{
    vec3 doubled = 2.0 * q.xyz;
    vec3 square = q.xyz * doubled;
    vec3 cross_terms = vec3(q.x * doubled.y, q.x * doubled.z, q.y * doubled.z);
    vec3 spin = q.w * doubled;
    return mat3(
        1.0 - square.y - square.z, cross_terms.x + spin.z, cross_terms.y - spin.y,
        cross_terms.x - spin.z, 1.0 - square.x - square.z, cross_terms.z + spin.x,
        cross_terms.y + spin.y, cross_terms.z - spin.x, 1.0 - square.x - square.y);
}

void main()
{
    uint i = gl_LocalInvocationID.x;
    uint which = gl_WorkGroupID.x;
    vec4 quaternion = turns.quaternions[which];
    sh_rotation_build(rotation_matrix(quaternion), i, 64u);
    if (i >= uint(COEFFICIENTS)) { return; }
    int l = sh_band(i);
    int m = int(i) - l * (l + 1);
    vec3 sum = vec3(0.0);
    for (int n = -l; n <= l; ++n) {
        uint index = uint(l * (l + 1) + n);
        sum = fma(vec3(sh_rotation_at(l, m, n)), source.coefficients[which * frame.source_stride + index].rgb, sum);
    }
    bool negated = floatBitsToUint(quaternion.w) >> 31 != 0u && l % 2 == 1;
    vec3 factor = vec3(frame.factors[3 * l], frame.factors[3 * l + 1], frame.factors[3 * l + 2]);
    rotated.coefficients[which * frame.rotated_stride + i] = vec4((negated ? -factor : factor) * sum, 0.0);
}
