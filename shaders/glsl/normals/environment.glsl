// Gloss of lobes of normals under light from all around, given as nine coefficients: functions over values, no bindings.
//
// Walter, Marschner, Li and Torrance 2007; Heitz 2014. What a surface mirrors towards the view is told to three bands by
// its weight, a direction, and how much of each band it leaves.

#ifndef NORMALS_ENVIRONMENT_GLSL
#define NORMALS_ENVIRONMENT_GLSL

#include "normals/harmonics.glsl"

// What a normal mirrors towards a view, but for Fresnel's factor.
struct NormalsMirrored {
    vec3 direction;
    vec3 bands;    // with normals_add_moments or NORMALS_HARMONIC_SUM about the direction
    float grazing; // (1 - v.h)^5 of Fresnel's factor by Schlick
};

// GGX with shadowing and masking about a single normal. Weight, the two bands beside it and the sine of the direction, as a
// share of the view's, are polynomials in alpha and in the cosine of the view, fitted to quadrature: root mean squares of
// what is left 0.009, 0.004, 0.008 and 0.006.
NormalsMirrored normals_mirrored(vec3 normal, float alpha, vec3 view)
{
    const vec4 fitted[16] = vec4[16](
        vec4(0.86752, 1.01785, 1.02042, 1.04166), vec4(0.74097, 0.11285, 0.27698, 0.01395),
        vec4(-1.06046, -0.26763, -0.59465, -0.17941), vec4(0.45891, 0.16651, 0.35966, 0.13142),
        vec4(0.51215, -1.33991, -2.60451, -1.38792), vec4(-8.25164, 1.31269, 2.88837, 2.77237),
        vec4(15.25211, -0.28282, -2.46852, -2.21709), vec4(-7.57819, -0.72745, -0.31981, 0.98696),
        vec4(-0.82753, 1.46554, 2.65934, 0.25611), vec4(12.08343, -2.67764, -6.92706, -6.01554),
        vec4(-27.61579, 0.55018, 7.05825, 6.17284), vec4(14.69489, 1.59762, -0.25554, -3.13687),
        vec4(0.38166, -0.62675, -1.06059, 0.09475), vec4(-6.44982, 1.64186, 4.35799, 3.27261),
        vec4(15.76896, -0.49183, -4.75331, -3.86179), vec4(-8.67411, -0.81746, 0.55186, 2.06659)
    );
    float a = min(alpha, 1.0);
    float t = dot(normal, view);
    float c = clamp(t, 0.02, 1.0);
    vec4 value = vec4(0.0);
    for (int i = 12; i >= 0; i -= 4) {
        value = value * a + (fitted[i] + c * (fitted[i + 1] + c * (fitted[i + 2] + c * fitted[i + 3])));
    }
    NormalsMirrored mirrored;
    mirrored.bands = (t > 0.0 ? max(value.x, 0.0) : 0.0) * vec3(1.0, clamp(value.yz, 0.0, 1.0));
    // Across the axis the direction lies opposite to the view.
    vec3 across = clamp(value.w, -1.0, 1.0) * (t * normal - view);
    mirrored.direction = across + sqrt(max(1.0 - dot(across, across), 0.0)) * normal;
    float rest = 1.0 - c;
    float square = rest * rest;
    mirrored.grazing = square * square * rest / (1.0 + 17.0 * a * square);
    return mirrored;
}

// What a lobe mirrors, added to a sum; `grazing` sums weights times those of Fresnel. Four normals stand for it, as far from
// its axis as its variance says, two of them in the plane of the view: a wider reflection about the axis would not do,
// as masking and Fresnel's factor, and whether a normal is seen at all, hang on how each is turned to the view.
void normals_add_mirrored(inout NormalsMoments sum, inout float grazing, float weight, NormalsLobe lobe, float alpha, vec3 view)
{
    vec3 across = view - dot(lobe.axis, view) * lobe.axis;
    float size = dot(across, across);
    vec3 any = abs(lobe.axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    across = size > 1e-8 ? across * inversesqrt(size) : normalize(cross(lobe.axis, any));
    float apart = sqrt(2.0 * lobe.mean / lobe.concentration);
    for (int i = 0; i < 4; ++i) {
        vec3 offset = i < 2 ? across : cross(lobe.axis, across);
        vec3 normal = normalize(lobe.axis + ((i & 1) == 0 ? apart : -apart) * offset);
        NormalsMirrored mirrored = normals_mirrored(normal, alpha, view);
        normals_add_moments(sum, 0.25 * weight * mirrored.bands, mirrored.direction);
        grazing += 0.25 * weight * mirrored.bands.x * mirrored.grazing;
    }
}

#endif
