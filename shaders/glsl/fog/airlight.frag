#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// The picture as it is seen through the medium: what is left of each surface's light, and the airlight before it.
//
// FOG_DARK 1: for tiles without a light

#include "fog/airlight.glsl"
#include "fog/frame.glsl"
#include "fog/view.glsl"
#include "common/depth.glsl"

layout(set = 0, binding = 1) uniform texture2D surface;
layout(set = 0, binding = 2) uniform texture2D depth;

#if !FOG_DARK
layout(location = 0) flat in uvec2 lights; // a bit for each that may be seen in the tile
#endif

layout(location = 0) out vec4 colour;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = gl_FragCoord.xy / vec2(fog.size);
    vec3 start = fog.start[0].xyz + place.x * fog.start[1].xyz + place.y * fog.start[2].xyz;
    vec3 ray = fog.direction[0].xyz + place.x * fog.direction[1].xyz + place.y * fog.direction[2].xyz;
    float stretch = length(ray);
    vec3 direction = ray / stretch;
    float value = texelFetch(depth, pixel, 0).r;
    bool endless = value == fog.farthest;
    float distance = endless ? 1e32 : stretch * depth_view_distance(value, fog.depth);
    FogMedium medium = fog_medium();
    vec3 airlight = fog_of_environment(medium, direction, distance, endless);
#if !FOG_DARK
    // There is one: tested at the end, no turn is made in vain where a device masks what it does not need.
    uvec2 remaining = lights;
    do {
        bool lower = remaining.x != 0u;
        uint word = lower ? remaining.x : remaining.y;
        uint rest = word & (word - 1u);
        remaining = lower ? uvec2(rest, remaining.y) : uvec2(0u, rest);
        airlight += fog_of_light(medium, start, direction, distance, findLSB(int(word)) + (lower ? 0 : 32));
    } while ((remaining.x | remaining.y) != 0u);
#endif
    vec4 behind = texelFetch(surface, pixel, 0);
    colour = vec4(behind.rgb * fog_left(medium, direction, distance, endless) + fog.scattering.w * airlight, behind.a);
}
