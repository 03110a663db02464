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
};

// coth k - 1/k, and its limits where these cancel.
float normals_mean_length(float k)
{
    float square = k * k;
    if (k < 0.5) { return k / 3.0 * (1.0 - square / 15.0 * (1.0 - square * (2.0 / 21.0))); }
    float decay = exp(-2.0 * k);
    return (1.0 + decay) / (1.0 - decay) - 1.0 / k;
}

// The concentration of a mean vector of length r, within 2.5e-3: Banerjee's formula and one step of Newton's method; past
// 0.9, where coth is 1 to 4e-9, in closed form.
float normals_concentration(float r)
{
    float k;
    if (r > 0.9) {
        k = 1.0 / max(1.0 - r, 1e-7);
    } else {
        r = max(r, 0.0);
        k = max(r * (3.0 - r * r) / (1.0 - r * r), NORMALS_MIN_CONCENTRATION);
        float found = normals_mean_length(k);
        float slope = 1.0 - found * found - 2.0 * found / k;
        k -= (found - r) / slope;
    }
    return clamp(k, NORMALS_MIN_CONCENTRATION, NORMALS_MAX_CONCENTRATION);
}

NormalsLobe normals_lobe(vec4 stored)
{
    float moment = length(stored.xyz);
    vec3 axis = moment > 0.0 ? stored.xyz / moment : vec3(0.0, 0.0, 1.0);
    return NormalsLobe(axis, normals_concentration(stored.w > 0.0 ? moment / stored.w : 0.0));
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

// The lobe that a lobe becomes times exp(sharpness (n.direction - 1)), and the integral of the product as
// factor * exp(exponent): a height on top, which may be huge where the integral is tiny, goes into the exponent.
NormalsLobe normals_times(NormalsLobe lobe, float sharpness, vec3 direction, out float factor, out float exponent)
{
    float k = lobe.concentration;
    vec3 sum = k * lobe.axis + sharpness * direction;
    float size = max(length(sum), 1e-6);
    exponent = -2.0 * k * sharpness * normals_versine(lobe.axis, direction) / (size + k + sharpness);
    factor = normals_opening(size) / normals_opening(k);
    return NormalsLobe(sum / size, size);
}

// Mean of the clamped cosine over a lobe, n.light taken as normally distributed with the lobe's mean and variance.
float normals_clamped_cosine(NormalsLobe lobe, vec3 light)
{
    float k = max(lobe.concentration, NORMALS_MIN_CONCENTRATION);
    float r = normals_mean_length(k);
    float cosine = dot(lobe.axis, light);
    float along = k > 20.0 ? 1.0 / (k * k) : 1.0 - r * r - 2.0 * r / k;
    float variance = along * cosine * cosine + r / k * max(1.0 - cosine * cosine, 0.0);
    float deviation = sqrt(max(variance, 1e-14));
    float x = r * cosine / deviation;
    float bell = exp(-0.5 * x * x) * 0.3989422804;
    // Abramowitz and Stegun 26.2.17.
    float t = 1.0 / (1.0 + 0.2316419 * abs(x));
    float tail = bell * t
        * (0.319381530 + t * (-0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))));
    return max(r * cosine * (x < 0.0 ? tail : 1.0 - tail) + deviation * bell, 0.0);
}

// Lambert, albedo 1: the mean of (n.l)+ / pi.
float normals_lambert(vec4 stored, vec3 light)
{
    return stored.w * normals_clamped_cosine(normals_lobe(stored), light) / PI;
}

// ln(1 - x) with all digits where x is small.
float normals_log_one_minus(float x)
{
    return x < 0.02 ? -x * (1.0 + x * (0.5 + x * (1.0 / 3.0 + 0.25 * x))) : log(1.0 - x);
}

// The mean of (s + 8) / (8 pi) (n.h)^s (n.l)+: the power as an exponential whose height is right at the product's axis.
float normals_blinn_phong(vec4 stored, float exponent, vec3 light, vec3 half_vector)
{
    float sharpness = exponent + 1.0;
    float factor;
    float fall;
    NormalsLobe product = normals_times(normals_lobe(stored), sharpness, half_vector, factor, fall);
    float x = normals_versine(product.axis, half_vector);
    if (x >= 1.0) { return 0.0; }
    float integral = factor * exp(fall + exponent * normals_log_one_minus(x) + sharpness * x);
    return stored.w * (exponent + 8.0) / (8.0 * PI) * integral * normals_clamped_cosine(product, light);
}

#endif
