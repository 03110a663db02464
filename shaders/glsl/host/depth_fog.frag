#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Exponential depth fog, the rival that the fog room takes the place of: a share of each surface by its distance, and one
// colour for the rest.

#include "common/depth.glsl"

layout(set = 0, binding = 0) uniform texture2D surface;
layout(set = 0, binding = 1) uniform texture2D depth;

layout(push_constant) uniform Fog {
    vec4 depth;      // coefficients of common/depth.glsl
    vec4 extinction; // 1/m; w: the depth where there is no surface
    vec4 colour;     // W/sr/m2; w unused
} fog;

layout(location = 0) out vec4 colour;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 behind = texelFetch(surface, pixel, 0);
    float value = texelFetch(depth, pixel, 0).r;
    vec3 left = value == fog.extinction.w ? vec3(0.0) : exp(-fog.extinction.rgb * depth_view_distance(value, fog.depth));
    colour = vec4(mix(fog.colour.rgb, behind.rgb, left), behind.a);
}
