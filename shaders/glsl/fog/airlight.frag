#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// The picture as it is seen through the medium: what is left of each surface's light, and the airlight before it.

#include "fog/airlight.glsl"
#include "common/depth.glsl"
#include "fog/frame.glsl"

layout(set = 0, binding = 1) uniform texture2D surface;
layout(set = 0, binding = 2) uniform texture2D depth;

layout(location = 0) out vec4 colour;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = gl_FragCoord.xy / vec2(frame.size);
    vec3 start = frame.start[0].xyz + place.x * frame.start[1].xyz + place.y * frame.start[2].xyz;
    vec3 ray = frame.direction[0].xyz + place.x * frame.direction[1].xyz + place.y * frame.direction[2].xyz;
    float stretch = length(ray);
    vec3 direction = ray / stretch;
    float value = texelFetch(depth, pixel, 0).r;
    float distance = value == frame.farthest ? 1e32 : stretch * depth_view_distance(value, frame.depth);
    FogMedium medium = FogMedium(frame.extinction.rgb, frame.scattering.rgb, frame.phase, frame.extinction.w);
    vec3 airlight = vec3(0.0);
    for (int i = 0; i < frame.light_count; ++i) {
        FogLight light = frame.lights[i];
        if (frame.start[0].w > 0.5) {
            // Parallel rays: each has an eye of its own.
            light.position_radius.xyz -= start;
            light.low.xyz -= start;
            light.high.xyz -= start;
            light.intensity_reach.rgb = fog_seen(medium, light.intensity_reach.rgb, light.position_radius);
        }
        // Farther off the ray than this its airlight is below the bound.
        if (dot(light.position_radius.xyz, direction) < light.intensity_reach.w) { continue; }
        airlight += fog_airlight(medium, light, i, direction, distance);
    }
    vec4 behind = texelFetch(surface, pixel, 0);
    colour = vec4(behind.rgb * fog_transmittance(medium, direction, distance) + frame.scattering.w * airlight, behind.a);
}
