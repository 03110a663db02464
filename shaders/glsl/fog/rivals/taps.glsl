// The pass's own taps, with TAPS of them; rules beside the two that ship.

#define FOG_TAPS TAPS
#if TAPS == 1
const float FOG_CUT = 3.0;
const vec2 FOG_RULE[1] = vec2[](vec2(0.5, 1.0));
#endif
#if TAPS == 2
const float FOG_CUT = 4.0;
const vec2 FOG_RULE[1] = vec2[](
    vec2(0.2113248654051871, 0.5000000000000000));
#endif
#if TAPS == 4
const float FOG_CUT = 6.0;
const vec2 FOG_RULE[2] = vec2[](
    vec2(0.0694318442029737, 0.1739274225687268),
    vec2(0.3300094782075719, 0.3260725774312732));
#endif
#if TAPS == 8
const float FOG_CUT = 9.0;
const vec2 FOG_RULE[4] = vec2[](
    vec2(0.0198550717512319, 0.0506142681451885),
    vec2(0.1016667612931866, 0.1111905172266872),
    vec2(0.2372337950418355, 0.1568533229389434),
    vec2(0.4082826787521751, 0.1813418916891808));
#endif
#if TAPS == 12
const float FOG_CUT = 12.0;
const vec2 FOG_RULE[6] = vec2[](
    vec2(0.0092196828766404, 0.0235876681932557),
    vec2(0.0479413718147626, 0.0534696629976595),
    vec2(0.1150486629028477, 0.0800391642716732),
    vec2(0.2063410228566913, 0.1015837133615329),
    vec2(0.3160842505009099, 0.1167462682691773),
    vec2(0.4373832957442655, 0.1245735229067013));
#endif
#include "fog/path.glsl"
#include "fog/taps.glsl"

COLOUR rival_airlight(Configuration c, int steps)
{
    FogPath path = FogPath(c.along, c.off * c.off);
    FogSegment segment = fog_segment(path, 0.0, c.extent);
#if CHANNELS == 3
    float least = min(c.extinction.r, min(c.extinction.g, c.extinction.b));
#else
    float least = c.extinction;
#endif
    FogTaps taps = fog_taps(path, segment, least);
    COLOUR sum = COLOUR(0.0);
    for (int i = 0; i < TAPS; ++i) {
        FogTap tap = fog_tap(taps, path, segment, i);
        sum += tap.weight * exp(-c.extinction * tap.excess);
    }
    return c.seen * sum;
}
