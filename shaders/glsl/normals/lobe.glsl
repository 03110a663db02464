// Lobes of normals (von Mises and Fisher) and the radiance they reflect: functions over values, no bindings.
//
// Han, Sun, Ramamoorthi and Grinspun 2007; Banerjee, Dhillon, Ghosh and Sra 2005. A lobe is stored as what is linear,
// vec4(weight * mean vector, weight); weights of a texel sum to 1. Light and half vector are unit vectors in tangent
// space; the light brings an irradiance of 1 to a surface that faces it.

#ifndef NORMALS_LOBE_GLSL
#define NORMALS_LOBE_GLSL

#include "common/constants.glsl"

// Below, a lobe is uniform to 1e-3; above, 1 - r has no digits left in f32.
const float NORMALS_MIN_CONCENTRATION = 1e-3;
const float NORMALS_MAX_CONCENTRATION = 1e7;

struct NormalsLobe {
    vec3 axis;
    float concentration;
    float mean; // length of its mean vector
};

// coth k - 1/k, within 2e-3, and 1 minus it within 2 %.
float normals_mean_length(float k)
{
    float square = k * k * (0.5028762 + 0.2351182 * k);
    return (k + square) / (3.0 + 1.5689180 * k + k * k * (0.7379943 + 0.2351182 * k));
}

// k (1 - r) / r of the concentration k of a mean vector of length r, within 1.6e-3: from 3 to 1 as r goes from 0 to 1, by a
// polynomial; `missing` is 1 - r with all its digits.
float normals_concentration_ratio(float r, float missing)
{
    return 1.0 + missing * (1.9952537 + r * (-0.9115766 + r * (0.5581401 - 0.7153818 * r)));
}

// The concentration of a mean vector of length r.
float normals_concentration(float r, float missing)
{
    return clamp(r * normals_concentration_ratio(r, missing) / max(missing, 1e-7), NORMALS_MIN_CONCENTRATION, NORMALS_MAX_CONCENTRATION);
}

NormalsLobe normals_lobe(vec4 stored)
{
    float squared = dot(stored.xyz, stored.xyz);
    if (squared <= 0.0 || stored.w <= 0.0) { return NormalsLobe(vec3(0.0, 0.0, 1.0), NORMALS_MIN_CONCENTRATION, 0.0); }
    float inverse = inversesqrt(squared);
    float size = squared * inverse;
    float r = min(size / stored.w, 1.0);
    return NormalsLobe(stored.xyz * inverse, normals_concentration(r, max(1.0 - r, 0.0)), r);
}

// A lobe as functions take it, from one sampled as axis, width and weight in four unsigned bytes.
vec4 normals_octahedral(vec4 texel)
{
    vec2 unfolded = (255.0 / 127.0) * texel.xy - 1.0;
    vec3 axis = vec3(unfolded, 1.0 - abs(unfolded.x) - abs(unfolded.y));
    vec2 signs = vec2(unfolded.x < 0.0 ? -1.0 : 1.0, unfolded.y < 0.0 ? -1.0 : 1.0);
    axis.xy = axis.z < 0.0 ? (1.0 - abs(unfolded.yx)) * signs : unfolded;
    float scale = texel.w * (1.0 - texel.z * texel.z) * inversesqrt(dot(axis, axis));
    return vec4(scale * axis, texel.w);
}

// (1 - exp(-2 k)) / k.
float normals_opening(float k)
{
    return k < 0.02 ? 2.0 - 2.0 * k + 4.0 / 3.0 * k * k : (1.0 - exp(-2.0 * k)) / k;
}

// 1 - a.b of unit vectors, with all digits where they are close.
float normals_versine(vec3 a, vec3 b)
{
    vec3 between = a - b;
    return 0.5 * dot(between, between);
}

// A lobe times exp(sharpness (n.direction - 1)), again a lobe, whose axis is `own` times the lobe's and `other` times the
// direction. Its integral is factor * exp(exponent): a height on top, which may be huge where the integral is tiny, goes
// into the exponent.
struct NormalsProduct {
    float concentration;
    float mean;
    float own;
    float other;
    float apart; // 1 - cosine of its axis and the direction
    float factor;
    float exponent;
};

// `apart`: 1 - cosine of the lobe's axis and the direction.
NormalsProduct normals_times(NormalsLobe lobe, float sharpness, float apart)
{
    const float least = 0.05; // of a concentration: products of what lies opposite, of which nothing is left
    float k = lobe.concentration;
    float both = k + sharpness;
    float across = 2.0 * k * sharpness * apart;
    float size = max(sqrt(max(both * both - across, 0.0)), least);
    float inverse = 1.0 / size;
    NormalsProduct product;
    product.concentration = size;
    product.mean = normals_mean_length(size);
    product.own = k * inverse;
    product.other = sharpness * inverse;
    product.apart = product.own * product.own * apart * (2.0 - apart)
        / max(1.0 + product.other + product.own * (1.0 - apart), 1e-3);
    // (1 - exp(-2 k)) / k = 2 / (1 + k + k r), of both.
    product.factor = (1.0 + k + k * lobe.mean) / (1.0 + size + size * product.mean);
    product.exponent = -across / (size + both);
    return product;
}

// The mean of max(0, x) for a normally distributed x, within 4e-4 deviations; `inverse` is 1 over the deviation.
float normals_rectified(float mean, float deviation, float inverse)
{
    float x = abs(mean) * inverse;
    float t = max(1.0 - x / 4.5983302, 0.0);
    t *= t;
    t *= t;
    return max(mean, 0.0) + deviation * t * t * (0.3989423 + 0.1949854 * x);
}

// Mean of the clamped cosine over a lobe of which the variance across, r / k, the length of the mean r and n.light on the
// axis are given, n.light taken as normally distributed with the lobe's mean and variance.
float normals_clamped_cosine(float across, float r, float cosine)
{
    float along = max(1.0 - r * r - 2.0 * across, 0.0);
    float square = cosine * cosine;
    float variance = max(along * square + across * max(1.0 - square, 0.0), 1e-14);
    float inverse = inversesqrt(variance);
    return normals_rectified(r * cosine, variance * inverse, inverse);
}

// The same of a lobe that is stored, its weight left out.
float normals_clamped_cosine(vec4 stored, vec3 light)
{
    float squared = max(dot(stored.xyz, stored.xyz), 1e-30);
    float inverse = inversesqrt(squared);
    float r = min(squared * inverse / max(stored.w, 1e-30), 1.0);
    float missing = 1.0 - r;
    float across = missing / normals_concentration_ratio(r, missing);
    return normals_clamped_cosine(across, r, inverse * dot(stored.xyz, light));
}

// Lambert, albedo 1: the mean of (n.l)+ / pi.
float normals_lambert(vec4 stored, vec3 light)
{
    return stored.w * normals_clamped_cosine(stored, light) / PI;
}

// The mean of (s + 8) / (8 pi) (n.h)^s (n.l)+: the power as an exponential whose height is right at the product's axis.
float normals_blinn_phong(vec4 stored, float exponent, vec3 light, vec3 half_vector)
{
    float sharpness = exponent + 1.0;
    NormalsLobe lobe = normals_lobe(stored);
    NormalsProduct product = normals_times(lobe, sharpness, normals_versine(lobe.axis, half_vector));
    float x = product.apart;
    float height = exponent * log(max(1.0 - x, 1e-30)) + sharpness * x;
    float integral = product.factor * exp(product.exponent + height);
    float cosine = product.own * dot(lobe.axis, light) + product.other * dot(half_vector, light);
    cosine = normals_clamped_cosine(product.mean / product.concentration, product.mean, cosine);
    return stored.w * (exponent + 8.0) / (8.0 * PI) * integral * cosine;
}

#endif
