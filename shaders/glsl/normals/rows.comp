#version 460
#extension GL_GOOGLE_include_directive : require
// The radiance of mixtures on rows of parameters, by the functions that hosts include: for tests and evaluation.

#include "normals/microfacet.glsl"

layout(local_size_x = 64) in;

struct Row {
    vec4 light;       // w: 0 Lambert, 1 Blinn-Phong, 2 GGX
    vec4 half_vector; // w: exponent or alpha; all zero: no half vector
    vec4 lobes[6];    // empty ones have weight 0
};

layout(std430, set = 0, binding = 0) readonly buffer Rows {
    Row values[];
} rows;

layout(std430, set = 0, binding = 1) buffer Radiance {
    float values[];
} radiance;

layout(push_constant) uniform Settings {
    uint count;
} settings;

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.count) { return; }
    vec4 light = rows.values[at].light;
    vec4 half_vector = rows.values[at].half_vector;
    bool reflects = dot(half_vector.xyz, half_vector.xyz) > 0.0;
    float sum = 0.0;
    for (int j = 0; j < 6; ++j) {
        vec4 lobe = rows.values[at].lobes[j];
        if (lobe.w <= 0.0) { continue; }
        if (light.w == 0.0) {
            sum += normals_lambert(lobe, light.xyz);
        } else if (!reflects) {
            continue;
        } else if (light.w == 1.0) {
            sum += normals_blinn_phong(lobe, half_vector.w, light.xyz, half_vector.xyz);
        } else {
            sum += normals_ggx(lobe, normals_ggx_of(half_vector.w), light.xyz, half_vector.xyz);
        }
    }
    radiance.values[at] = sum;
}
