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

// r / k, the variance across the axis, within 9e-4 in the same way.
float normals_variance_across(float r, float missing)
{
    const vec4 bend = vec4(-0.6669316, -0.3381041, -0.06966979, -0.6625777);
    return missing * (1.0 + missing * (bend.x + r * (bend.y + r * (bend.z + r * (bend.w + 0.7808136 * r)))));
}

// Weights below are those of empty places, and what is left of normals all over the sphere has no direction.
const float NORMALS_LEAST_WEIGHT = 1e-9;
const float NORMALS_LEAST_MEAN = 1e-6;

NormalsLobe normals_lobe(vec4 stored)
{
    float squared = dot(stored.xyz, stored.xyz);
    if (stored.w <= NORMALS_LEAST_WEIGHT || squared <= NORMALS_LEAST_MEAN * NORMALS_LEAST_MEAN * stored.w * stored.w) {
        return NormalsLobe(vec3(0.0, 0.0, 1.0), NORMALS_MIN_CONCENTRATION, 0.0);
    }
    // Quotients cost more than products: three are made of one.
    float size = sqrt(squared);
    float lacks = max(stored.w - size, 1e-7 * stored.w);
    float over = 1.0 / (size * stored.w * lacks);
    float of_weight = over * size * lacks;
    float r = min(size * of_weight, 1.0);
    float ratio = normals_concentration_ratio(r, lacks * of_weight);
    float concentration = clamp(size * ratio * (over * size * stored.w), NORMALS_MIN_CONCENTRATION, NORMALS_MAX_CONCENTRATION);
    return NormalsLobe(stored.xyz * (over * stored.w * lacks), concentration, r);
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
    float mean;
    float across; // variance across its axis
    float own;
    float other;
    float apart; // 1 - cosine of its axis and the direction
    float factor;
    float exponent;
};

// `apart`: 1 - cosine of the lobe's axis and the direction. Quotients cost more than products: seven are made of two.
NormalsProduct normals_times(NormalsLobe lobe, float sharpness, float apart)
{
    const float least = 0.05; // of a concentration: products of what lies opposite, of which nothing is left
    float k = lobe.concentration;
    float both = k + sharpness;
    float crossed = 2.0 * k * sharpness * apart;
    float size = max(sqrt(max(both * both - crossed, 0.0)), least);
    float sum = size + both;
    float side = max(sum - k * apart, 1e-3 * size);
    float over = 1.0 / (size * sum * side);
    float inverse = over * sum * side;
    NormalsProduct product;
    product.own = k * inverse;
    product.other = sharpness * inverse;
    product.apart = product.own * (k * over * size * sum) * apart * (2.0 - apart);
    product.exponent = -crossed * (over * size * side);
    // The mean is that of `normals_mean_length`, by the inverse; (1 - exp(-2 k)) / k = 2 / (1 + k + k r), of both.
    float above = 0.2351182 + inverse * (0.5028762 + inverse);
    float below = 0.2351182 + inverse * (0.7379943 + inverse * (1.5689180 + 3.0 * inverse));
    float open = (1.0 + inverse) * below + above;
    float quotient = 1.0 / (below * open);
    product.mean = above * open * quotient;
    product.across = product.mean * inverse;
    product.factor = (1.0 + k + k * lobe.mean) * inverse * below * below * quotient;
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
    float squared = dot(stored.xyz, stored.xyz);
    float over = 1.0 / max(sqrt(squared) * stored.w, 1e-36);
    float r = min(squared * over, 1.0);
    return normals_clamped_cosine(normals_variance_across(r, 1.0 - r), r, stored.w * over * dot(stored.xyz, light));
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
    cosine = normals_clamped_cosine(product.across, product.mean, cosine);
    return stored.w * (exponent + 8.0) / (8.0 * PI) * integral * cosine;
}

#endif
