// The pass's own taps, with TAPS of them.

#define FOG_TAPS TAPS
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
