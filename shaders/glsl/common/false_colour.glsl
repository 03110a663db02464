// Colours for numbers, for debug views: from dark blue through green to pale yellow, ever brighter, so that the order of
// values is seen without a legend and in grey.

#ifndef COMMON_FALSE_COLOUR_GLSL
#define COMMON_FALSE_COLOUR_GLSL

// sRGB-encoded colours at equal steps; the same in `engine/scene/src/false_colour.rs`.
const vec3 false_colour_stops[6] = vec3[6](
    vec3(0.06, 0.02, 0.22),
    vec3(0.20, 0.18, 0.56),
    vec3(0.09, 0.45, 0.60),
    vec3(0.20, 0.67, 0.44),
    vec3(0.68, 0.84, 0.24),
    vec3(1.00, 0.97, 0.72)
);

// The colour of a value from 0 to 1, for a display: sRGB-encoded. Values outside take the colour of the nearest end; what is
// not a number is magenta.
vec3 false_colour(float value)
{
    if ((floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u) { return vec3(1.0, 0.0, 1.0); }
    float place = 5.0 * clamp(value, 0.0, 1.0);
    int below = min(int(place), 4);
    return mix(false_colour_stops[below], false_colour_stops[below + 1], place - float(below));
}

// The same for a value between two ends.
vec3 false_colour(float value, float low, float high)
{
    return false_colour((value - low) / (high - low));
}

#endif
