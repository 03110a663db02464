#version 460
#extension GL_GOOGLE_include_directive : require
// The rival of radiance/vertices.comp: each vertex takes its light from all samples, weighed with a power of their
// distance (Sloan, Kautz, Snyder 2002, as Sun 2005 ran it, eq. 2.13). As there, a few coefficients at a time.
//
// ORDER  3 to 6

#include "radiance/sample.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Points { vec4 values[]; } points;
layout(std430, set = 0, binding = 1) readonly buffer Lights { vec4 values[]; } lights;
layout(std430, set = 0, binding = 2) readonly buffer Vertices { vec4 values[]; } vertices;
layout(std430, set = 0, binding = 3) buffer VertexLight { float values[]; } vertex_light;

layout(push_constant) uniform Settings {
    uint vertices;
    uint samples;
    uint power; // 1, 2 or 4
} settings;

float global_weight(vec3 point, vec3 sample_point)
{
    vec3 away = point - sample_point;
    float weight = inversesqrt(max(dot(away, away), 1e-18));
    if (settings.power > 1u) { weight *= weight; }
    if (settings.power > 2u) { weight *= weight; }
    return weight;
}

void main()
{
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= settings.vertices) { return; }
    vec3 point = vertices.values[vertex].xyz;
    uint last = uint(COEFFICIENTS) - 1u;
    for (uint first = 0u; first < uint(COEFFICIENTS); first += 4u) {
        vec3 sums[4] = vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
        float total = 0.0;
        for (uint k = 0u; k < settings.samples; ++k) {
            float weight = global_weight(point, points.values[k].xyz);
            uint light = k * uint(LIGHT_STRIDE);
            total += weight;
            for (uint j = 0u; j < 4u; ++j) {
                sums[j] += weight * lights.values[light + min(first + j, last)].rgb;
            }
        }
        for (uint j = 0u; j < 4u && first + j < uint(COEFFICIENTS); ++j) {
            uint at = 3u * (uint(COEFFICIENTS) * vertex + first + j);
            vec3 sum = total > 0.0 ? sums[j] / total : vec3(0.0);
            vertex_light.values[at] = sum.r;
            vertex_light.values[at + 1u] = sum.g;
            vertex_light.values[at + 2u] = sum.b;
        }
    }
}
