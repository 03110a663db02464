// The integral over the light paths of a segment, by Gauss and Legendre's rule in a variable that suits it: no
// trigonometry, and no end that a tap would have to reach.
//
// Integral of exp(-extinction (x + d)) / d^2 dx = exp(-extinction shortest) 2 Integral of exp(-extinction q) / (off^2 + (start + q)^2) dq
// over the excess q. With q = s r y / (1 - y)^2, r = sqrt(off^2 + start^2), the integrand is smooth in y from a point
// light's glow to the end of an infinite ray. s and the cut are fitted to the largest error over 16 decades of inputs.
//
// FOG_TAPS  6: relative error 4e-4 at the 99th percentile, 7e-4 at most; 16: 5e-6 and 1e-5

const float FOG_STRETCH = 1.5;
#if FOG_TAPS == 6
// Optical length beyond which what is left is below the error.
const float FOG_CUT = 8.0;
// Nodes in the first half of 0 to 1 and their weights; the second half mirrors them.
const vec2 FOG_RULE[3] = vec2[](
    vec2(0.0337652428984240, 0.0856622461895851),
    vec2(0.1693953067668678, 0.1803807865240694),
    vec2(0.3806904069584016, 0.2339569672863455));
#endif
#if FOG_TAPS == 16
// Optical length beyond which what is left is below the error.
const float FOG_CUT = 15.0;
// Nodes in the first half of 0 to 1 and their weights; the second half mirrors them.
const vec2 FOG_RULE[8] = vec2[](
    vec2(0.0052995325041750, 0.0135762297058771),
    vec2(0.0277124884633837, 0.0311267619693237),
    vec2(0.0671843988060841, 0.0475792558412463),
    vec2(0.1222977958224985, 0.0623144856277670),
    vec2(0.1910618777986781, 0.0747979944082884),
    vec2(0.2709916111713863, 0.0845782596975013),
    vec2(0.3591982246103705, 0.0913017075224618),
    vec2(0.4524937450811813, 0.0947253052275343));
#endif

// What all taps of a segment share.
struct FogTaps {
    float scale;  // s r
    float finish; // 1 - y at the end
    float extent; // y at the end
};

// One point of the rule.
struct FogTap {
    float excess;
    float weight; // with 2 / d^2 in it
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
    float excess = taps.scale * y / (o * o);
    float m = segment.start + excess;
    float slope = taps.scale * (1.0 + y) / (o * o * o);
    return FogTap(excess, 2.0 * rule.y * taps.extent * slope / (path.off_squared + m * m));
}
