#version 460
#extension GL_EXT_samplerless_texture_functions : require
// First half of the exact projection of an equirectangular environment, constant on each texel, on the SH basis.
// The basis separates into a function of the row and one of the column, so its integral over a texel does too.
// One workgroup a row: the sums over its columns of radiance times the column integrals for m = 1 - ORDER to
// ORDER - 1, in a fixed order: runs of RUN texels, then their sums, then a tree. What is not finite counts as 0, so
// that a bad texel of a live environment darkens its own solid angle and nothing else.
//
// ORDER   1-6
// HEALTH  1: texels that are not finite, and others that are negative, are counted

#define AZIMUTHS (2 * ORDER - 1)
#define WORKGROUP 128
#define RUN 16

layout(local_size_x = WORKGROUP) in;

layout(set = 0, binding = 0) uniform texture2D environment;

// [column][m + ORDER - 1], radians.
layout(std430, set = 0, binding = 1) readonly buffer Columns {
    float integrals[];
} columns;

// [row][m + ORDER - 1].
layout(std430, set = 0, binding = 2) buffer Rows {
    vec4 sums[];
} rows;

#if HEALTH
layout(std430, set = 0, binding = 3) buffer Health {
    uint not_finite;
    uint negative;
} health;
#endif

layout(push_constant) uniform Size {
    uint width;
    uint height;
} size;

shared vec4 partial[AZIMUTHS * WORKGROUP];

// The components that are finite, 0 for the others. An exponent of all ones is infinity or NaN; comparisons with NaN
// may be optimised away.
vec3 finite(vec3 radiance)
{
    uvec3 exponent = floatBitsToUint(radiance) & 0x7f800000u;
    return mix(radiance, vec3(0.0), equal(exponent, uvec3(0x7f800000u)));
}

#if HEALTH
// 1 for a texel that is not finite, else 1 for one that is negative.
uvec2 bad(vec3 texel)
{
    bool not_finite = any(notEqual(floatBitsToUint(texel), floatBitsToUint(finite(texel))));
    return uvec2(not_finite, !not_finite && any(lessThan(texel, vec3(0.0))));
}
#endif

void main()
{
    uint row = gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
#if HEALTH
    uvec2 counts = uvec2(0u);
#endif
    vec3 total[AZIMUTHS];
    for (uint m = 0u; m < uint(AZIMUTHS); ++m) { total[m] = vec3(0.0); }
    for (uint first = lane; first < size.width; first += uint(RUN * WORKGROUP)) {
        vec3 run[AZIMUTHS];
        for (uint m = 0u; m < uint(AZIMUTHS); ++m) { run[m] = vec3(0.0); }
        for (uint k = 0u; k < uint(RUN); ++k) {
            uint column = first + k * uint(WORKGROUP);
            if (column < size.width) {
                vec3 radiance = finite(texelFetch(environment, ivec2(column, row), 0).rgb);
#if HEALTH
                counts += bad(texelFetch(environment, ivec2(column, row), 0).rgb);
#endif
                for (uint m = 0u; m < uint(AZIMUTHS); ++m) {
                    run[m] = fma(vec3(columns.integrals[column * uint(AZIMUTHS) + m]), radiance, run[m]);
                }
            }
        }
        for (uint m = 0u; m < uint(AZIMUTHS); ++m) { total[m] += run[m]; }
    }
#if HEALTH
    if (counts.x > 0u) { atomicAdd(health.not_finite, counts.x); }
    if (counts.y > 0u) { atomicAdd(health.negative, counts.y); }
#endif
    for (uint m = 0u; m < uint(AZIMUTHS); ++m) { partial[m * uint(WORKGROUP) + lane] = vec4(total[m], 0.0); }
    for (uint half_count = uint(WORKGROUP) / 2u; half_count > 0u; half_count /= 2u) {
        barrier();
        if (lane < half_count) {
            for (uint m = 0u; m < uint(AZIMUTHS); ++m) {
                partial[m * uint(WORKGROUP) + lane] += partial[m * uint(WORKGROUP) + lane + half_count];
            }
        }
    }
    barrier();
    if (lane < uint(AZIMUTHS)) { rows.sums[row * uint(AZIMUTHS) + lane] = partial[lane * uint(WORKGROUP)]; }
}
