// Exponentials of functions given by spherical harmonics (Sun 2008, section 5.2.2; Ren et al. 2006). `*` is the product
// cut off at the order. The mean is set apart (equation 5.25), its share goes into what is squared (equation 5.26), so that
// nothing overflows on the way.
//
// The includer defines ORDER, 3 to 6, and EXPONENTIAL:
//   0  a polynomial by Horner's rule: of a degree, the series; degree 0: that of the vector's own interval, of the table
//   1  the series of degree 2 or, degree 1, optimal linear, and squarings; a and b of the first powers from the table
//   3  the factored series of equation 5.27
//   4  the exponential of the product matrix, by steps of its series
// For 0 and 1, SHADOW_TABLE(at), a float of the table of the exponential, and SHADOW_TABLE_END, where that of 1 ends.

#ifndef SHADOW_EXPONENTIAL_GLSL
#define SHADOW_EXPONENTIAL_GLSL

#if ORDER == 3
#include "shadow/product3.glsl"
#elif ORDER == 4
#include "shadow/product4.glsl"
#elif ORDER == 5
#include "shadow/product5.glsl"
#elif ORDER == 6
#include "shadow/product6.glsl"
#include "common/sh_basis.glsl"
#include "shadow/latitudes6.glsl"
#else
#error exponential.glsl: define ORDER as 3, 4, 5 or 6
#endif

const int COUNT = ORDER * ORDER;
// Over all coefficients. Mesa unrolls no loop of more than 32 steps, and an array that is not unrolled lies in memory.
#define EACH(i)                                                                                                         \
    for (int row = 0; row < ORDER; ++row)                                                                               \
        for (int column = 0, i = row * ORDER; column < ORDER; ++column, ++i)
// sqrt(4 pi), the first coefficient of the constant 1.
const float ONE = 3.544907701811032;

struct Exponential {
    uint degree; // of a series; 0: by the norm
    float norm;  // scaled to at most this before squarings
    uint whole;  // 1: the mean is not set apart
};

float without_mean(float f[COUNT])
{
    float sum = 0.0;
    EACH(i) { sum = i == 0 ? 0.0 : fma(f[i], f[i], sum); }
    return sqrt(sum);
}

// Scales f for the squarings that are returned, and takes its mean out.
uint scale_down(inout float f[COUNT], Exponential how, out float mean, out float length_left)
{
    float norm = without_mean(f);
    // No squarings where the norm is not finite either.
    uint squarings = norm > how.norm && norm < 1e30 ? uint(ceil(log2(norm / how.norm))) : 0u;
    float scale = exp2(-float(squarings));
    EACH(i) { f[i] *= scale; }
    length_left = norm * scale;
    mean = 1.0;
    if (how.whole == 0u) {
        mean = exp(f[0] / ONE);
        f[0] = 0.0;
    }
    return squarings;
}

#if EXPONENTIAL == 0
// The largest eigenvalue of the product matrix of a vector without mean and of norm 1.
const float BOUND = ORDER == 3 ? 0.4947 : ORDER == 4 ? 0.6873 : ORDER == 5 ? 0.8774 : 1.0633;

// No logarithm of what blocks in different places is longer without its mean.
const float LONGEST = 15.0;
// Nor has its product matrix eigenvalues that may be higher: what a polynomial is off grows with their exponential.
const float HIGHEST = 2.5;
// From which on spheres in one place were counted for each.
const float EXCESS = 0.05;

// The interval that holds the eigenvalues of the product matrix: upper end and half of the width.
vec2 eigenvalues(float mean, float norm)
{
    float reach = BOUND * norm;
    float up = min(reach, max(0.2 - mean, 0.5 * reach));
    return vec2(mean + up, 0.5 * (up + reach));
}

#if ORDER == 6
// In a loop: a straight line of so many products is compiled for long, and is no faster.
#define step_product sh_product_by_latitudes
#else
#define step_product sh_product
#endif

// Of the table: that of the half width, or the two that it lies between.
struct Row {
    uint upper;
    float share;
};

float coefficient_of(Row row, uint power)
{
    return mix(SHADOW_TABLE(row.upper - 16u + power), SHADOW_TABLE(row.upper + power), row.share);
}

// By Horner's rule: the two highest powers, then a product for each lower one, then squarings; one loop, so that the product
// stands in the program once. Without `row` coefficients are those of the series.
void horner(float f[COUNT], float begin, uint degree, Row row, bool series, uint squarings, out float g[COUNT])
{
    float coefficient = series ? begin : begin * coefficient_of(row, degree);
    EACH(i) { g[i] = coefficient * f[i]; }
    coefficient = series ? coefficient * float(degree) : begin * coefficient_of(row, degree - 1u);
    g[0] += coefficient * ONE;
    uint steps = degree - 1u;
    uint products = steps + squarings;
    if (products == 0u) { return; }
    uint at = 0u;
    do {
        bool squaring = at >= steps;
        float left[COUNT];
        float h[COUNT];
        EACH(i) { left[i] = squaring ? g[i] : f[i]; }
        step_product(left, g, h);
        g = h;
        if (!squaring) {
            uint power = steps - 1u - at;
            coefficient = series ? coefficient * float(power + 1u) : begin * coefficient_of(row, power);
            g[0] += coefficient * ONE;
        }
        ++at;
    } while (at < products);
}

// The logarithm of how much more the square of a function holds than the function; none from 0 to 1 has any. Noise about 0
// has none either.
float excess(float g[COUNT])
{
    float square = 0.0;
    EACH(i) { square = fma(g[i], g[i], square); }
    return log(max(square, 1e-30) / (ONE * max(g[0], 0.0) + 0.02 * ONE * ONE));
}

void exponential(inout float f[COUNT], Exponential how)
{
    bool series = how.degree > 0u;
    float mean, norm;
    float scale = 1.0;
    float begin = 1.0; // of what the coefficients are scaled by
    uint squarings = 0u;
    if (series) {
        squarings = scale_down(f, how, mean, norm);
        begin = mean;
        for (uint k = how.degree; k > 1u; --k) { begin /= float(k); }
    } else {
        mean = f[0] / ONE;
        norm = without_mean(f);
        float top = mean + 0.5 * BOUND * norm;
        scale = min(LONGEST / max(norm, LONGEST), HIGHEST / max(top, HIGHEST));
    }
    float g[COUNT];
    // Where spheres in one place were counted for each, once more with as much less of all.
    for (uint attempt = 0u; attempt < 2u; ++attempt) {
        float t[COUNT] = f;
        uint degree = how.degree;
        Row row = Row(16u, 1.0);
        if (!series) {
            vec2 interval = eigenvalues(scale * mean, scale * norm);
            float place = clamp(8.0 * log2(max(interval.y, 1e-30) / 16.0) + 112.0, 0.0, 112.0);
            float upper = max(ceil(place), 1.0);
            row = Row(16u * uint(upper), place - upper + 1.0);
            degree = uint(SHADOW_TABLE(row.upper + 15u));
            float inverse = exp2((112.0 - place) / 8.0) / 16.0;
            EACH(i) { t[i] *= scale * inverse; }
            t[0] -= (interval.x * inverse - 1.0) * ONE;
            begin = exp(interval.x);
        }
        horner(t, begin, degree, row, series, squarings, g);
        float more = series ? 0.0 : excess(g);
        if (!(more > EXCESS)) { break; }
        scale *= EXCESS / more;
    }
    f = g;
}
#elif EXPONENTIAL == 1
void exponential(inout float f[COUNT], Exponential how)
{
    float mean, norm;
    uint squarings = scale_down(f, how, mean, norm);
    float place = min(norm / SHADOW_TABLE_END, 1.0) * 256.0;
    uint entry = 2u * min(uint(place), 255u);
    float t = place - float(entry / 2u);
    float a = mean * mix(SHADOW_TABLE(entry), SHADOW_TABLE(entry + 2u), t);
    float b = mean * mix(SHADOW_TABLE(entry + 1u), SHADOW_TABLE(entry + 3u), t);
    float g[COUNT] = f;
    float h[COUNT];
    EACH(i) { f[i] *= b; }
    f[0] += a * ONE;
    // The square of the series first, then those that undo the scaling: one loop, as above.
    uint steps = how.degree > 1u ? 1u : 0u;
    uint squares = steps + squarings;
    if (squares == 0u) { return; }
    uint at = 0u;
    do {
        bool series = at < steps;
        EACH(i) { g[i] = series ? g[i] : f[i]; }
        sh_square(g, h);
        EACH(i) { f[i] = series ? f[i] + 0.5 * mean * h[i] : h[i]; }
        ++at;
    } while (at < squares);
}
#elif EXPONENTIAL == 3
void exponential(inout float f[COUNT], Exponential how)
{
    float mean, norm;
    uint squarings = scale_down(f, how, mean, norm);
    float square[COUNT];
    sh_product(f, f, square);
    float even[COUNT];
    float odd[COUNT];
    float power[COUNT] = square;
    EACH(i) {
        even[i] = 0.0;
        odd[i] = 0.0;
    }
    even[0] = ONE;
    odd[0] = ONE;
    float factorial = 1.0;
    float h[COUNT];
    for (uint k = 2u; k <= how.degree; ++k) {
        factorial /= float(k);
        EACH(i) {
            if (k % 2u == 0u) { even[i] += factorial * power[i]; } else { odd[i] += factorial * power[i]; }
        }
        if (k % 2u == 1u) {
            sh_product(power, square, h);
            power = h;
        }
    }
    sh_product(f, odd, h);
    EACH(i) { f[i] = mean * (even[i] + h[i]); }
    for (uint at = 0u; at < squarings; ++at) {
        sh_product(f, f, h);
        f = h;
    }
}
#elif EXPONENTIAL == 4
void exponential(inout float f[COUNT], Exponential how)
{
    float mean, norm;
    how.norm = 1e30;
    scale_down(f, how, mean, norm);
    // exp(M) 1 as steps of exp(M / steps), each a series of degree 16.
    uint steps = uint(ceil(clamp(norm, 1.0, 1000.0)));
    float g[COUNT];
    float h[COUNT];
    EACH(i) { g[i] = 0.0; }
    g[0] = ONE;
    float part = pow(mean, 1.0 / float(steps));
    for (uint at = 0u; at < steps; ++at) {
        float begin[COUNT] = g;
        for (uint k = 16u; k > 0u; --k) {
            sh_product(f, g, h);
            float factor = 1.0 / (float(steps) * float(k));
            EACH(i) { g[i] = begin[i] + factor * h[i]; }
        }
        EACH(i) { g[i] *= part; }
    }
    f = g;
}
#endif

// Makes a vector one that a function from 0 to 1 can have: the mean between 0 and 1, and the square's integral at most the
// function's own. Whether it had to. Not a number becomes 0.
bool clamp_visibility(inout float g[COUNT])
{
    float mean = g[0] > 0.0 ? min(g[0], ONE) : 0.0;
    float square = 0.0;
    EACH(i) { square = i == 0 ? 0.0 : fma(g[i], g[i], square); }
    float most = mean * (ONE - mean);
    bool fits = g[0] == mean && square <= most;
    if (!fits) {
        float factor = square <= most ? 1.0 : most > 0.0 && square < 1e30 ? sqrt(most / square) : 0.0;
        EACH(i) { g[i] = factor == 0.0 ? 0.0 : factor * g[i]; }
        g[0] = mean;
    }
    return !fits;
}

#endif
