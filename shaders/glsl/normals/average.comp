#version 460
#extension GL_GOOGLE_include_directive : require
// What is linear in the normals of a texel, averaged from the level below. One invocation a texel.
//
// KEPT_MEAN  the normal
// KEPT_LEAN  slope and products of slopes
// KEPT_SH    spherical harmonics of ORDER bands, 3 to 5

#ifdef KEPT_SH
#define VECTORS ((ORDER * ORDER + 3) / 4)
#include "common/sh_basis.glsl"
#elif defined(KEPT_LEAN)
#define VECTORS 2
#else
#define VECTORS 1
#endif

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Fine {
    vec4 values[]; // normals, or VECTORS a texel, row by row
} fine;

layout(std430, set = 0, binding = 1) buffer Kept {
    vec4 values[]; // VECTORS a texel, row by row
} kept;

layout(push_constant) uniform Settings {
    uvec2 fine_size;
    uvec2 size;
    uint first;  // texel of the first invocation
    uint single; // 1: the level below is the map of normals
} settings;

vec4 sum[VECTORS];

void add_normal(vec3 normal, float share)
{
#if defined(KEPT_SH)
    float basis[ORDER * ORDER];
    sh_evaluate(normal, basis);
    for (int i = 0; i < ORDER * ORDER; ++i) { sum[i / 4][i % 4] += share * basis[i]; }
#elif defined(KEPT_LEAN)
    vec2 slope = normal.xy / max(normal.z, 1e-6);
    float steepness = length(slope);
    slope *= steepness > 10.0 ? 10.0 / steepness : 1.0;
    sum[0] += share * vec4(slope, slope.x * slope.x, slope.x * slope.y);
    sum[1] += share * vec4(slope.y * slope.y, 0.0, 0.0, 0.0);
#else
    sum[0] += share * vec4(normal, 0.0);
#endif
}

void main()
{
    uint at = settings.first + gl_GlobalInvocationID.x;
    if (at >= settings.size.x * settings.size.y) { return; }
    uvec2 texel = uvec2(at % settings.size.x, at / settings.size.x);
    uvec2 first = texel * settings.fine_size / settings.size;
    uvec2 last = ((texel + 1u) * settings.fine_size + settings.size - 1u) / settings.size - 1u;
    for (int i = 0; i < VECTORS; ++i) { sum[i] = vec4(0.0); }
    for (uint y = first.y; y <= last.y; ++y) {
        for (uint x = first.x; x <= last.x; ++x) {
            uvec2 place = uvec2(x, y);
            uvec2 begin = max(texel * settings.fine_size, place * settings.size);
            uvec2 end = min((texel + 1u) * settings.fine_size, (place + 1u) * settings.size);
            vec2 shares = vec2(end - begin) / vec2(settings.fine_size);
            float share = shares.x * shares.y;
            uint source = y * settings.fine_size.x + x;
            if (settings.single == 1u) {
                add_normal(fine.values[source].xyz, share);
            } else {
                for (int i = 0; i < VECTORS; ++i) {
                    sum[i] += share * fine.values[source * uint(VECTORS) + uint(i)];
                }
            }
        }
    }
    for (int i = 0; i < VECTORS; ++i) { kept.values[at * uint(VECTORS) + uint(i)] = sum[i]; }
}
