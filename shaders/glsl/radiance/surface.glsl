// Triangles that show pictures, as passes/radiance/src/shown.rs has them: a ray reads the pyramid of means linearly between
// texels and levels, where texels are as wide as the ray (Williams, "Pyramidal Parametrics", 1983).
//
// The includer defines a buffer of RGB `pictures`.

#ifndef RADIANCE_SURFACE_GLSL
#define RADIANCE_SURFACE_GLSL

struct Surface {
    vec4 first; // (u, v) of two corners
    vec4 last; // (u, v) of the third; texels along a metre
    uvec4 picture; // place of the first texel, columns, rows, levels
};

// Linearly between the middles of texels, the picture repeated.
vec3 surface_level(uint offset, uvec2 size, vec2 place)
{
    vec2 at = place * vec2(size) - 0.5;
    vec2 low = floor(at);
    vec2 part = at - low;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < 4u; ++i) {
        vec2 corner = vec2(i % 2u, i / 2u);
        vec2 texel = low + corner;
        uvec2 inside = min(uvec2(max(texel - floor(texel / vec2(size)) * vec2(size), vec2(0.0))), size - 1u);
        vec2 share = mix(1.0 - part, part, corner);
        sum += share.x * share.y * pictures[offset + inside.y * size.x + inside.x].rgb;
    }
    return sum;
}

// What is seen through texels of a level: between two of them.
vec3 surface_radiance(Surface surface, vec2 place, float level)
{
    uint last = surface.picture.w - 1u;
    level = clamp(level, 0.0, float(last));
    uint finer = uint(level);
    uint offset = surface.picture.x;
    uvec2 size = surface.picture.yz;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i <= min(finer + 1u, last); ++i) {
        float share = max(1.0 - abs(level - float(i)), 0.0);
        for (bool read = share > 0.0; read; read = false) { sum += share * surface_level(offset, size, place); }
        offset += size.x * size.y;
        size = max(size / 2u, uvec2(1u));
    }
    return sum;
}

#endif
