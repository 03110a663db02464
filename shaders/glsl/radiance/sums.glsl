// A sample's sums, over the texels of an invocation first, then over the invocations of its workgroup.
//
// The includer defines ORDER, GRADIENTS and has a workgroup of LANES invocations, and buffers that these write to:
// SAMPLE_LIGHT(i) and SAMPLE_GRADIENT(i), the sample's vec4.

#ifndef RADIANCE_SUMS_GLSL
#define RADIANCE_SUMS_GLSL

#include "common/sh_basis.glsl"
#include "radiance/sample.glsl"
#include "radiance/slope.glsl"

#define LANES 64
#define ELEMENTS (COEFFICIENTS + GRADIENTS * GRADIENT_STRIDE)

// What else is summed, in the fourth components of the first elements.
#define SUMS_SOLID_ANGLE 0
#define SUMS_NEARNESS 1
#define SUMS_FOUND 2
#define SUMS_SLOPE 3 // RGB
#define SUMS_SCALARS 6

// What a texel sends, means over its rays.
struct Texel {
    vec3 direction; // unit, to the middle of what emits in it
    float solid_angle;
    vec3 radiance;
    float covered; // part of the texel that emits
    vec3 slope; // radiance over distance
    float nearness; // 1 / distance where it emits
#if GRADIENTS
    vec3 tilt[3]; // slope times x, y and z of the normal over its product with the unit ray
    vec3 dimming; // radiance times the extinction of what it comes through
#endif
};

void sums_clear(out vec4 sums[ELEMENTS])
{
    [[unroll]] for (int i = 0; i < ELEMENTS; ++i) { sums[i] = vec4(0.0); }
}

// Gradients: a patch of area dA at s from the point, of normal n, sends L Y(s/|s|) n.s / |s|^3 dA; moving the point is
// moving s the other way (Annen, Kautz, Durand, Seidel, "Spherical Harmonic Gradients for Mid-Range Illumination", 2004). A
// medium that dims it does so by less when the way is shorter.
void sums_add(Texel texel, inout vec4 sums[ELEMENTS])
{
    float basis[COEFFICIENTS];
    sh_evaluate(texel.direction, basis);
    vec3 power = texel.solid_angle * texel.radiance;
    vec3 slope = texel.solid_angle * texel.slope;
    [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) { sums[i].rgb += basis[i] * power; }
    sums[SUMS_SOLID_ANGLE].w += texel.solid_angle * texel.covered;
    sums[SUMS_NEARNESS].w += texel.solid_angle * texel.nearness;
    [[unroll]] for (int k = 0; k < 3; ++k) { sums[SUMS_SLOPE + k].w += slope[k]; }
#if GRADIENTS
    vec3 slopes[COEFFICIENTS];
    sh_slopes(texel.direction, basis, slopes);
    vec3 change[3];
    vec3 along = 3.0 * slope + texel.solid_angle * texel.dimming;
    [[unroll]] for (int k = 0; k < 3; ++k) {
        change[k] = texel.direction[k] * along - texel.solid_angle * texel.tilt[k];
    }
    [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) {
        [[unroll]] for (int k = 0; k < 3; ++k) {
            sums[COEFFICIENTS + 3 * i + k].rgb += basis[i] * change[k] - slopes[i][k] * slope;
        }
    }
#endif
}

// Elements summed at a time, and the runs that each of them is summed in.
#define SUMS_BLOCK 16
#define SUMS_RUNS (LANES / SUMS_BLOCK)
shared vec4 sums_block[SUMS_BLOCK * LANES];

// The sum of an element whose runs are summed.
vec4 sums_total(uint element)
{
    vec4 total = sums_block[element * SUMS_RUNS];
    for (uint i = 1u; i < SUMS_RUNS; ++i) { total += sums_block[element * SUMS_RUNS + i]; }
    return total;
}

// Writes the sample, if it is wanted. The same order of additions every time: runs of neighbouring lanes, then the runs.
void sums_write(vec4 sums[ELEMENTS], uint lane, bool wanted)
{
    [[unroll]] for (int first = 0; first < ELEMENTS; first += SUMS_BLOCK) {
        [[unroll]] for (int i = 0; i < SUMS_BLOCK; ++i) {
            if (first + i < ELEMENTS) { sums_block[i * LANES + int(lane)] = sums[min(first + i, ELEMENTS - 1)]; }
        }
        barrier();
        uint element = lane % SUMS_BLOCK;
        uint run = lane / SUMS_BLOCK;
        vec4 total = vec4(0.0);
        for (uint i = 0u; i < uint(LANES / SUMS_RUNS); ++i) {
            total += sums_block[element * LANES + run * (LANES / SUMS_RUNS) + i];
        }
        barrier();
        sums_block[element * SUMS_RUNS + run] = total;
        barrier();
        uint index = uint(first) + lane;
        if (wanted && lane < SUMS_BLOCK && index < uint(ELEMENTS)) {
            vec4 value = vec4(sums_total(lane).rgb, 0.0);
            if (index < uint(COEFFICIENTS)) { SAMPLE_LIGHT(index) = value; }
#if GRADIENTS
            else { SAMPLE_GRADIENT(index - uint(COEFFICIENTS)) = value; }
#endif
        }
        for (bool scalars = wanted && index == 0u; scalars; scalars = false) {
            float values[SUMS_SCALARS];
            for (uint i = 0u; i < uint(SUMS_SCALARS); ++i) { values[i] = sums_total(i).w; }
            SAMPLE_LIGHT(uint(LIGHT_EXTENT)) = vec4(values[0], values[1], values[2], 0.0);
            SAMPLE_LIGHT(uint(LIGHT_SLOPE)) = vec4(values[3], values[4], values[5], 0.0);
        }
        barrier();
    }
}

#endif
