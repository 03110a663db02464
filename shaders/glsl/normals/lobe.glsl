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
    float mean;    // length of its mean vector
    float missing; // 1 - mean, with all its digits
    float ratio;   // concentration * missing / mean, 1 to 3
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
    float weight = max(stored.w, NORMALS_LEAST_WEIGHT);
    float size = sqrt(dot(stored.xyz, stored.xyz));
    bool directed = size > NORMALS_LEAST_MEAN * weight;
    size = directed ? size : NORMALS_LEAST_MEAN * weight;
    // Quotients cost more than products: two are made of one.
    float over = 1.0 / (size * weight);
    float of_weight = over * size;
    NormalsLobe lobe;
    lobe.axis = stored.xyz * (over * weight);
    lobe.axis.z = directed ? lobe.axis.z : 1.0; // all over the sphere: any will do
    lobe.mean = min(size * of_weight, 1.0);
    lobe.missing = max(weight - size, 1e-7 * weight) * of_weight;
    lobe.ratio = normals_concentration_ratio(lobe.mean, lobe.missing);
    lobe.concentration =
        clamp(lobe.mean * lobe.ratio / lobe.missing, NORMALS_MIN_CONCENTRATION, NORMALS_MAX_CONCENTRATION);
    return lobe;
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

// The mean of max(0, x) for a normally distributed x, within 4e-4 deviations; `inverse` is 1 over the deviation.
float normals_rectified(float mean, float deviation, float inverse)
{
    float x = abs(mean) * inverse;
    float t = max(1.0 - 0.21747024 * x, 0.0);
    t *= t;
    t *= t;
    return max(mean, 0.0) + deviation * t * t * (0.3989423 + 0.1949854 * x);
}

// Mean of the clamped cosine over a lobe of which the variance across, r / k, the length of the mean r and n.light on the
// axis are given, n.light taken as normally distributed with the lobe's mean and variance.
float normals_clamped_cosine(float across, float r, float cosine)
{
    float along = max(1.0 - r * r - 2.0 * across, 0.0);
    float variance = max(across + (along - across) * cosine * cosine, 1e-14);
    float inverse = inversesqrt(variance);
    return normals_rectified(r * cosine, variance * inverse, inverse);
}

// The same of a lobe.
float normals_clamped_cosine(NormalsLobe lobe, vec3 light)
{
    return normals_clamped_cosine(normals_variance_across(lobe.mean, lobe.missing), lobe.mean, dot(lobe.axis, light));
}

// Lambert, albedo 1: the mean of (n.l)+ / pi.
float normals_lambert(NormalsLobe lobe, vec3 light)
{
    return normals_clamped_cosine(lobe, light) / PI;
}

// The same of a lobe that is stored, times its weight.
float normals_lambert(vec4 stored, vec3 light)
{
    return stored.w * normals_lambert(normals_lobe(stored), light);
}

// Normals of a lobe, each weighed by what it reflects: the sum of weights, and a lobe of them, which may lie far from the
// lobe's own axis.
struct NormalsReflecting {
    float integral;
    vec3 axis;
    float mean;   // length of the mean vector
    float across; // variance across the axis
};

// Their radiance under a light, the mean of what reflects times (n.l)+. Many lobes are best shaded in rounds, all lobes, then
// what reflects of all, then all radiances: one after another each waits for its own chain of products.
float normals_lit(NormalsReflecting reflecting, vec3 light)
{
    return reflecting.integral * normals_clamped_cosine(reflecting.across, reflecting.mean, dot(reflecting.axis, light));
}

// The normals that reflect by (s + 8) / (8 pi) (n.h)^s. The power is an exponential of sharpness s + 1, whose product with
// the lobe is again a lobe, about `own` times the axis and `other` times the half vector, with a height that is right at that
// axis. Roots are a few terms of their series: where more would matter nothing is reflected.
NormalsReflecting normals_reflecting_blinn_phong(NormalsLobe lobe, float exponent, vec3 half_vector)
{
    float sharpness = exponent + 1.0;
    float concentration = lobe.mean * lobe.ratio; // times what is missing, as all that the quotient is of
    float over = 1.0 / (concentration + sharpness * lobe.missing);
    float own = concentration * over;
    float inverse = lobe.missing * over; // 1 / (concentration + sharpness)
    float other = sharpness * inverse;
    float apart = normals_versine(lobe.axis, half_vector);
    float bent = 2.0 * own * other * apart; // what the square of the product's sum of axes lacks to 1
    float stretch = 1.0 + bent * (0.5 + 0.375 * bent); // 1 / sqrt(1 - bent)
    float x = own * own * apart * (1.0 + 0.5 * bent); // 1 - cosine of the product's axis and the half vector
    float height = exponent * log(max(1.0 - x, 1e-30)) + sharpness * (x - own * apart * (1.0 + 0.3 * bent));
    float width = min(inverse * stretch, 1.0);
    NormalsReflecting reflecting;
    reflecting.integral =
        (exponent + 8.0) * (0.0625 / PI) * stretch * (inverse + own * (1.0 + lobe.mean)) * exp(height);
    reflecting.axis = stretch * (own * lobe.axis + other * half_vector);
    reflecting.mean = 1.0 - width;
    reflecting.across = width - width * width;
    return reflecting;
}

// The mean of (s + 8) / (8 pi) (n.h)^s (n.l)+ over a lobe that is stored, times its weight.
float normals_blinn_phong(vec4 stored, float exponent, vec3 light, vec3 half_vector)
{
    return stored.w * normals_lit(normals_reflecting_blinn_phong(normals_lobe(stored), exponent, half_vector), light);
}

#endif
