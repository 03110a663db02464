#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Incident radiance of triangles at samples: a workgroup a sample, a texel of an 8 x 8 tile of a face of a cube map an
// invocation, RAYS x RAYS rays a texel. Sun, "Effective Sampling and Reconstruction of Incident Radiance for Spherical
// Harmonic Lighting" (2005), section 3.3.4, with exact solid angles of texels. Of triangles that hide one another the
// nearest is seen. The basis is taken in the middle of what a texel sees.
//
// ORDER      3-6
// GRADIENTS  1: derivatives by the sample's position, too
// RAYS       1, 2 or 4

#include "common/cube.glsl"
#include "radiance/face.glsl"
#include "radiance/sample.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Samples { Batch batch; };
layout(std430, set = 0, binding = 1) readonly buffer Points { vec4 points[]; };
layout(std430, set = 0, binding = 2) readonly buffer Triangles { Triangle triangles[]; };
// Of the texels of a face, row by row, steradians.
layout(std430, set = 0, binding = 3) readonly buffer SolidAngles { float solid_angles[]; };
layout(std430, set = 0, binding = 4) buffer Lights { vec4 lights[]; };
#if GRADIENTS
layout(std430, set = 0, binding = 5) buffer Gradients { vec4 gradients[]; };
#endif

layout(push_constant) uniform Settings {
    uint triangle_count;
    uint size; // texels along a side of a face
    uint keep_exact; // 1: samples that are exact already are left alone
} settings;

#define SAMPLE_LIGHT(i) lights[(batch.first + gl_WorkGroupID.x) * uint(LIGHT_STRIDE) + (i)]
#define SAMPLE_GRADIENT(i) gradients[(batch.first + gl_WorkGroupID.x) * uint(GRADIENT_STRIDE) + (i)]

#include "radiance/sums.glsl"

#define TILE 8
#define ALL_RAYS (RAYS * RAYS)

// Triangles that the tile may see, of LANES tried at a time.
shared Seen tile_seen[LANES];
shared uint tile_mask[2];

// What a ray has met so far.
struct Ray {
    vec3 radiance;
    float nearness; // length of the ray over distance
#if GRADIENTS
    vec3 plane;
#endif
};

// From the middle of a texel to that of one of its rays, in texels.
vec2 ray_offset(int ray)
{
    return (vec2(ray % RAYS, ray / RAYS) + 0.5) / float(RAYS) - 0.5;
}

// Tries LANES triangles from `first` on, and keeps those that rays within low .. high may meet, in their order.
uint gather(uint face, vec3 point, uint first, vec2 low, vec2 high)
{
    uint lane = gl_LocalInvocationIndex;
    uint index = first + lane;
    vec3 corners[3];
    vec3 radiance = vec3(0.0);
    bool meets = index < settings.triangle_count;
    if (meets) {
        vec4 a = triangles[index].corners[0];
        vec4 b = triangles[index].corners[1];
        vec4 c = triangles[index].corners[2];
        radiance = vec3(a.w, b.w, c.w);
        corners[0] = face_coordinates(face, a.xyz - point);
        corners[1] = face_coordinates(face, b.xyz - point);
        corners[2] = face_coordinates(face, c.xyz - point);
        meets = face_meets(corners[0], corners[1], corners[2], low, high);
    }
    if (lane < 2u) { tile_mask[lane] = 0u; }
    barrier();
    if (meets) { atomicOr(tile_mask[lane / 32u], 1u << (lane % 32u)); }
    barrier();
    ivec2 mask = ivec2(tile_mask[0], tile_mask[1]); // signed as what bitCount returns: naga has no other
    if (meets) {
        int below = int((1u << (lane % 32u)) - 1u);
        int place = lane < 32u ? bitCount(mask.x & below) : bitCount(mask.x) + bitCount(mask.y & below);
        tile_seen[place] = face_seen(corners[0], corners[1], corners[2], radiance);
    }
    barrier();
    return uint(bitCount(mask.x) + bitCount(mask.y));
}

// Keeps in each ray the triangle if it is nearer than what the ray has met. The texel's middle is at `middle`, texels are
// `side` wide.
void meet(Seen seen, vec2 middle, float side, inout Ray rays[ALL_RAYS])
{
    vec3 at = vec3(middle, 1.0);
    vec3 edges = vec3(dot(seen.edges[0].xyz, at), dot(seen.edges[1].xyz, at), dot(seen.edges[2].xyz, at));
    vec3 edges_x = side * vec3(seen.edges[0].x, seen.edges[1].x, seen.edges[2].x);
    vec3 edges_y = side * vec3(seen.edges[0].y, seen.edges[1].y, seen.edges[2].y);
    float plane = dot(seen.plane.xyz, at);
    vec3 radiance = vec3(seen.edges[0].w, seen.edges[1].w, seen.edges[2].w);
    [[unroll]] for (int i = 0; i < ALL_RAYS; ++i) {
        vec2 offset = ray_offset(i);
        vec3 edge = edges + offset.x * edges_x + offset.y * edges_y;
        float nearness = plane + side * dot(offset, seen.plane.xy);
        if (min(edge.x, min(edge.y, edge.z)) >= 0.0 && nearness > rays[i].nearness) {
            rays[i].nearness = nearness;
            rays[i].radiance = radiance;
#if GRADIENTS
            rays[i].plane = seen.plane.xyz;
#endif
        }
    }
}

// Means over the rays of a texel. Triangles without radiance hide others, and are not there otherwise.
Texel texel_of(uint face, vec2 middle, float side, float solid_angle, Ray rays[ALL_RAYS])
{
    Texel texel;
    texel.solid_angle = solid_angle / float(ALL_RAYS);
    texel.radiance = vec3(0.0);
    texel.covered = 0.0;
    texel.slope = vec3(0.0);
    texel.nearness = 0.0;
#if GRADIENTS
    [[unroll]] for (int k = 0; k < 3; ++k) { texel.tilt[k] = vec3(0.0); }
#endif
    vec2 centre = vec2(0.0);
    [[unroll]] for (int i = 0; i < ALL_RAYS; ++i) {
        vec3 radiance = rays[i].radiance;
        if (max(radiance.r, max(radiance.g, radiance.b)) > 0.0) {
            vec2 offset = ray_offset(i);
            vec2 at = middle + side * offset;
            float scale = inversesqrt(dot(at, at) + 1.0);
            float nearness = min(scale * rays[i].nearness, MOST_NEARNESS);
            centre += offset;
            texel.radiance += radiance;
            texel.covered += 1.0;
            texel.slope += nearness * radiance;
            texel.nearness += nearness;
#if GRADIENTS
            // plane / (plane . unit ray) is the tilt, and its denominator the nearness.
            vec3 tilt = rays[i].plane / (scale * rays[i].nearness);
            [[unroll]] for (int k = 0; k < 3; ++k) { texel.tilt[k] += tilt[k] * nearness * radiance; }
#endif
        }
    }
#if GRADIENTS
    mat3 tilt = transpose(mat3(texel.tilt[0], texel.tilt[1], texel.tilt[2]));
    [[unroll]] for (int colour = 0; colour < 3; ++colour) { tilt[colour] = face_world(face, tilt[colour]); }
    tilt = transpose(tilt);
    [[unroll]] for (int k = 0; k < 3; ++k) { texel.tilt[k] = tilt[k]; }
#endif
    vec2 at = middle + side * centre / max(texel.covered, 1.0);
    texel.direction = normalize(cube_direction(face, 0.5 * at + 0.5));
    return texel;
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    vec3 point = points[batch.first + gl_WorkGroupID.x].xyz;
    uint tiles = (settings.size + uint(TILE) - 1u) / uint(TILE);
    float side = 2.0 / float(settings.size);
    float tile_side = float(TILE) * side;
    vec4 sums[ELEMENTS];
    sums_clear(sums);
    bool wanted = settings.keep_exact == 0u || SAMPLE_LIGHT(uint(LIGHT_EXTENT)).z == 0.0;
    uint tile_count = wanted ? 6u * tiles * tiles : 0u;
    for (uint tile = 0u; tile < tile_count; ++tile) {
        uint face = tile / (tiles * tiles);
        uvec2 corner = uvec2(tile % tiles, tile / tiles % tiles);
        uvec2 place = uint(TILE) * corner + uvec2(lane % uint(TILE), lane / uint(TILE));
        vec2 middle = side * (vec2(place) + 0.5) - 1.0;
        vec2 low = tile_side * vec2(corner) - 1.0;
        Ray rays[ALL_RAYS];
        [[unroll]] for (int i = 0; i < ALL_RAYS; ++i) {
            rays[i].radiance = vec3(0.0);
            rays[i].nearness = 0.0;
#if GRADIENTS
            rays[i].plane = vec3(0.0);
#endif
        }
        uint met = 0u;
        for (uint first = 0u; first < settings.triangle_count; first += uint(LANES)) {
            uint count = gather(face, point, first, low, low + tile_side);
            met += count;
            for (uint i = 0u; i < count; ++i) { meet(tile_seen[i], middle, side, rays); }
            barrier();
        }
        bool inside = max(place.x, place.y) < settings.size;
        float solid_angle = inside ? solid_angles[place.y * settings.size + place.x] : 0.0;
        // A loop, not a branch: software drivers run through a branch that nobody takes.
        for (uint once = 0u; once < min(met, 1u); ++once) {
            sums_add(texel_of(face, middle, side, solid_angle, rays), sums);
        }
    }
    sums_write(sums, lane, wanted);
}
