// Facets over lobes of normals: what GGX, Beckmann and the model of Torrance and Sparrow reflect of a distribution. Functions
// over values, no bindings.
//
// Han, Sun, Ramamoorthi and Grinspun 2007; Walter, Marschner, Li and Torrance 2007; Heitz 2014. Of a lobe each model gives
// the normals that reflect, of which the cosine and the masking are taken once.

#ifndef NORMALS_MICROFACET_GLSL
#define NORMALS_MICROFACET_GLSL

#include "normals/lobe.glsl"

// GGX, `peak / (1 + narrowing (1 - (n.h)^2))^2`: the same for all lobes.
struct NormalsGgx {
    float narrowing; // 1 / alpha^2 - 1
    float peak;      // 1 / (pi alpha^2)
};

NormalsGgx normals_ggx_of(float alpha)
{
    float over = 1.0 / max(alpha * alpha, 1e-8);
    return NormalsGgx(max(over - 1.0, 0.0), over / PI);
}

// The normals that reflect by D(n.h) of GGX, which blurred by a Gaussian stays `height / (1 + z slope + z^2 bend)^2`, by
// polynomials in 1 / (1 + blur) (`passes/normals/src/ggx.rs`). A reflection broader than the lobe sees of it its variance
// across, r / k, by squared sines; a narrower one its height on the axis, `beyond` more than that variance says, and its own
// shape, by chords. A Gaussian's products have their mean where the logarithm of the integral grows.
NormalsReflecting normals_reflecting_ggx(NormalsLobe lobe, NormalsGgx ggx, vec3 half_vector)
{
    float apart = normals_versine(lobe.axis, half_vector);
    float variance = normals_variance_across(lobe.mean, lobe.missing);
    float square = lobe.missing * lobe.missing;
    float beyond = lobe.missing + square * (1.1 + 3.0 * square); // (1 - exp(-2 k)) / r - 1
    float cut = 2.0 * square * square * square;                  // 2 exp(-2 k)
    // narrow = broad / (1 + broad) and sharp = 1 / (1 + broad (1 + beyond narrow)), of one quotient.
    float broad = 2.0 * ggx.narrowing * variance;
    float wide = 1.0 + broad;
    float blurred = wide * wide + beyond * broad * broad;
    float over = 1.0 / (wide * blurred);
    float narrow = broad * blurred * over;
    float sharp = wide * wide * over;
    float z = ggx.narrowing * sharp * apart * (2.0 - apart + narrow * (apart - cut));
    float blur = 1.0 - sharp;
    float height = 1.0 - blur * sharp * (1.66876 + sharp * (-4.13404 + sharp * (6.26377 - 3.24422 * sharp)));
    float slope = 1.0 - blur * (0.54523 + 0.84634 * sharp);
    float bend = 0.18006 * blur * z;
    float fall = 1.0 / (1.0 + z * (slope + bend));
    float own = max(1.0 - 2.0 * blur * fall * (slope + 2.0 * bend), 0.0);
    float other = 1.0 - own;
    NormalsReflecting reflecting;
    reflecting.integral = ggx.peak * sharp * height * fall * fall;
    reflecting.axis = (1.0 + own * other * apart) * (own * lobe.axis + other * half_vector);
    reflecting.mean = 1.0 - lobe.missing * own;
    reflecting.across = own * variance * (1.0 + beyond * narrow);
    return reflecting;
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

// The normals that reflect by D(n.h) of Beckmann, `exp(-tan^2 / alpha^2) / (pi alpha^2 cos^4)`, by the exponential that
// touches it at the axis of the product.
NormalsReflecting normals_reflecting_beckmann(NormalsLobe lobe, float alpha, vec3 half_vector)
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
    vec3 axis = product.own * lobe.axis + product.other * half_vector;
    return NormalsReflecting(integral, axis, product.mean, product.across);
}

// The mean of D(n.h) / 4 (n.l)+ by the normals that reflect.
float normals_unmasked(NormalsReflecting reflecting, vec3 light)
{
    return 0.25 * normals_lit(reflecting, light);
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

// The mean of D(n.h) G / (4 (n.l)+ (n.v)) (n.l)+ by the normals that reflect, the model of Torrance and Sparrow with GGX, but
// for Fresnel's factor: that depends on light and half vector alone, and is the caller's to multiply.
float normals_masked(NormalsReflecting reflecting, float alpha, vec3 light, vec3 view)
{
    float nl = normals_clamped_cosine(reflecting.across, reflecting.mean, dot(reflecting.axis, light));
    float nv = reflecting.mean * dot(reflecting.axis, view);
    return reflecting.integral * nl * normals_masking(alpha, nl, max(nv, 1e-4));
}

// The same of a lobe that is stored, times its weight. `ggx` is of `alpha`.
float normals_torrance_sparrow(vec4 stored, NormalsGgx ggx, float alpha, vec3 light, vec3 view, vec3 half_vector)
{
    return stored.w * normals_masked(normals_reflecting_ggx(normals_lobe(stored), ggx, half_vector), alpha, light, view);
}

#endif
