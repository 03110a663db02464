// The point spread function of fog, by which a distant picture is convolved: Sun 2008, section 3.6. Functions over values.

#ifndef FOG_SPREAD_GLSL
#define FOG_SPREAD_GLSL

#include "fog/glow.glsl"

const float FOG_HALF_OVER_PI = 0.159154943091895;

// Eq. 3.30 for an endless ray: the glow at an angle, by its sine and versine (1 - cosine), from a light at an optical
// distance, of its irradiance without fog; 1/sr, for an albedo of 1.
float fog_spread(float distance, float sine, float versine)
{
    return FOG_HALF_OVER_PI * distance * exp(-distance) * fog_glow(distance, sine, versine);
}

// Eq. 3.31 and 3.32: the same, taken apart into an amplitude of the distance and a shape of the angle, exact at 1.
float fog_spread_factored(float distance, float sine, float versine)
{
    return FOG_HALF_OVER_PI * distance * exp(-distance) * fog_glow(1.0, sine, versine);
}

#endif
