// Exponentials of functions given by spherical harmonics (Sun 2008, section 5.2.2; Ren et al. 2006). `*` is the product
// cut off at the order. The mean is set apart (equation 5.25), its share goes into what is squared (equation 5.26), so that
// nothing overflows on the way.
//
// The includer defines ORDER, 3 to 6, and EXPONENTIAL:
//   0  the series by Horner's rule; degree 0: a degree that follows the norm
//   1  the series of degree 2, squarings
//   2  optimal linear, squarings; the includer defines SHADOW_LINEAR(at), a and b of entry `at`, and SHADOW_LINEAR_END
//   3  the factored series of equation 5.27
//   4  the exponential of the product matrix, by steps of its series

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
void exponential(inout float f[COUNT], Exponential how)
{
    float mean, norm;
    uint squarings = scale_down(f, how, mean, norm);
    uint degree = how.degree != 0u ? how.degree : uint(ceil(2.0 + 2.5 * min(norm, 100.0)));
    float g[COUNT];
    float h[COUNT];
    float left[COUNT];
    float last = mean / float(degree);
    EACH(i) { g[i] = last * f[i]; }
    g[0] += mean * ONE;
    // Steps of the series, then squarings: one loop, so that the product stands in the program once.
    uint steps = degree - 1u;
    for (uint at = 0u; at < steps + squarings; ++at) {
        bool series = at < steps;
        EACH(i) { left[i] = series ? f[i] : g[i]; }
        sh_product(left, g, h);
        float factor = series ? 1.0 / float(degree - 1u - at) : 1.0;
        EACH(i) { g[i] = factor * h[i]; }
        g[0] += series ? mean * ONE : 0.0;
    }
    f = g;
}
#elif EXPONENTIAL == 1
void exponential(inout float f[COUNT], Exponential how)
{
    float mean, norm;
    uint squarings = scale_down(f, how, mean, norm);
    float g[COUNT] = f;
    float h[COUNT];
    for (uint at = 0u; at <= squarings; ++at) {
        sh_square(g, h);
        if (at == 0u) {
            EACH(i) { g[i] = mean * (f[i] + 0.5 * h[i]); }
            g[0] += mean * ONE;
        } else {
            g = h;
        }
    }
    f = g;
}
#elif EXPONENTIAL == 2
void exponential(inout float f[COUNT], Exponential how)
{
    float mean, norm;
    uint squarings = scale_down(f, how, mean, norm);
    float place = min(norm / SHADOW_LINEAR_END, 1.0) * 256.0;
    uint entry = min(uint(place), 255u);
    vec2 fit = mean * mix(SHADOW_LINEAR(entry), SHADOW_LINEAR(entry + 1u), place - float(entry));
    EACH(i) { f[i] *= fit.y; }
    f[0] += fit.x * ONE;
    float h[COUNT];
    for (uint at = 0u; at < squarings; ++at) {
        sh_square(f, h);
        f = h;
    }
}
#elif EXPONENTIAL == 3
void exponential(inout float f[COUNT], Exponential how)
{
    float mean, norm;
    uint squarings = scale_down(f, how, mean, norm);
    float square[COUNT];
    sh_square(f, square);
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
        sh_square(f, h);
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
