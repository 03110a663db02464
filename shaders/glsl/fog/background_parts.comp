#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// One level of the pyramid of an environment from the level below it.

#include "fog/pyramid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2D environment;

layout(std430, set = 0, binding = 1) buffer Parts {
    vec4 values[];
} parts;

layout(push_constant) uniform Level {
    ivec2 size; // texels of the map
    int level;  // 1 and up
    int first;  // place of its parts
    int below;  // place of those of the level below
} settings;

FogPart part_below(ivec2 at)
{
    if (settings.level == 1) { return fog_texel(at, settings.size, texelFetch(environment, at, 0).rgb); }
    int place = 2 * (settings.below + at.y * fog_parts(settings.size.x, settings.level - 1) + at.x);
    return FogPart(parts.values[place], parts.values[place + 1]);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int width = fog_parts(settings.size.x, settings.level);
    int height = fog_parts(settings.size.y, settings.level);
    if (at.x >= width || at.y >= height) { return; }
    ivec2 most = ivec2(
        fog_parts(settings.size.x, settings.level - 1), fog_parts(settings.size.y, settings.level - 1)) - 1;
    vec4 flux = vec4(0.0);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 below = 2 * at + ivec2(i & 1, i >> 1);
        if (below.x > most.x || below.y > most.y) { continue; }
        FogPart part = part_below(below);
        flux += part.flux;
        sum += fog_part_weight(part) * part.center.xyz;
    }
    vec3 center = sum / max(length(sum), 1e-30);
    float reach = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 below = 2 * at + ivec2(i & 1, i >> 1);
        if (below.x > most.x || below.y > most.y) { continue; }
        FogPart part = part_below(below);
        reach = max(reach, length(part.center.xyz - center) + part.center.w);
    }
    int place = 2 * (settings.first + at.y * width + at.x);
    parts.values[place] = flux;
    parts.values[place + 1] = vec4(center, reach);
}
