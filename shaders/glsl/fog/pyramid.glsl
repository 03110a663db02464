// A pyramid of parts of an equirectangular map: how much light each sends, and where from.
//
// Level 0 is the map itself and lies in no buffer. A part of level k covers 2 by 2 parts of level k - 1, fewer at the
// lower and right borders.

#ifndef FOG_PYRAMID_GLSL
#define FOG_PYRAMID_GLSL

#include "common/equirect.glsl"

// Two vec4 of a buffer.
struct FogPart {
    vec4 flux;   // radiance times solid angle, W/m2; w: solid angle
    vec4 center; // unit direction of its mean, weighted by the light; w: no point of it is farther, as a chord
};

// Parts of a level along one side.
int fog_parts(int side, int level)
{
    return (side + (1 << level) - 1) >> level;
}

// A texel of the map as a part. What is not finite sends nothing.
FogPart fog_texel(ivec2 texel, ivec2 size, vec3 radiance)
{
    vec2 step = vec2(TWO_PI, PI) / vec2(size);
    float middle = step.y * (float(texel.y) + 0.5);
    float solid_angle = 2.0 * step.x * sin(middle) * sin(0.5 * step.y);
    bool finite = all(lessThan(abs(radiance), vec3(1e30)));
    vec3 direction = equirect_direction((vec2(texel) + 0.5) / vec2(size));
    return FogPart(vec4(finite ? solid_angle * radiance : vec3(0.0), solid_angle),
        vec4(direction, 0.5 * length(vec2(sin(middle) * step.x, step.y))));
}

// How much a part counts in the mean direction of the one it belongs to; a dark one counts a little.
float fog_part_weight(FogPart part)
{
    return dot(part.flux.rgb, vec3(1.0)) + 1e-6 * part.flux.w;
}

#endif
