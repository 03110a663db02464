#version 460
#extension GL_GOOGLE_include_directive : require
// Lobes of a level in few bits, as textures take them: layer by layer, row by row. One invocation a lobe.
//
// What rounding spoils is the length of the mean, on whose distance from 1 the concentration depends. So the weight is
// rounded first, and of the 27 vectors around the rounded moment the one is taken that keeps that distance.
//
// STORAGE_F16     four halves a lobe
// STORAGE_SNORM8  four signed bytes a lobe
// STORAGE_OCTAHEDRAL8  axis, width and weight in four unsigned bytes, each to the nearest

#ifdef STORAGE_F16
#include "common/half.glsl"
#endif

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Lobes {
    vec4 values[]; // `lobes` a texel, row by row
} lobes;

layout(std430, set = 0, binding = 1) buffer Packed {
    uint values[]; // two words a lobe, or one
} packed_lobes;

layout(push_constant) uniform Settings {
    uint texels; // of the level
    uint lobes;
} settings;

#ifdef STORAGE_OCTAHEDRAL8
uint octahedral(vec4 lobe)
{
    vec3 mean = lobe.w > 0.0 ? lobe.xyz / lobe.w : vec3(0.0);
    float size = length(mean);
    vec3 axis = size > 0.0 ? mean / size : vec3(0.0, 0.0, 1.0);
    vec2 unfolded = axis.xy / (abs(axis.x) + abs(axis.y) + abs(axis.z));
    vec2 signs = vec2(unfolded.x < 0.0 ? -1.0 : 1.0, unfolded.y < 0.0 ? -1.0 : 1.0);
    vec2 folded = axis.z < 0.0 ? (1.0 - abs(unfolded.yx)) * signs : unfolded;
    vec4 codes = vec4(127.0 * folded + 127.0, 255.0 * sqrt(clamp(1.0 - size, 0.0, 1.0)), 255.0 * lobe.w);
    uvec4 bits = uvec4(clamp(codes + 0.5, 0.0, 255.0)); // truncates
    return bits.x | bits.y << 8 | bits.z << 16 | bits.w << 24;
}
#endif

#ifdef STORAGE_F16
uvec4 code(vec4 value)
{
    return uvec4(half_bits(value.x), half_bits(value.y), half_bits(value.z), half_bits(value.w));
}
float decoded(uint bits)
{
    return unpackHalf2x16(bits).x;
}
// The next number away from zero or towards it; zero stays.
uint stepped(uint bits, int by)
{
    return (bits & 0x7fffu) == 0u ? bits : uint(int(bits) + by);
}
#elif defined(STORAGE_SNORM8)
uvec4 code(vec4 value)
{
    return uvec4((ivec4(clamp(value, -1.0, 1.0) * 127.0 + 127.5) - 127) & 255); // truncates what is not negative
}
float decoded(uint bits)
{
    return max(float(int(bits << 24) >> 24) / 127.0, -1.0);
}
uint stepped(uint bits, int by)
{
    return uint(clamp((int(bits << 24) >> 24) + by, -127, 127) & 255);
}
#endif

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.texels * settings.lobes) { return; }
    uint texel = at % settings.texels;
    uint layer = at / settings.texels;
    vec4 lobe = lobes.values[texel * settings.lobes + layer];
#ifdef STORAGE_OCTAHEDRAL8
    packed_lobes.values[at] = octahedral(lobe);
#else
    uvec4 best = uvec4(0u);
    uint weight = code(lobe).w;
    float rounded = decoded(weight);
    if (lobe.w > 0.0 && rounded > 0.0) {
        float scale = rounded / lobe.w;
        uvec4 start = code(lobe * scale);
        float missing = max(lobe.w - length(lobe.xyz), 0.0) * scale;
        float least = 1e30;
        for (uint i = 0u; i < 27u; ++i) {
            // No step first, so that it is kept where nothing is nearer.
            ivec3 by = ivec3((uvec3(i, i / 3u, i / 9u) + 1u) % 3u) - 1;
            uvec3 bits = uvec3(stepped(start.x, by.x), stepped(start.y, by.y), stepped(start.z, by.z));
            vec3 moment = vec3(decoded(bits.x), decoded(bits.y), decoded(bits.z));
            float error = abs(rounded - length(moment) - missing);
            if (error < least) { least = error; best = uvec4(bits, weight); }
        }
    }
#ifdef STORAGE_F16
    packed_lobes.values[2u * at] = best.x | best.y << 16;
    packed_lobes.values[2u * at + 1u] = best.z | best.w << 16;
#else
    packed_lobes.values[at] = best.x | best.y << 8 | best.z << 16 | best.w << 24;
#endif
#endif
}
