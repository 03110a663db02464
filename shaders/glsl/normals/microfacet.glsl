// Facets over lobes of normals: what GGX, Beckmann and the model of Torrance and Sparrow reflect of a distribution. Functions
// over values, no bindings.
//
// Han, Sun, Ramamoorthi and Grinspun 2007; Walter, Marschner, Li and Torrance 2007; Heitz 2014. Of a lobe each model gives
// the normals that reflect, packed as a lobe is stored: vec4(integral * mean normal, integral). The cosine and the
// masking are taken of them, once: they may lie far from the lobe's own axis.

#ifndef NORMALS_MICROFACET_GLSL
#define NORMALS_MICROFACET_GLSL

#include "normals/lobe.glsl"

// Distance in ln u of the Gaussians that make up GGX: it is 0.4 % off at 1.
const float NORMALS_GGX_STEP = 1.0;
// Of the cosine of normal and half vector where an exponential touches.
const float NORMALS_LEAST_TOUCH = 0.05;

// The normals that reflect by D(n.h) of GGX: `1 / (1 + y)^2 = Int u e^(-u) e^(-u y) du` with
// `y = (1 / alpha^2 - 1) (1 - (n.h)^2)`, a blend of Gaussians of all widths, by the trapezoidal rule in ln u. Each is taken
// as the exponential that touches it where the narrower one before it lay.
vec4 normals_reflecting_ggx(NormalsLobe lobe, float alpha, vec3 half_vector)
{
    float narrowing = max(1.0 / (alpha * alpha) - 1.0, 0.0);
    int count = int(ceil(log(1.0 + narrowing) / NORMALS_GGX_STEP)) + 5;
    vec4 sum = vec4(0.0);
    float touch = 1.0;
    for (int i = 0; i < count; ++i) {
        float u = exp(1.5 - NORMALS_GGX_STEP * float(i));
        float k = u * narrowing;
        float sharpness = 2.0 * k * touch;
        float factor;
        float fall;
        NormalsLobe product = normals_times(lobe, sharpness, half_vector, factor, fall);
        touch = max(dot(product.axis, half_vector), NORMALS_LEAST_TOUCH);
        float x = min(normals_versine(product.axis, half_vector), 1.0 - NORMALS_LEAST_TOUCH);
        float integral = u * u * factor * exp(fall + x * (sharpness - k * (2.0 - x)) - u);
        sum += integral * vec4(normals_mean_length(product.concentration) * product.axis, 1.0);
    }
    return NORMALS_GGX_STEP / (PI * alpha * alpha) * sum;
}

// The normals that reflect by D(n.h) of Beckmann, `exp(-tan^2 / alpha^2) / (pi alpha^2 cos^4)`, by the exponential that
// touches it at the axis of the product.
vec4 normals_reflecting_beckmann(NormalsLobe lobe, float alpha, vec3 half_vector)
{
    const float least = 0.2; // of the cosine where it touches: beyond 78 degrees nothing is left
    float k = 1.0 / (alpha * alpha);
    float factor;
    float fall;
    float sharpness;
    float t = 1.0;
    NormalsLobe product = lobe;
    for (int i = 0; i < 3; ++i) {
        sharpness = max(2.0 * k / (t * t * t) - 4.0 / t, 0.0);
        product = normals_times(lobe, sharpness, half_vector, factor, fall);
        t = max(dot(product.axis, half_vector), least);
    }
    float x = min(normals_versine(product.axis, half_vector), 1.0 - least);
    float c = 1.0 - x;
    float integral = factor * exp(fall + sharpness * x - k * x * (2.0 - x) / (c * c)) * k / (PI * c * c * c * c);
    return integral * vec4(normals_mean_length(product.concentration) * product.axis, 1.0);
}

// The mean of D(n.h) / 4 (n.l)+ by the normals that reflect.
float normals_unmasked(vec4 reflecting, vec3 light)
{
    return 0.25 * reflecting.w * normals_clamped_cosine(normals_lobe(reflecting), light);
}

// The mean of D(n.h) / 4 (n.l)+, D of GGX.
float normals_ggx(vec4 stored, float alpha, vec3 light, vec3 half_vector)
{
    return stored.w * normals_unmasked(normals_reflecting_ggx(normals_lobe(stored), alpha, half_vector), light);
}

// The mean of D(n.h) / 4 (n.l)+, D of Beckmann.
float normals_beckmann(vec4 stored, float alpha, vec3 light, vec3 half_vector)
{
    return stored.w * normals_unmasked(normals_reflecting_beckmann(normals_lobe(stored), alpha, half_vector), light);
}

// Shadowing and masking of GGX together over 4 (n.l) (n.v), by height (Heitz 2014, eq. 99).
float normals_masking(float alpha, float nl, float nv)
{
    float square = alpha * alpha;
    float l = nv * sqrt(nl * nl * (1.0 - square) + square);
    float v = nl * sqrt(nv * nv * (1.0 - square) + square);
    return 0.5 / max(l + v, 1e-6);
}

// The mean of D(n.h) G / (4 (n.l)+ (n.v)) (n.l)+, the model of Torrance and Sparrow with GGX, but for Fresnel's factor: that
// depends on light and half vector alone, and is the caller's to multiply.
float normals_torrance_sparrow(vec4 stored, float alpha, vec3 light, vec3 view, vec3 half_vector)
{
    vec4 reflecting = normals_reflecting_ggx(normals_lobe(stored), alpha, half_vector);
    vec3 mean = reflecting.xyz / max(reflecting.w, 1e-30);
    float nl = normals_clamped_cosine(normals_lobe(reflecting), light);
    return stored.w * reflecting.w * nl * normals_masking(alpha, nl, max(dot(mean, view), 1e-4));
}

#endif
