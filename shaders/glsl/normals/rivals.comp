#version 460
#extension GL_GOOGLE_include_directive : require
// The radiance of what others keep on rows of parameters: for tests, evaluation and the report.
//
// RIVAL_MIP, RIVAL_LENGTH, RIVAL_TOKSVIG, RIVAL_ROUGHNESS, RIVAL_GEOMETRIC, RIVAL_LEAN, or RIVAL_SH of ORDER bands

#include "normals/rivals.glsl"

#ifdef RIVAL_SH
#include "normals/harmonics.glsl"
#include "common/sh_basis.glsl"
#endif

layout(local_size_x = 64) in;

struct Row {
    vec4 light;       // w: kind of the material
    vec4 half_vector; // w: its parameter; all zero: no half vector
    vec4 factors[4];  // bands of the cosine in the first two, of the BRDF in the others
    vec4 kept[7];     // as average.comp leaves it
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

#ifdef RIVAL_SH
// The kept coefficients convolved with a lobe of so many bands about a direction.
float convolved(uint at, int lobe, vec3 direction)
{
    float basis[ORDER * ORDER];
    sh_evaluate(direction, basis);
    float sum = 0.0;
    for (int l = 0; l < ORDER; ++l) {
        float band = 0.0;
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) { band += rows.values[at].kept[i / 4][i % 4] * basis[i]; }
        sum += rows.values[at].factors[lobe + l / 4][l % 4] * band;
    }
    return sum;
}
#endif

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.count) { return; }
    vec3 light = rows.values[at].light.xyz;
    vec3 half_vector = rows.values[at].half_vector.xyz;
    NormalsMaterial material = NormalsMaterial(rows.values[at].light.w, rows.values[at].half_vector.w);
    float found = 0.0;
    if (material.kind == NORMALS_LAMBERT || dot(half_vector, half_vector) > 0.0) {
        vec4 kept = rows.values[at].kept[0];
#if defined(RIVAL_SH)
#if ORDER < 5
#define COEFFICIENT(i) rows.values[at].kept[(i) / 4][(i) % 4]
        found = PI * NORMALS_HARMONIC_LAMBERT(light, COEFFICIENT);
#else
        found = max(convolved(at, 0, light), 0.0);
#endif
        found *= material.kind == NORMALS_LAMBERT ? 1.0 / PI : max(convolved(at, 2, half_vector), 0.0);
#elif defined(RIVAL_MIP)
        found = normals_single(normals_direction(kept.xyz), material, light, half_vector);
#elif defined(RIVAL_LENGTH)
        found = normals_single(kept.xyz, material, light, half_vector);
#elif defined(RIVAL_TOKSVIG)
        found = normals_toksvig(kept.xyz, material, light, half_vector);
#elif defined(RIVAL_ROUGHNESS)
        found = normals_roughened(kept.xyz, material, light, half_vector);
#elif defined(RIVAL_GEOMETRIC)
        found = normals_geometric(kept.xyz, kept.w, material, light, half_vector);
#else
        vec3 moments = vec3(kept.zw, rows.values[at].kept[1].x);
        found = normals_lean(kept.xy, moments, material, light, half_vector);
#endif
    }
    radiance.values[at] = found;
}
