#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// What white diffuse surfaces reflect of the light that spheres leave them, a receiver a pixel: as visibility.comp, and the
// visibility dotted with the products of light and cosine, `L_H(N) . g` (Sun 2008, section 5.2.4), and a disc of light
// beside; or which share that is of what they reflect without spheres. A workgroup is a tile of 8 times 8 pixels, which
// chooses its nodes once.
//
// The includer's defines: ORDER; EXPONENTIAL 0; NORMALS.

layout(local_size_x = 8, local_size_y = 8) in;

// Space of the spheres; w 0 where there is no surface. Nor is there one where a number of it or of the normal is not finite.
layout(set = 0, binding = 0) uniform texture2D positions;
// Of any length but 0.
layout(set = 0, binding = 1) uniform texture2D normals;

layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D picture;

#if ORDER == 3
const uint COLUMNS = 9u;
#elif ORDER == 4
const uint COLUMNS = 9u;
#else
const uint COLUMNS = 18u;
#endif

// Basis functions of the normal in bands 0, 1, 2 and 4, order^2 colours each.
layout(std140, set = 0, binding = 9) uniform Products {
    vec4 values[COLUMNS * ORDER * ORDER];
} products;

const uint CLAMPED = 1u; // visibility is made one that there can be
const uint SHARE = 2u;   // the picture is the share of light that spheres leave, 1 where there is no surface

layout(push_constant) uniform Settings {
    uvec2 size;
    uint count;  // nodes
    uint flags;
    float reach; // heights of caps below this are left out of a whole tile
    float cut;   // nodes whose height is below this stand for what they hold
    float window;
    float disc_radius; // angular; 0: no disc
    vec4 disc;         // direction
    vec4 irradiance;   // of a surface that faces it
} settings;

#define SHADOW_TABLE_END 1.0
#define RECEIVERS 1
#include "common/sh_basis.glsl"
#include "shadow/blockers.glsl"

const float PI = 3.14159265358979;

shared vec3 corners[2][64];

// The sphere around the box of the tile's surfaces.
vec4 tile_bound(uint lane, vec3 place, bool there)
{
    corners[0][lane] = there ? place : vec3(3e18);
    corners[1][lane] = there ? place : vec3(-3e18);
    barrier();
    vec3 low = corners[0][lane & 56u];
    vec3 high = corners[1][lane & 56u];
    for (uint i = 1u; i < 8u; ++i) {
        low = min(low, corners[0][(lane & 56u) + i]);
        high = max(high, corners[1][(lane & 56u) + i]);
    }
    barrier();
    corners[0][lane] = low;
    corners[1][lane] = high;
    barrier();
    for (uint i = 0u; i < 8u; ++i) {
        low = min(low, corners[0][8u * i]);
        high = max(high, corners[1][8u * i]);
    }
    return vec4(0.5 * (low + high), 0.5 * length(high - low));
}

// The share of the disc that a cap covers: what circles in the plane would, eased over the rim.
float covered(vec4 cap)
{
    float radius = asin(sqrt(cap.w));
    float between = acos(clamp(dot(cap.xyz, settings.disc.xyz), -1.0, 1.0));
    float near = abs(radius - settings.disc_radius);
    float part = min(radius / settings.disc_radius, 1.0);
    return part * part * (1.0 - smoothstep(near, max(radius + settings.disc_radius, near + 1e-9), between));
}

// The share of the disc that the spheres of the set leave.
float disc_seen(vec3 place, vec3 normal)
{
    float seen = 1.0;
    for (uint at = 0u; at < settings.count; ++at) {
        vec4 sphere = spheres.values[at];
        float share = nodes.values[at].z == 0.0 ? 1.0 : 0.0;
#ifdef NORMALS
        float above;
        sphere = shadow_above(sphere, place, normal, above);
        share *= above;
#endif
        seen *= 1.0 - share * covered(shadow_cap(sphere.xyz, sphere.w, place));
    }
    return seen;
}

// What surfaces reflect of the light of the products; and what they would if all of it were seen.
vec3 reflected(vec3 normal, float g[COUNT], out vec3 open)
{
    float basis[COUNT];
    sh_evaluate(normal, basis);
    vec3 sum = vec3(0.0);
    open = vec3(0.0);
    for (uint at = 0u; at < COLUMNS; ++at) {
        // Band 3 has no column.
        uint k = at < 9u ? at : at + 7u;
        vec3 product = vec3(0.0);
        EACH(i) { product += g[i] * products.values[at * uint(COUNT) + uint(i)].rgb; }
        sum += basis[k] * product;
        open += basis[k] * (ONE * products.values[at * uint(COUNT)].rgb);
    }
    open = max(open, vec3(0.0));
    return max(sum, vec3(0.0));
}

// The share of light that is left, 1 where there is none.
vec3 share_of(vec3 light, vec3 open)
{
    return mix(light / max(open, vec3(1e-20)), vec3(1.0), equal(open, vec3(0.0)));
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 inside = min(pixel, ivec2(settings.size) - 1);
    vec4 surface = texelFetch(positions, inside, 0);
    vec3 normal = texelFetch(normals, inside, 0).xyz;
    bool there = pixel == inside && finite(surface) && finite(vec4(normal, 0.0)) && surface.w > 0.0;
    vec3 place = there ? surface.xyz : vec3(0.0);
    normal = there ? normal * inversesqrt(max(dot(normal, normal), 1e-30)) : vec3(0.0, 0.0, 1.0);
    choose(lane, tile_bound(lane, place, there), settings.reach, settings.cut);
    Receiver receivers[1];
    receivers[0] = Receiver(place, normal);
    float sums[1][COUNT];
    uint here = accumulate(receivers, sums);
    float g[COUNT] = sums[0];
    if (here == 0u) {
        g[0] = ONE;
    } else {
        exponential(g, Exponential(0u, 1e30, 0u));
        if ((settings.flags & CLAMPED) != 0u) { clamp_visibility(g); }
    }
    EACH(i) {
        float band = i < 1 ? 0.0 : i < 4 ? 2.0 : i < 9 ? 6.0 : i < 16 ? 12.0 : i < 25 ? 20.0 : 30.0; // l (l + 1)
        g[i] /= 1.0 + settings.window * band * band;
    }
    vec3 open;
    vec3 light = reflected(normal, g, open);
    float cosine = dot(normal, settings.disc.xyz);
    if (settings.disc_radius > 0.0 && cosine > 0.0) {
        vec3 of_disc = cosine / PI * settings.irradiance.rgb;
        light += disc_seen(place, normal) * of_disc;
        open += of_disc;
    }
    bool share = (settings.flags & SHARE) != 0u;
    vec4 shown = vec4(share ? share_of(light, open) : light, g[0] / ONE);
    if (pixel == inside) { imageStore(picture, pixel, there ? shown : vec4(share ? 1.0 : 0.0)); }
}
