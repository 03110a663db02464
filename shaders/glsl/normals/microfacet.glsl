// Facets over lobes of normals: what GGX, Beckmann and the model of Torrance and Sparrow reflect of a distribution. Functions
// over values, no bindings.
//
// Han, Sun, Ramamoorthi and Grinspun 2007; Walter, Marschner, Li and Torrance 2007; Heitz 2014. Of a lobe each model gives
// the normals that reflect, packed as a lobe is stored: vec4(integral * mean normal, integral). The cosine and the
// masking are taken of them, once: they may lie far from the lobe's own axis.

#ifndef NORMALS_MICROFACET_GLSL
#define NORMALS_MICROFACET_GLSL

#include "normals/lobe.glsl"

// GGX as four Gaussians, narrowest first: `1 / (1 + y)^2` is the sum of heights times `exp(-rates y)`, `y = (1 / alpha^2 - 1)
// (1 - (n.h)^2)`.
struct NormalsGgx {
    float narrowing; // 1 / alpha^2 - 1
    float peak;      // 1 / (pi alpha^2)
    vec4 rates;
    vec4 heights;
};

// The four of an alpha, by polynomials in the logarithm of 1 / alpha^2, fitted: within 1 % where D is above 1/25 of its
// peak from alpha 0.16 on, 2.4 % from 0.1 on, 5 % below. The same for all lobes.
NormalsGgx normals_ggx_of(float alpha)
{
    float squared = max(alpha * alpha, 1e-8);
    float x = clamp(-log(squared), 0.0, 7.0);
    const vec4 rates[5] = vec4[5](
        vec4(2.020985, 1.528056, 0.6806096, -0.5635334),
        vec4(-0.2763084, -0.4536521, -0.4066618, -0.4646996),
        vec4(-0.01133465, 0.002002666, -0.04017584, 0.00009337949),
        vec4(0.003780658, -0.0006070246, -0.0009029911, -0.01715815),
        vec4(-0.00008220316, 0.0003919921, 0.0008161687, 0.002131140)
    );
    const vec4 heights[5] = vec4[5](
        vec4(-4.356948, -1.928411, -0.6242086, -1.183123),
        vec4(2.112390, 1.131416, -0.006254053, -0.6214685),
        vec4(-0.4315223, -0.3399138, -0.1814546, -0.07101548),
        vec4(0.04154411, 0.03048675, 0.006546810, -0.02289220),
        vec4(-0.001593506, -0.0005994182, 0.001192064, 0.003567625)
    );
    NormalsGgx ggx;
    ggx.narrowing = max(1.0 / squared - 1.0, 0.0);
    ggx.peak = 1.0 / (PI * squared);
    ggx.rates = exp(rates[0] + x * (rates[1] + x * (rates[2] + x * (rates[3] + x * rates[4]))));
    ggx.heights = exp(heights[0] + x * (heights[1] + x * (heights[2] + x * (heights[3] + x * heights[4]))));
    return ggx;
}

// The normals that reflect by D(n.h) of GGX. A Gaussian and a lobe are multiplied as Gaussians about their axes: a broad one
// sees of the lobe its variance across, r / k, by squared sines; a narrow one its height and its own shape, by chords.
vec4 normals_reflecting_ggx(NormalsLobe lobe, NormalsGgx ggx, vec3 half_vector)
{
    float apart = normals_versine(lobe.axis, half_vector);
    float sine = apart * (2.0 - apart);
    float k = lobe.concentration;
    float missing = 1.0 - lobe.mean;
    float variance = normals_variance_across(lobe.mean, missing);
    float opening = 2.0 / (1.0 + k + k * lobe.mean);
    vec4 rates = ggx.rates * ggx.narrowing;
    // narrow = 1 - 1 / wide, kept = 1 / (1 + 2 rates (variance + (opening - variance) narrow)), of one quotient.
    vec4 grown = 2.0 * variance * rates;
    vec4 wide = 1.0 + grown;
    vec4 square = wide * wide + 2.0 * (opening - variance) * rates * grown;
    vec4 over = 1.0 / (wide * square);
    vec4 narrow = grown * square * over;
    vec4 kept = wide * wide * over;
    vec4 distance = sine + narrow * (2.0 * apart * k * opening - sine);
    vec4 integrals = ggx.heights * kept * exp(-rates * distance * kept);
    // The mean lies between the axes, by the share that the lobe keeps of its width; on the sphere, not on the chord.
    vec4 lengths = integrals * (1.0 - missing * kept) * (1.0 + kept * (1.0 - kept) * apart);
    float own = dot(lengths, kept);
    float other = dot(lengths, 1.0 - kept);
    return ggx.peak * vec4(own * lobe.axis + other * half_vector, dot(integrals, vec4(1.0)));
}

// The normals that reflect by D(n.h) of Beckmann, `exp(-tan^2 / alpha^2) / (pi alpha^2 cos^4)`, by the exponential that
// touches it at the axis of the product.
vec4 normals_reflecting_beckmann(NormalsLobe lobe, float alpha, vec3 half_vector)
{
    const float least = 0.2; // of the cosine where it touches: beyond 78 degrees nothing is left
    float k = 1.0 / (alpha * alpha);
    float apart = normals_versine(lobe.axis, half_vector);
    float sharpness;
    float t = 1.0;
    NormalsProduct product;
    for (int i = 0; i < 3; ++i) {
        sharpness = max(2.0 * k / (t * t * t) - 4.0 / t, 0.0);
        product = normals_times(lobe, sharpness, apart);
        t = max(1.0 - product.apart, least);
    }
    float x = min(product.apart, 1.0 - least);
    float c = 1.0 - x;
    float height = product.exponent + sharpness * x - k * x * (2.0 - x) / (c * c);
    float integral = product.factor * exp(height) * k / (PI * c * c * c * c);
    vec3 mean = product.mean * (product.own * lobe.axis + product.other * half_vector);
    return integral * vec4(mean, 1.0);
}

// The mean of D(n.h) / 4 (n.l)+ by the normals that reflect.
float normals_unmasked(vec4 reflecting, vec3 light)
{
    return 0.25 * reflecting.w * normals_clamped_cosine(reflecting, light);
}

// The mean of D(n.h) / 4 (n.l)+, D of GGX.
float normals_ggx(vec4 stored, NormalsGgx ggx, vec3 light, vec3 half_vector)
{
    return stored.w * normals_unmasked(normals_reflecting_ggx(normals_lobe(stored), ggx, half_vector), light);
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

// The mean of D(n.h) G / (4 (n.l)+ (n.v)) (n.l)+ over a lobe, the model of Torrance and Sparrow with GGX, but for Fresnel's
// factor: that depends on light and half vector alone, and is the caller's to multiply. `ggx` is of `alpha`.
float normals_torrance_sparrow(NormalsLobe lobe, NormalsGgx ggx, float alpha, vec3 light, vec3 view, vec3 half_vector)
{
    vec4 reflecting = normals_reflecting_ggx(lobe, ggx, half_vector);
    vec3 mean = reflecting.xyz / max(reflecting.w, 1e-30);
    float nl = normals_clamped_cosine(reflecting, light);
    return reflecting.w * nl * normals_masking(alpha, nl, max(dot(mean, view), 1e-4));
}

// The same of a lobe that is stored.
float normals_torrance_sparrow(vec4 stored, NormalsGgx ggx, float alpha, vec3 light, vec3 view, vec3 half_vector)
{
    return stored.w * normals_torrance_sparrow(normals_lobe(stored), ggx, alpha, light, view, half_vector);
}

#endif
