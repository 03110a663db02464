// Matt surfaces in spherical harmonics: distributions of normals under light, either of them given as nine coefficients.
// Functions over values, no bindings. Light may be an environment's or what the relight pass transfers to a vertex.
//
// Sun 2008, eq. 5.7; Ramamoorthi and Hanrahan 2001. Coefficients are those of common/sh_basis.glsl at ORDER 3 or more, in
// one frame with the normals.

#ifndef NORMALS_HARMONICS_GLSL
#define NORMALS_HARMONICS_GLSL

#include "normals/lobe.glsl"

// The clamped cosine over pi, band by band.
const vec3 NORMALS_COSINE_BANDS = vec3(1.0, 2.0 / 3.0, 0.25);

// Nine basis functions about a direction, each times the factor of its band, and the sum of their products with
// COEFFICIENT(i), which is any type that is linear.
#define NORMALS_HARMONIC_SUM(direction, bands, COEFFICIENT) \
    ((bands).x * 0.28209479 * COEFFICIENT(0) \
        + (bands).y * 0.48860251 \
            * (-(direction).y * COEFFICIENT(1) + (direction).z * COEFFICIENT(2) - (direction).x * COEFFICIENT(3)) \
        + (bands).z \
            * (1.09254843 * (direction).x * (direction).y * COEFFICIENT(4) \
                - 1.09254843 * (direction).y * (direction).z * COEFFICIENT(5) \
                + 0.31539157 * (3.0 * (direction).z * (direction).z - 1.0) * COEFFICIENT(6) \
                - 1.09254843 * (direction).x * (direction).z * COEFFICIENT(7) \
                + 0.54627421 * ((direction).x * (direction).x - (direction).y * (direction).y) * COEFFICIENT(8)))

// By how much a lobe dims each band.
vec3 normals_lobe_bands(NormalsLobe lobe)
{
    float r = normals_mean_length(lobe.concentration);
    return vec3(1.0, r, clamp(1.0 - 3.0 * r / lobe.concentration, 0.0, 1.0));
}

// The bands of a lobe's Lambertian reflection: with NORMALS_HARMONIC_SUM about its axis and the light's coefficients, times
// its weight, this is its radiance at albedo 1.
vec3 normals_lambert_bands(NormalsLobe lobe)
{
    return NORMALS_COSINE_BANDS * normals_lobe_bands(lobe);
}

#endif
