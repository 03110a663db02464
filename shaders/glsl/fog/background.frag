#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// A distant environment through fog, as an equirectangular map: what is left of it, and its convolution with the point
// spread function (Sun 2008, eq. 3.30 and 3.35 to 3.37). Parts of the map are summed by the finest level at which they
// look small from the direction asked for (Barnes and Hut 1986), so that the glow's peak has the map's own resolution.

#include "fog/pyramid.glsl"
#include "fog/spread.glsl"

layout(set = 0, binding = 0) uniform texture2D environment;

layout(std430, set = 0, binding = 1) readonly buffer Parts {
    vec4 values[];
} parts;

layout(push_constant) uniform Settings {
    vec4 optical; // distance of the environment; w: how many of its radii a part must be away
    vec4 albedo;  // w: 1 where the optical distances are one
    ivec2 size;   // texels of the map
    ivec2 target; // pixels of the result
    int levels;   // the last level; 0: there is only the map
    float straight; // 1: with what arrives straight, 0: the glow alone
} settings;

layout(location = 0) out vec4 radiance;

vec3 spread(float chord)
{
    float versine = 0.5 * chord * chord;
    float sine = chord * sqrt(max(1.0 - 0.25 * chord * chord, 0.0));
    float red = fog_spread(settings.optical.r, sine, versine);
    if (settings.albedo.w > 0.5) { return vec3(red); }
    return vec3(red, fog_spread(settings.optical.g, sine, versine), fog_spread(settings.optical.b, sine, versine));
}

// A texel so many of its radii away is one of the eight about that of the direction, or this itself.
const float NEIGHBOURS = 2.2;

// The glow that a part adds. The mean of 1 / chord over a disc about the direction is that at half the disc's radius.
vec3 light_of(FogPart part, float chord)
{
    return part.flux.rgb * spread(max(chord, 0.5 * sqrt(part.flux.w / PI)));
}

void main()
{
    vec2 place = gl_FragCoord.xy / vec2(settings.target);
    vec3 direction = equirect_direction(place);
    ivec2 texel = min(ivec2(place * vec2(settings.size)), settings.size - 1);
    // Depth first through the pyramid: down into a part that is near, else on to the next.
    int level = settings.levels;
    ivec2 extent = ivec2(fog_parts(settings.size.x, level), fog_parts(settings.size.y, level));
    ivec2 at = ivec2(0);
    int first = 0;
    for (int below = 1; below < level; ++below) {
        first += fog_parts(settings.size.x, below) * fog_parts(settings.size.y, below);
    }
    vec3 glow = vec3(0.0);
    while (true) {
        FogPart part;
        vec3 seen = vec3(0.0);
        if (level == 0) {
            seen = texelFetch(environment, at, 0).rgb;
            part = fog_texel(at, settings.size, seen);
        } else {
            int entry = 2 * (first + at.y * fog_parts(settings.size.x, level) + at.x);
            part = FogPart(parts.values[entry], parts.values[entry + 1]);
        }
        float chord = length(part.center.xyz - direction);
        if (level > 0 && chord < settings.optical.w * part.center.w) {
            level -= 1;
            first -= level > 0 ? fog_parts(settings.size.x, level) * fog_parts(settings.size.y, level) : 0;
            at *= 2;
            continue;
        }
        if (level == 0 && chord < NEIGHBOURS * part.center.w) {
            // The glow varies within the texel itself and those about it: nine parts of each.
            for (int i = 0; i < 9; ++i) {
                FogPart ninth = fog_texel(3 * at + ivec2(i % 3, i / 3), 3 * settings.size, seen);
                glow += light_of(ninth, length(ninth.center.xyz - direction));
            }
        } else {
            // The mean of 1 / chord over an evenly lit disc is larger than its value in the middle.
            glow += light_of(part, chord) * (1.0 + part.flux.w / (8.0 * PI * chord * chord));
        }
        bool ended = false;
        while (true) {
            ivec2 most = ivec2(fog_parts(settings.size.x, level), fog_parts(settings.size.y, level)) - 1;
            if (level == settings.levels) {
                at.x += 1;
                if (at.x > most.x) { at = ivec2(0, at.y + 1); }
                ended = at.y > most.y;
                break;
            }
            if ((at.x & 1) == 0 && at.x < most.x) {
                at.x += 1;
                break;
            }
            at.x &= ~1;
            if ((at.y & 1) == 0 && at.y < most.y) {
                at.y += 1;
                break;
            }
            first += level > 0 ? fog_parts(settings.size.x, level) * fog_parts(settings.size.y, level) : 0;
            at /= 2;
            level += 1;
        }
        if (ended) { break; }
    }
    vec3 straight = texelFetch(environment, texel, 0).rgb;
    radiance = vec4(settings.straight * exp(-settings.optical.rgb) * straight + settings.albedo.rgb * glow, 1.0);
}
