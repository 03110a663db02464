#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// What sampling and shading a filtered map costs: one bilinear or trilinear lookup and one light an invocation.
//
// METHOD_LOBES LAYERS of them, with KEPT_OCTAHEDRAL in four bytes, METHOD_PARTS LAYERS of them at four places, METHOD_SH ORDER bands, METHOD_LEAN two layers;
// of a mean normal: METHOD_TOKSVIG, METHOD_ROUGHNESS, METHOD_MIP, METHOD_LENGTH, METHOD_GEOMETRIC; METHOD_LOOKUP LAYERS
// lookups and nothing else
// MODEL_LAMBERT, MODEL_BLINN, MODEL_GGX

#include "normals/harmonics.glsl"
#include "normals/microfacet.glsl"
#include "normals/rivals.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2DArray kept;
layout(set = 0, binding = 1) uniform sampler kept_sampler;

layout(std430, set = 0, binding = 2) buffer Radiance {
    float values[];
} radiance;

layout(push_constant) uniform Settings {
    uvec2 size;
    float level;     // mip of the texture; a fraction blends two
    float parameter; // exponent or alpha
    vec4 bands[2];   // of METHOD_SH: of the BRDF
} settings;

vec4 kept_at(vec2 place, int layer, float level)
{
    return textureLod(sampler2DArray(kept, kept_sampler), vec3(place, float(layer)), level);
}

#if defined(METHOD_LOBES) || defined(METHOD_PARTS)
float lobes_at(vec2 place, float level, vec3 light, vec3 half_vector)
{
#ifdef MODEL_GGX
    NormalsGgx ggx = normals_ggx_of(settings.parameter);
#endif
    float sum = 0.0;
    vec4 stored[LAYERS];
    NormalsLobe lobes[LAYERS];
    [[unroll]] for (int i = 0; i < LAYERS; ++i) { stored[i] = kept_at(place, i, level); }
    [[unroll]] for (int i = 0; i < LAYERS; ++i) {
#ifdef KEPT_OCTAHEDRAL
        stored[i] = normals_octahedral(stored[i]);
#endif
        lobes[i] = normals_lobe(stored[i]);
    }
#if defined(MODEL_LAMBERT)
    [[unroll]] for (int i = 0; i < LAYERS; ++i) { sum += stored[i].w * normals_lambert(lobes[i], light); }
#else
    NormalsReflecting reflecting[LAYERS];
    [[unroll]] for (int i = 0; i < LAYERS; ++i) {
#if defined(MODEL_BLINN)
        reflecting[i] = normals_reflecting_blinn_phong(lobes[i], settings.parameter, half_vector);
#else
        reflecting[i] = normals_reflecting_ggx(lobes[i], ggx, half_vector);
        reflecting[i].integral *= 0.25;
#endif
    }
    [[unroll]] for (int i = 0; i < LAYERS; ++i) { sum += stored[i].w * normals_lit(reflecting[i], light); }
#endif
    return sum;
}
#endif

#ifdef METHOD_SH
#include "common/sh_basis.glsl"

float harmonics_at(vec2 place, vec3 light, vec3 half_vector)
{
    vec4 values[(ORDER * ORDER + 3) / 4];
    for (int i = 0; i < values.length(); ++i) { values[i] = kept_at(place, i, settings.level); }
#define COEFFICIENT(i) values[(i) / 4][(i) % 4]
    float cosine = NORMALS_HARMONIC_LAMBERT(light, COEFFICIENT);
#ifdef MODEL_LAMBERT
    return cosine;
#else
    float basis[ORDER * ORDER];
    sh_evaluate(half_vector, basis);
    float sum = 0.0;
    for (int l = 0; l < ORDER; ++l) {
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) { sum += settings.bands[l / 4][l % 4] * COEFFICIENT(i) * basis[i]; }
    }
    return PI * cosine * max(sum, 0.0);
#endif
}
#endif

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= settings.size.x || pixel.y >= settings.size.y) { return; }
    vec2 place = (vec2(pixel) + 0.3) / vec2(settings.size);
    vec3 light = normalize(vec3(place - 0.5, 1.0));
    vec3 half_vector = normalize(light + normalize(vec3(0.5 - place.y, place.x - 0.3, 1.0)));
    float sum = 0.0;
#if defined(MODEL_LAMBERT)
    NormalsMaterial material = NormalsMaterial(NORMALS_LAMBERT, 0.0);
#elif defined(MODEL_BLINN)
    NormalsMaterial material = NormalsMaterial(NORMALS_BLINN_PHONG, settings.parameter);
#else
    NormalsMaterial material = NormalsMaterial(NORMALS_GGX, settings.parameter);
#endif
#if defined(METHOD_LOBES)
    sum = lobes_at(place, settings.level, light, half_vector);
#elif defined(METHOD_PARTS)
    vec2 apart = 0.25 / vec2(textureSize(sampler2DArray(kept, kept_sampler), 0).xy);
    for (int i = 0; i < 4; ++i) {
        vec2 at = place + apart * vec2(ivec2(2 * (i & 1) - 1, (i & 2) - 1));
        sum += 0.25 * lobes_at(at, settings.level, light, half_vector);
    }
#elif defined(METHOD_SH)
    sum = harmonics_at(place, light, half_vector);
#elif defined(METHOD_LOOKUP)
    for (int i = 0; i < LAYERS; ++i) { sum += dot(kept_at(place, i, settings.level), vec4(1.0)); }
#elif defined(METHOD_LEAN)
    vec4 first = kept_at(place, 0, settings.level);
    vec4 second = kept_at(place, 1, settings.level);
    sum = normals_lean(first.xy, vec3(first.zw, second.x), material, light, half_vector);
#else
    vec4 mean = kept_at(place, 0, settings.level);
#if defined(METHOD_TOKSVIG)
    sum = normals_toksvig(mean.xyz, material, light, half_vector);
#elif defined(METHOD_ROUGHNESS)
    sum = normals_roughened(mean.xyz, material, light, half_vector);
#elif defined(METHOD_GEOMETRIC)
    sum = normals_geometric(mean.xyz, mean.w, material, light, half_vector);
#elif defined(METHOD_MIP)
    sum = normals_single(normals_direction(mean.xyz), material, light, half_vector);
#else
    sum = normals_single(mean.xyz, material, light, half_vector);
#endif
#endif
    // llvmpipe stores lane by lane, and would work out what only the store needs lane by lane as well: not a value that is clamped.
    radiance.values[pixel.y * settings.size.x + pixel.x] = max(sum, 0.0);
}
