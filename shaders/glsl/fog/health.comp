#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Counts the pixels of a host's images that the pass can make nothing of: a value of each, an invocation a pixel.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2D surface;
layout(set = 0, binding = 1) uniform texture2D depth;

layout(std430, set = 0, binding = 2) buffer Health {
    uint not_finite;
    uint negative;
    uint depth;
} health;

layout(push_constant) uniform Size {
    uint width;
    uint height;
} size;

// Bits, because comparisons with NaN may be optimised away.
const uint EXPONENT = 0x7f800000u;
const uint ONE = 0x3f800000u;
const uint MINUS_ZERO = 0x80000000u;

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= size.width || pixel.y >= size.height) { return; }
    vec3 radiance = texelFetch(surface, ivec2(pixel), 0).rgb;
    if (any(equal(floatBitsToUint(radiance) & EXPONENT, uvec3(EXPONENT)))) {
        atomicAdd(health.not_finite, 1u);
    } else if (any(lessThan(radiance, vec3(0.0)))) {
        atomicAdd(health.negative, 1u);
    }
    uint bits = floatBitsToUint(texelFetch(depth, ivec2(pixel), 0).r);
    if (bits > ONE && bits != MINUS_ZERO) { atomicAdd(health.depth, 1u); }
}
