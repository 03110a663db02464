// The thesis's own road: two entries of the table of F(u, v) (Sun 2008, eq. 3.16 and section 3.5), u from 0 to 10 along
// y, v from 0 to pi / 2 along x, texels at both ends. ENTRIES_ONLY: the two fetches without what they are for.

layout(set = 0, binding = 2) uniform texture2D table;
layout(set = 0, binding = 3) uniform sampler table_sampler;

float rival_entry(float u, float v)
{
    vec2 size = vec2(textureSize(sampler2D(table, table_sampler), 0));
    vec2 place = vec2(v / HALF_PI, u / 10.0);
    return textureLod(sampler2D(table, table_sampler), (place * (size - 1.0) + 0.5) / size, 0.0).r;
}

float rival_grey(float extinction, float along, float off, float extent)
{
#if ENTRIES_ONLY
    return rival_entry(extinction, along) - rival_entry(extinction, off);
#else
    float angle = atan(off, along);
    float u = extinction * off;
    float v = QUARTER_PI + 0.5 * atan((extent - along) / off);
    return 2.0 * exp(-extinction * along) / off * (rival_entry(u, v) - rival_entry(u, 0.5 * angle));
#endif
}

COLOUR rival_airlight(Configuration c, int steps)
{
#if CHANNELS == 3
    return vec3(
        rival_grey(c.extinction.r, c.along, c.off, c.extent),
        rival_grey(c.extinction.g, c.along, c.off, c.extent),
        rival_grey(c.extinction.b, c.along, c.off, c.extent));
#else
    return rival_grey(c.extinction, c.along, c.off, c.extent);
#endif
}
