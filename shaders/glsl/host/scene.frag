#version 460
#extension GL_GOOGLE_include_directive : require
// The demo host's forward draw: scene-linear radiance of a surface.
//
// HOST_LIGHTS 1: point, spot and directional lights shine on it too, without shadows.

#include "host/frame.glsl"
#include "host/material.glsl"
#if HOST_LIGHTS
#include "host/lights.glsl"
#endif

layout(set = 0, binding = 1) uniform texture2D base_colour;
layout(set = 0, binding = 2) uniform sampler base_colour_sampler;

layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 light;
#if HOST_LIGHTS
layout(location = 2) in vec3 normal;
layout(location = 3) in vec3 position;
#endif

layout(location = 0) out vec4 radiance;

void main()
{
    vec4 albedo = material.base_colour * texture(sampler2D(base_colour, base_colour_sampler), uv);
    if (albedo.a < material.emissive_cutoff.w) { discard; }
    // Interpolated SH light may dip below zero where the vectors ring.
    vec3 reflected = material.unlit != 0u ? albedo.rgb : albedo.rgb * max(light, vec3(0.0));
#if HOST_LIGHTS
    if (material.unlit == 0u) {
        reflected += lights_reflected(albedo.rgb, unpackHalf2x16(material.surface), normal, position, frame.eye.xyz);
    }
#endif
    radiance = vec4(reflected + material.emissive_cutoff.rgb, 1.0);
}
