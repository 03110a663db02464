// Isotropic BRDFs in half-angle form over lobes of normals: any f(n.h) = sum of c_l P_l(n.h), such as a fit to a measured
// material. Functions over values, no bindings.
//
// Sun 2008, eq. 5.6: convolution scales each band, for a lobe by exp(-l (l + 1) / (2 k)).
//
// The includer defines NORMALS_ZONAL_BANDS and NORMALS_ZONAL(l), the coefficient c_l of the BRDF in 1/sr.

#ifndef NORMALS_ZONAL_GLSL
#define NORMALS_ZONAL_GLSL

#include "normals/lobe.glsl"

// The normals that reflect: the convolved BRDF C, and its product with their mean, which is where C grows fastest, both with
// the axis and with the concentration (Tweedie's formula): A(k) axis + grad C / C.
NormalsReflecting normals_reflecting_zonal(NormalsLobe lobe, vec3 half_vector)
{
    float k = lobe.concentration;
    float t = clamp(dot(lobe.axis, half_vector), -1.0, 1.0);
    vec2 p = vec2(0.0, 1.0);     // Legendre polynomials l - 1 and l
    vec2 slope = vec2(0.0);      // their derivatives
    vec3 sums = vec3(0.0);       // C, its derivative by t, and by k
    for (int l = 0; l < NORMALS_ZONAL_BANDS; ++l) {
        float n = float(l);
        float fall = 0.5 * n * (n + 1.0) / k;
        float weight = NORMALS_ZONAL(l) * exp(-fall);
        sums += weight * vec3(p.y, slope.y, p.y * fall / k);
        vec2 next = vec2(((2.0 * n + 1.0) * t * p.y - n * p.x) / (n + 1.0), slope.x + (2.0 * n + 1.0) * p.y);
        p = vec2(p.y, next.x);
        slope = vec2(slope.y, next.y);
    }
    float value = max(sums.x, 0.0);
    vec3 across = half_vector - t * lobe.axis;
    vec3 moment = (value * lobe.mean + sums.z) * lobe.axis + sums.y / k * across;
    float size = length(moment);
    NormalsLobe mean = normals_lobe(vec4(size > value ? moment * (value / size) : moment, value));
    return NormalsReflecting(value, mean.axis, mean.mean, normals_variance_across(mean.mean, mean.missing));
}

// The mean of f(n.h) (n.l)+.
float normals_zonal(vec4 stored, vec3 light, vec3 half_vector)
{
    return stored.w * normals_lit(normals_reflecting_zonal(normals_lobe(stored), half_vector), light);
}

#endif
