#version 460
#extension GL_GOOGLE_include_directive : require
// The background: the environment's radiance in the direction of the pixel.
//
// HOST_GLOW 1: seen through a medium: what it leaves of the environment, and a map of the glow that it makes of it.

#include "host/frame.glsl"

layout(set = 0, binding = 1) uniform texture2D environment;
layout(set = 0, binding = 2) uniform sampler environment_sampler;
#if HOST_GLOW
layout(set = 0, binding = 3) uniform texture2D glow;

layout(push_constant) uniform Medium {
    vec4 left; // of light from the environment; w unused
} medium;
#endif

layout(location = 0) in vec3 direction;

layout(location = 0) out vec4 radiance;

const float PI = 3.14159265358979;

void main()
{
    vec3 d = mat3(frame.map_from_world) * direction;
    float u = atan(d.x, -d.z) / (2.0 * PI) + 0.5;
    float v = atan(length(d.xz), d.y) / PI;
    vec3 seen = textureLod(sampler2D(environment, environment_sampler), vec2(u, v), 0.0).rgb;
#if HOST_GLOW
    seen = medium.left.rgb * seen + textureLod(sampler2D(glow, environment_sampler), vec2(u, v), 0.0).rgb;
#endif
    radiance = vec4(seen, 1.0);
}
