// The glow of a light along an endless ray: the scaled exponential integral, without table and without angles.
//
// Integral of exp(-T q) / (h^2 + (m + q)^2) dq over q >= 0 is Im(exp(z) E1(z)) / h at z = T (m - i h) (Sun 2008, eq. 3.16
// for an endless ray). Beyond |z| = 1 it is a sum of simple poles whose nodes were fitted for the least largest relative
// error, 4e-7; within, the power series of E1 (Abramowitz and Stegun, 5.1.11). All terms but those of the logarithm are
// positive, so nothing cancels however close the ray passes.

#ifndef FOG_GLOW_GLSL
#define FOG_GLOW_GLSL

#include "common/angle.glsl"

const vec2 FOG_POLES[7] = vec2[](
    vec2(0.042866476, 0.10601735),
    vec2(0.2311361, 0.21361962),
    vec2(0.5921561, 0.25564188),
    vec2(1.1872306, 0.22943391),
    vec2(2.166113, 0.14372684),
    vec2(3.8336155, 0.047197174),
    vec2(6.8819103, 0.0043629777));

// Coefficients of Ein(z) / z: -(-1)^k / (k k!) for k from 1.
const float FOG_SERIES[9] = float[](
    1.0, -1.0 / 4.0, 1.0 / 18.0, -1.0 / 96.0, 1.0 / 600.0, -1.0 / 4320.0, 1.0 / 35280.0, -1.0 / 322560.0, 1.0 / 3265920.0);

const float FOG_EULER_GAMMA = 0.577215664901533;

// Im(exp(z) E1(z)) / h at z = extinction (start - i offset), 1/m, for start >= 0 and offset above 0.
float fog_endless(float extinction, float offset, float start)
{
    float u = extinction * offset;
    float w = extinction * start;
    float squared = u * u;
    float norm = squared + w * w;
    if (norm >= 1.0) {
        float sum = 0.0;
        for (int k = 0; k < 7; ++k) {
            float far = w + FOG_POLES[k].x;
            sum += FOG_POLES[k].y / (squared + far * far);
        }
        return extinction * sum;
    }
    // Ein(z), as its real part and its imaginary part over u.
    vec2 ein = vec2(0.0);
    for (int k = 8; k >= 0; --k) {
        ein = vec2(ein.x * w + squared * ein.y + FOG_SERIES[k], ein.y * w - ein.x);
    }
    ein = vec2(ein.x * w + squared * ein.y, ein.y * w - ein.x);
    float cosine = 1.0 + squared * (-0.5 + squared * (1.0 / 24.0 - squared * (1.0 / 720.0 - squared / 40320.0)));
    float sine_over_u =
        1.0 + squared * (-1.0 / 6.0 + squared * (1.0 / 120.0 - squared * (1.0 / 5040.0 - squared / 362880.0)));
    float logarithm = FOG_EULER_GAMMA + 0.5 * log(max(norm, 1e-37));
    float angle_over_offset = angle_of(offset, start) / offset;
    return exp(w)
        * (cosine * (angle_over_offset + extinction * ein.y) + extinction * sine_over_u * (logarithm - ein.x));
}

// Im(exp(z) E1(z)) over the sine, for a light of optical distance `distance` at an angle from the ray: by the angle's
// sine and its versine, 1 - cosine, which near the light is not to be had from the cosine.
float fog_glow(float distance, float sine, float versine)
{
    return fog_endless(distance, max(sine, 1e-9), versine);
}

#endif
