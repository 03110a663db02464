#version 460
#extension GL_GOOGLE_include_directive : require
// What sampling and shading a filtered map costs: one bilinear or trilinear lookup and one light an invocation.
//
// METHOD_LOBES LAYERS of them, METHOD_TOKSVIG one mean normal
// MODEL_BLINN, MODEL_GGX

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
} settings;

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= settings.size.x || pixel.y >= settings.size.y) { return; }
    vec2 place = (vec2(pixel) + 0.3) / vec2(settings.size);
    vec3 light = normalize(vec3(place - 0.5, 1.0));
    vec3 half_vector = normalize(light + normalize(vec3(0.5 - place.y, place.x - 0.3, 1.0)));
    float sum = 0.0;
#ifdef METHOD_LOBES
    for (int i = 0; i < LAYERS; ++i) {
        vec4 lobe = textureLod(sampler2DArray(kept, kept_sampler), vec3(place, float(i)), settings.level);
#ifdef MODEL_BLINN
        sum += normals_blinn_phong(lobe, settings.parameter, light, half_vector);
#else
        sum += normals_ggx(lobe, settings.parameter, light, half_vector);
#endif
    }
#else
    vec3 mean = textureLod(sampler2DArray(kept, kept_sampler), vec3(place, 0.0), settings.level).xyz;
#ifdef MODEL_BLINN
    NormalsMaterial material = NormalsMaterial(NORMALS_BLINN_PHONG, settings.parameter);
#else
    NormalsMaterial material = NormalsMaterial(NORMALS_GGX, settings.parameter);
#endif
    sum = normals_toksvig(mean, material, light, half_vector);
#endif
    radiance.values[pixel.y * settings.size.x + pixel.x] = sum;
}
