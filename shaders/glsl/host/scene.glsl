// The demo host's forward draw: scene-linear radiance of a surface.
//
// HOST_LIGHTS 1: point, spot and directional lights shine on it too, without shadows.
// AIRGLOW_FOG 1: and what a medium scatters of their light, by the functions of the fog room; needs HOST_LIGHTS.
// FOG_COMPLETE 1: and what it makes of the surface's light on its way to the eye, by the complete model in one draw;
// 2: the same computed at each vertex, and the light of lamps with it. A texture then tints their highlights, too.
// AIRGLOW_NORMALS 1: the surface has a normal map, filtered and shaded by those of the normals room; needs HOST_LIGHTS.
// HOST_INCIDENT 1: and has the incident radiance of its vertices; needs AIRGLOW_NORMALS.

#include "host/frame.glsl"
#include "host/material.glsl"
#include "host/lit.glsl"
#if AIRGLOW_NORMALS
#include "host/mapped.glsl"
#endif

layout(set = 0, binding = 1) uniform texture2D base_colour;
layout(set = 0, binding = 2) uniform sampler base_colour_sampler;

layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 light;
#if HOST_LIGHTS && FOG_COMPLETE != 2
layout(location = 2) in vec3 normal;
layout(location = 3) in vec3 position;
#endif
#if AIRGLOW_NORMALS
layout(location = 4) in vec4 tangent;
#endif

#if FOG_COMPLETE == 2
layout(location = 5) in vec3 lit;
layout(location = 6) in vec3 left;
layout(location = 7) in vec3 before;
#endif

layout(location = 0) out vec4 radiance;

void main()
{
    vec4 texel = texture(sampler2D(base_colour, base_colour_sampler), uv);
    vec4 albedo = material.base_colour * texel;
    if (albedo.a < material.emissive_cutoff.w) { discard; }
    bool unlit = (material.flags & 1u) != 0u;
    // Interpolated SH light may dip below zero where the vectors ring.
    vec3 arriving = max(light, vec3(0.0));
#if AIRGLOW_NORMALS
    vec3 reflected = albedo.rgb;
    if (!unlit) {
        vec2 surface = unpackHalf2x16(material.surface);
        reflected = mapped_reflected(albedo.rgb, surface, uv, normal, tangent, position, frame.eye.xyz, arriving);
    }
#else
    vec3 reflected = unlit ? albedo.rgb : albedo.rgb * arriving;
#endif
#if FOG_COMPLETE == 2
    reflected += texel.rgb * lit;
#elif HOST_LIGHTS && !AIRGLOW_NORMALS
    if (!unlit) {
        reflected += lights_reflected(albedo.rgb, unpackHalf2x16(material.surface), normal, position, frame.eye.xyz);
    }
#endif
    vec3 seen = reflected + material.emissive_cutoff.rgb;
#if FOG_COMPLETE
#if FOG_COMPLETE == 1
    vec3 left;
    vec3 before;
    complete(position - frame.eye.xyz, left, before);
#endif
    seen = left * seen + before;
#endif
    radiance = vec4(seen, 1.0);
}
