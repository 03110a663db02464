// The demo host's forward draw: scene-linear radiance of a surface.
//
// HOST_LIGHTS 1: point, spot and directional lights shine on it too, without shadows.
// AIRGLOW_FOG 1: and what a medium scatters of their light, by the functions of the fog room; needs HOST_LIGHTS.
// AIRGLOW_NORMALS 1: the surface has a normal map, filtered and shaded by those of the normals room; needs HOST_LIGHTS.

#include "host/frame.glsl"
#include "host/material.glsl"
#if HOST_LIGHTS
#if AIRGLOW_FOG
layout(std430, set = 0, binding = 4) readonly buffer Lobes {
    float entries[];
} lobes;

#define FOG_LOBE_SIZE 64
#define FOG_LOBE_ENTRY(i) lobes.entries[i]
#include "fog/surface.glsl"
#endif
#include "host/lights.glsl"
#endif
#if AIRGLOW_NORMALS
#include "host/mapped.glsl"
#endif

layout(set = 0, binding = 1) uniform texture2D base_colour;
layout(set = 0, binding = 2) uniform sampler base_colour_sampler;

layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 light;
#if HOST_LIGHTS
layout(location = 2) in vec3 normal;
layout(location = 3) in vec3 position;
#endif
#if AIRGLOW_NORMALS
layout(location = 4) in vec4 tangent;
#endif

layout(location = 0) out vec4 radiance;

void main()
{
    vec4 albedo = material.base_colour * texture(sampler2D(base_colour, base_colour_sampler), uv);
    if (albedo.a < material.emissive_cutoff.w) { discard; }
    bool unlit = (material.flags & 1u) != 0u;
    // Interpolated SH light may dip below zero where the vectors ring.
    vec3 reflected = unlit ? albedo.rgb : albedo.rgb * max(light, vec3(0.0));
#if AIRGLOW_NORMALS
    if (!unlit) {
        vec2 surface = unpackHalf2x16(material.surface);
        reflected += lights_reflected_mapped(albedo.rgb, surface, uv, normal, tangent, position, frame.eye.xyz);
    }
#elif HOST_LIGHTS
    if (!unlit) {
        reflected += lights_reflected(albedo.rgb, unpackHalf2x16(material.surface), normal, position, frame.eye.xyz);
    }
#endif
    radiance = vec4(reflected + material.emissive_cutoff.rgb, 1.0);
}
