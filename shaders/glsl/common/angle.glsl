// The angle of a vector, to about 2e-7: some drivers' atan is good to 3e-6 only and their acos to 2e-4.

#ifndef COMMON_ANGLE_GLSL
#define COMMON_ANGLE_GLSL

#include "common/constants.glsl"

// The angle of (x, y) from the x axis, in [-pi, pi]; 0 for the zero vector. Reduced to |t| <= tan(pi/8), where an
// odd polynomial fitted to the smallest largest relative error (7e-10 before rounding) takes over.
float angle_of(float y, float x)
{
    float large = max(abs(x), abs(y));
    float small = min(abs(x), abs(y));
    if (large == 0.0) {
        return 0.0;
    }
    bool above = small > 0.414213562373095 * large;
    float t = above ? (small - large) / (small + large) : small / large;
    float t2 = t * t;
    float series = -0.3333331551
        + t2 * (0.1999848943 + t2 * (-0.1424384862 + t2 * (0.1059600081 - 0.06083451677 * t2)));
    float angle = t + t * t2 * series;
    angle = above ? angle + QUARTER_PI : angle;
    angle = abs(y) > abs(x) ? HALF_PI - angle : angle;
    angle = x < 0.0 ? PI - angle : angle;
    return y < 0.0 ? -angle : angle;
}

#endif
