#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
// Incident radiance of triangles at samples: a workgroup a sample, an invocation a block of rays of a tile of a face of a cube
// map, RAYS x RAYS rays a texel. Sun, "Effective Sampling and Reconstruction of Incident Radiance for Spherical
// Harmonic Lighting" (2005), section 3.3.4, with exact solid angles of texels. Of triangles that hide one another the
// nearest is seen. The basis is taken in the middle of what a texel sees.
//
// ORDER      3-6
// GRADIENTS  1: derivatives by the sample's position, too
// RAYS       1, 2 or 4
// ATLAS      1: what rays see is read from an atlas that was drawn

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
// RGB of the texels of all levels of all pictures.
layout(std430, set = 0, binding = 6) readonly buffer Pictures { vec4 pictures[]; };
#include "radiance/surface.glsl"
layout(std430, set = 0, binding = 5) readonly buffer Surfaces { Surface surfaces[]; };
#if GRADIENTS
layout(std430, set = 0, binding = 7) buffer Gradients { vec4 gradients[]; };
#endif

#ifdef ATLAS
layout(set = 0, binding = 8) uniform texture2D atlas;
#endif

layout(push_constant) uniform Settings {
    uint triangle_count;
    uint size; // texels along a side of a face
    uint keep_exact; // 1: samples that are exact already, or kept, are left alone
    uint shown_first; // triangles from it on show pictures
    uint shown_count;
    float red; // extinction of the medium between, 1/m
    float green;
    float blue;
    uint columns; // of the atlas, faces in a row
} settings;

#define SAMPLE_LIGHT(i) lights[(batch.first + gl_WorkGroupID.x) * uint(LIGHT_STRIDE) + (i)]
#define SAMPLE_GRADIENT(i) gradients[(batch.first + gl_WorkGroupID.x) * uint(GRADIENT_STRIDE) + (i)]

#include "radiance/sums.glsl"

// Rays along a side of an invocation's block: several, since reading a triangle takes longer than trying it.
#if RAYS == 1
#define BLOCK 2
#else
#define BLOCK 4
#endif
#define TEXELS (BLOCK / RAYS) // along a side of a block

#ifdef ATLAS
#include "radiance/atlas.glsl"
#else
#include "radiance/visible.glsl"
#endif

// What a ray sees of a triangle that shows a picture; `depth` is the distance along the face's normal.
vec3 shown_radiance(Tile tile, vec3 point, uint index, vec2 at, float depth)
{
    Surface surface = surfaces[index - settings.shown_first];
    vec3 way = face_world(tile.face, vec3(at, 1.0));
    vec3 corners[3];
    for (int k = 0; k < 3; ++k) { corners[k] = triangles[index].corners[k].xyz - point; }
    vec3 shares = vec3(dot(cross(corners[1], corners[2]), way), dot(cross(corners[2], corners[0]), way),
        dot(cross(corners[0], corners[1]), way));
    shares /= shares.x + shares.y + shares.z;
    vec2 place = shares.x * surface.first.xy + shares.y * surface.first.zw + shares.z * surface.last.xy;
    return surface_radiance(surface, place, log2(max(surface.last.z * tile.side * depth, 1e-30)));
}

// Means over the rays of a texel, of which `first` is the first in the tile and `block` has what they see. Triangles without
// radiance hide others, and are not there otherwise.
Texel texel_of(Tile tile, vec3 point, Block block, ivec2 first, float solid_angle)
{
    Texel texel;
    texel.solid_angle = solid_angle / float(RAYS * RAYS);
    texel.radiance = vec3(0.0);
    texel.covered = 0.0;
    texel.slope = vec3(0.0);
    texel.nearness = 0.0;
#if GRADIENTS
    texel.dimming = vec3(0.0);
    vec3 plane = vec3(0.0);
    [[unroll]] for (int k = 0; k < 3; ++k) { texel.tilt[k] = vec3(0.0); }
#endif
    vec3 extinction = vec3(settings.red, settings.green, settings.blue);
    vec3 radiance = vec3(0.0);
    vec2 middle = vec2(0.0);
    uint name = 0u;
    for (int i = 0; i < RAYS * RAYS; ++i) {
        ivec2 ray = first + ivec2(i % RAYS, i / RAYS);
        ivec2 within = ray & (BLOCK - 1);
        int place = within.y * BLOCK + within.x;
        uint next = block.names[place];
        // A loop, not a branch: software drivers run through a branch that nobody takes. Neighbours see the same triangle.
        for (; name != next; name = next) {
            Triangle triangle = triangles[max(next, 1u) - 1u];
            vec3 colour = vec3(triangle.corners[0].w, triangle.corners[1].w, triangle.corners[2].w);
            radiance = next == 0u ? vec3(0.0) : colour;
#if GRADIENTS
            float side;
            plane = face_plane(triangle.corners[0].xyz - point, triangle.corners[1].xyz - point,
                triangle.corners[2].xyz - point, side);
#endif
        }
        vec2 at = tile_at(tile, ray);
        float along = block.nearness[place];
        for (bool shown = next > settings.shown_first && next <= settings.shown_first + settings.shown_count; shown; shown = false) {
            radiance = shown_radiance(tile, point, next - 1u, at, 1.0 / along);
        }
        if (max(radiance.r, max(radiance.g, radiance.b)) > 0.0) {
            float product = along * inversesqrt(dot(at, at) + 1.0);
            float nearness = min(product, MOST_NEARNESS);
            vec3 uniform_ = radiance;
            for (bool dim = max(extinction.r, max(extinction.g, extinction.b)) > 0.0; dim; dim = false) {
                radiance *= exp(-extinction / nearness);
            }
            middle += at;
            texel.radiance += radiance;
            texel.covered += 1.0;
            texel.slope += nearness * radiance;
            texel.nearness += nearness;
#if GRADIENTS
            // plane / (plane . unit ray) is the tilt, and its denominator the nearness.
            vec3 tilt = (nearness / product) * plane;
            [[unroll]] for (int k = 0; k < 3; ++k) { texel.tilt[k] += tilt[k] * radiance; }
            texel.dimming += extinction * radiance;
#endif
            radiance = uniform_;
        }
    }
    texel.direction = normalize(cube_direction(tile.face, 0.5 * (middle / max(texel.covered, 1.0)) + 0.5));
    return texel;
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    vec3 point = points[batch.first + gl_WorkGroupID.x].xyz;
    uint tile_texels = uint(TILE / RAYS);
    uint tiles = (settings.size + tile_texels - 1u) / tile_texels;
    float side = 2.0 / float(settings.size * uint(RAYS));
    vec4 sums[ELEMENTS];
    sums_clear(sums);
    bool wanted = settings.keep_exact == 0u || SAMPLE_LIGHT(uint(LIGHT_EXTENT)).z == 0.0;
    uint faces = tile_begin(point, wanted ? settings.triangle_count : 0u);
    uint tile_count = wanted ? 6u * tiles * tiles : 0u;
    for (uint number = 0u; number < tile_count; ++number) {
        uvec2 corner = uvec2(number % tiles, number / tiles % tiles);
        vec2 low = float(TILE) * side * vec2(corner) - 1.0;
        Tile tile = Tile(number / (tiles * tiles), low, side, TILE * ivec2(corner), int(settings.size) * RAYS);
        Block block;
        bool met = tile_find(tile, point, settings.triangle_count, faces, block);
        for (uint i = 0u; i < (met ? uint(TEXELS * TEXELS) : 0u); ++i) {
            ivec2 place = tile_block(lane) / RAYS + ivec2(i % uint(TEXELS), i / uint(TEXELS));
            uvec2 texel = tile_texels * corner + uvec2(place);
            bool inside = max(texel.x, texel.y) < settings.size;
            float solid_angle = inside ? solid_angles[texel.y * settings.size + texel.x] : 0.0;
            Texel seen = texel_of(tile, point, block, RAYS * place, solid_angle);
            for (bool lit = seen.covered > 0.0; lit; lit = false) { sums_add(seen, sums); }
        }
    }
    sums_write(sums, lane, wanted);
}
