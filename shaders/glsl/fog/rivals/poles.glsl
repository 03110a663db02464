// The closed form for an isotropic phase function and a homogeneous medium: two values of the scaled exponential
// integral, exp(z) E1(z) at z = extinction (m - i off). Beyond |z| = 1 a short sum of simple poles, all terms positive;
// within, the power series (Abramowitz and Stegun, 5.1.11). A short stretch, where the two values would cancel, is left
// to Gauss and Legendre. passes/fog/src/evaluator/poles.rs tells more.
//
// POLES  4, 6 terms and 2 points: relative error 1.2e-4 at the 99th percentile; 7, 9 terms and 4 points: 6e-7

#include "fog/path.glsl"
#include "common/angle.glsl"

#if POLES == 4
const vec2 RIVAL_NODES[4] = vec2[](
    vec2(0.108453356, 0.25063804),
    vec2(0.5877522, 0.38919064),
    vec2(1.6155156, 0.28881404),
    vec2(3.8521125, 0.07127286));
const int RIVAL_TERMS = 6;
const int RIVAL_POINTS = 2;
const vec2 RIVAL_RULE[2] = vec2[](vec2(0.21132487, 0.5), vec2(0.7886751, 0.5));
#else
const vec2 RIVAL_NODES[7] = vec2[](
    vec2(0.042866476, 0.10601735),
    vec2(0.2311361, 0.21361962),
    vec2(0.5921561, 0.25564188),
    vec2(1.1872306, 0.22943391),
    vec2(2.166113, 0.14372684),
    vec2(3.8336155, 0.047197174),
    vec2(6.8819103, 0.0043629776));
const int RIVAL_TERMS = 9;
const int RIVAL_POINTS = 4;
const vec2 RIVAL_RULE[4] = vec2[](
    vec2(0.06943184, 0.17392743),
    vec2(0.3300095, 0.32607257),
    vec2(0.66999054, 0.32607257),
    vec2(0.93056816, 0.17392743));
#endif

// Of Ein(z) / z, from the first.
const float RIVAL_SERIES[9] = float[](
    1.0, -1.0 / 4.0, 1.0 / 18.0, -1.0 / 96.0, 1.0 / 600.0, -1.0 / 4320.0, 1.0 / 35280.0, -1.0 / 322560.0, 1.0 / 3265920.0);

// Integral of exp(-extinction q) / (off^2 + (m + q)^2) over all q, 1/m.
float rival_endless(float extinction, float off, float m)
{
    float u = extinction * off;
    float w = extinction * m;
    float squared = u * u;
    float norm = squared + w * w;
    if (norm >= 1.0) {
        float sum = 0.0;
        for (int i = 0; i < POLES; ++i) {
            float q = w + RIVAL_NODES[i].x;
            sum += RIVAL_NODES[i].y / (squared + q * q);
        }
        return extinction * sum;
    }
    // Ein(z) as its real part a and imaginary part u b.
    float a = 0.0;
    float b = 0.0;
    for (int i = RIVAL_TERMS - 1; i >= 0; --i) {
        float next = a * w + squared * b + RIVAL_SERIES[i];
        b = b * w - a;
        a = next;
    }
    float last = a * w + squared * b;
    b = b * w - a;
    a = last;
    float cosine = 1.0 + squared * (-1.0 / 2.0 + squared * (1.0 / 24.0 - squared * (1.0 / 720.0 - squared / 40320.0)));
    float sine = 1.0 + squared * (-1.0 / 6.0 + squared * (1.0 / 120.0 - squared * (1.0 / 5040.0 - squared / 362880.0)));
    float logarithm = 0.5772157 + 0.5 * log(max(norm, 1e-37));
    float angle = angle_of(off, m) / off;
    return exp(w) * (cosine * (angle + extinction * b) + extinction * sine * (logarithm - a));
}

float rival_grey(float extinction, float off, FogSegment segment)
{
    float squared = off * off;
    float depth = extinction * segment.excess;
    if (depth <= 0.5 && 4.0 * segment.excess * segment.excess <= squared + segment.start * segment.start) {
        float sum = 0.0;
        for (int i = 0; i < RIVAL_POINTS; ++i) {
            float q = segment.excess * RIVAL_RULE[i].x;
            float m = segment.start + q;
            sum += RIVAL_RULE[i].y * exp(-extinction * q) / (squared + m * m);
        }
        return 2.0 * segment.excess * sum;
    }
    float near = rival_endless(extinction, off, segment.start);
    if (depth >= 20.0) { return 2.0 * near; }
    float far = exp(-depth) * rival_endless(extinction, off, segment.start + segment.excess);
    return 2.0 * max(near - far, 0.0);
}

COLOUR rival_airlight(Configuration c, int steps)
{
    FogPath path = FogPath(c.along, c.off * c.off);
    FogSegment segment = fog_segment(path, 0.0, c.extent);
#if CHANNELS == 3
    return c.seen * vec3(
        rival_grey(c.extinction.r, c.off, segment),
        rival_grey(c.extinction.g, c.off, segment),
        rival_grey(c.extinction.b, c.off, segment));
#else
    return c.seen * rival_grey(c.extinction, c.off, segment);
#endif
}
