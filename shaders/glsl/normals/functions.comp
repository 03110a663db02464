#version 460
#extension GL_GOOGLE_include_directive : require
// The functions that hosts include, beyond those of rows.comp, one call a row: for tests.

#include "normals/environment.glsl"
#include "normals/harmonics.glsl"
#include "normals/microfacet.glsl"

layout(local_size_x = 64) in;

struct Row {
    vec4 light;       // w: 0 Beckmann, 1 Torrance-Sparrow, 2 zonal, 3 lobe under harmonics, 4 harmonics under a light,
                      // 5 glossy lobe under harmonics, 6 lobe of facets under harmonics, 7 its moments about other axes
    vec4 half_vector; // w: alpha, or the sharpness of the reflection
    vec4 view;
    vec4 lobe;
    vec4 values[16];  // zonal coefficients, or nine of the light (x) or of the normals (x)
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

uint row; // of this invocation
#define NORMALS_ZONAL_BANDS 64
#define NORMALS_ZONAL(l) rows.values[row].values[(l) / 4][(l) % 4]
#include "normals/zonal.glsl"

#define COEFFICIENT(i) rows.values[row].values[i].x

void main()
{
    row = gl_GlobalInvocationID.x;
    if (row >= settings.count) { return; }
    vec3 light = rows.values[row].light.xyz;
    vec3 h = rows.values[row].half_vector.xyz;
    float alpha = rows.values[row].half_vector.w;
    vec4 lobe = rows.values[row].lobe;
    float kind = rows.values[row].light.w;
    float value = 0.0;
    if (kind == 0.0) {
        value = normals_beckmann(lobe, alpha, light, h);
    } else if (kind == 1.0) {
        value = normals_torrance_sparrow(lobe, normals_ggx_of(alpha), alpha, light, rows.values[row].view.xyz, h);
    } else if (kind == 2.0) {
        value = normals_zonal(lobe, light, h);
    } else if (kind == 3.0) {
        NormalsLobe seen = normals_lobe(lobe);
        value = lobe.w * NORMALS_HARMONIC_SUM(seen.axis, normals_lambert_bands(seen), COEFFICIENT);
    } else if (kind == 4.0) {
        value = NORMALS_HARMONIC_LAMBERT(light, COEFFICIENT);
    } else if (kind == 6.0) {
        NormalsMoments moments = NormalsMoments(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
        float grazing = 0.0;
        normals_add_mirrored(moments, grazing, lobe.w, normals_lobe(lobe), alpha, rows.values[row].view.xyz);
        value = NORMALS_MOMENTS_SUM(moments, vec3(1.0), COEFFICIENT);
    } else if (kind == 7.0) {
        // From axes about the half vector, by way of moments.
        NormalsLobe seen = normals_lobe(lobe);
        mat3 axes = mat3(normalize(cross(h, light)), normalize(cross(h, cross(h, light))), h);
        NormalsMoments moments = NormalsMoments(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
        normals_add_moments(moments, lobe.w * normals_lobe_bands(seen), seen.axis * axes);
        moments = normals_turned_moments(moments, axes);
        value = NORMALS_MOMENTS_SUM(moments, NORMALS_COSINE_BANDS, COEFFICIENT);
    } else {
        NormalsGloss gloss = normals_gloss(normals_lobe(lobe), alpha, rows.values[row].view.xyz);
        vec3 bands = normals_gloss_bands(gloss);
        value = lobe.w * gloss.weight * NORMALS_HARMONIC_SUM(gloss.direction, bands, COEFFICIENT);
    }
    radiance.values[row] = value;
}
