// The integral over the light paths of a segment, by Gauss and Legendre's rule in a variable that suits it: no
// trigonometry, and no end that a tap would have to reach.
//
// Integral of exp(-extinction (x + d)) / d^2 dx = exp(-extinction shortest) 2 Integral of exp(-extinction q) / (off^2 + (start + q)^2) dq
// over the excess q. With q = s r y / (1 - y)^2, r = sqrt(off^2 + start^2), the integrand is smooth in y from a point
// light's glow to the end of an infinite ray. s and the cut are fitted to the largest error over 16 decades of inputs.
//
// FOG_TAPS  6: relative error 4e-4 at the 99th percentile, 7e-4 at most; 16: 5e-6 and 1e-5

#include "fog/rule.glsl"

const float FOG_STRETCH = 1.5;

// What all taps of a segment share.
struct FogTaps {
    float scale;  // s r
    float finish; // 1 - y at the end
    float extent; // y at the end
};

// One point of the rule.
struct FogTap {
    float excess;
    float weight;  // with 2 / d^2 in it
    float density; // 1 / (off^2 + m^2): times off^2 and m^2 the squared cosine and sine of half the scattering angle
};

// `least` is the smallest extinction that the taps are to serve, 1/m. A `path` that is said to be off the light by another
// distance gives the taps that other scale.
FogTaps fog_taps(FogPath path, FogSegment segment, float least)
{
    float excess = min(segment.excess, FOG_CUT / max(least, 1e-30));
    float scale = FOG_STRETCH * sqrt(path.off_squared + segment.start * segment.start);
    float v = min(excess / scale, 1e10);
    float finish = 2.0 / (1.0 + sqrt(1.0 + 4.0 * v));
    return FogTaps(scale, finish, v > 1.0 ? 1.0 - finish : v * finish * finish);
}

// Tap i of FOG_TAPS.
FogTap fog_tap(FogTaps taps, FogPath path, FogSegment segment, int i)
{
    bool mirrored = i >= FOG_TAPS / 2;
    vec2 rule = FOG_RULE[mirrored ? FOG_TAPS - 1 - i : i];
    vec2 sides = mirrored ? vec2(1.0 - rule.x, rule.x) : vec2(rule.x, 1.0 - rule.x);
    float y = taps.extent * sides.x;
    float o = taps.finish + taps.extent * sides.y;
    float inverse = 1.0 / o;
    float squared = inverse * inverse;
    float excess = taps.scale * y * squared;
    float m = segment.start + excess;
    float density = 1.0 / (path.off_squared + m * m);
    float slope = taps.scale * (1.0 + y) * (squared * inverse);
    return FogTap(excess, 2.0 * rule.y * taps.extent * slope * density, density);
}
