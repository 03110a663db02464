#version 460
#extension GL_GOOGLE_include_directive : require
// The demo host's forward draw: scene-linear radiance of a diffuse surface.

#include "host/material.glsl"

layout(set = 0, binding = 1) uniform texture2D base_colour;
layout(set = 0, binding = 2) uniform sampler base_colour_sampler;

layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 light;

layout(location = 0) out vec4 radiance;

void main()
{
    vec4 albedo = material.base_colour * texture(sampler2D(base_colour, base_colour_sampler), uv);
    if (albedo.a < material.emissive_cutoff.w) { discard; }
    // Interpolated SH light may dip below zero where the vectors ring.
    vec3 reflected = material.unlit != 0u ? albedo.rgb : albedo.rgb * max(light, vec3(0.0));
    radiance = vec4(reflected + material.emissive_cutoff.rgb, 1.0);
}
