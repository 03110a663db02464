#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Develops the picture: averages the samples of each pixel, once scene-linear and once exposed, tone-mapped and
// encoded. Samples are averaged after the tone map, so that an edge against a bright sky stays smooth.

#include "common/tone_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2D radiance;

// Scene-linear RGB, three floats a pixel.
layout(std430, set = 0, binding = 1) buffer Linear {
    float values[];
} linear_picture;

// sRGB-encoded, one byte a channel, red lowest unless the settings say otherwise.
layout(std430, set = 0, binding = 2) buffer Display {
    uint values[];
} display_picture;

layout(push_constant) uniform Settings {
    uvec2 size;   // pixels of the view
    uint samples; // along each side of a pixel
    float exposure;
    uint column;     // of the picture, where the view begins
    uint row_length; // pixels of a row of the picture
    uint blue_first; // 1 where blue is to be the lowest byte, as most windows want it
} settings;

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= settings.size.x || pixel.y >= settings.size.y) { return; }
    vec3 sum = vec3(0.0);
    vec3 shown = vec3(0.0);
    for (uint y = 0u; y < settings.samples; ++y) {
        for (uint x = 0u; x < settings.samples; ++x) {
            vec3 value = texelFetch(radiance, ivec2(pixel * settings.samples + uvec2(x, y)), 0).rgb;
            sum += value;
            shown += tone_map(value * settings.exposure);
        }
    }
    float weight = 1.0 / float(settings.samples * settings.samples);
    uint at = pixel.y * settings.row_length + settings.column + pixel.x;
    linear_picture.values[3u * at] = sum.r * weight;
    linear_picture.values[3u * at + 1u] = sum.g * weight;
    linear_picture.values[3u * at + 2u] = sum.b * weight;
    vec3 encoded = srgb_encode(shown * weight);
    display_picture.values[at] = packUnorm4x8(vec4(settings.blue_first == 1u ? encoded.bgr : encoded, 1.0));
}
