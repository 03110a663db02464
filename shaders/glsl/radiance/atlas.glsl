// What the rays of a tile see, read from an atlas that was drawn: as radiance/visible.glsl has it, which finds it itself.
//
// The includer defines BLOCK and has a workgroup of LANES invocations, the buffer `triangles` and the picture `atlas`.

#ifndef RADIANCE_ATLAS_GLSL
#define RADIANCE_ATLAS_GLSL

#include "radiance/face.glsl"
#include "radiance/tile.glsl"

// 1 where any ray sees anything.
shared uint tile_met;

uint tile_begin(vec3 point, uint triangle_count)
{
    return 0u;
}

bool tile_find(Tile tile, vec3 point, uint triangle_count, uint faces, out Block block)
{
    uint lane = gl_LocalInvocationIndex;
    uint face = 6u * gl_WorkGroupID.x + tile.face;
    ivec2 corner = tile.rays * ivec2(face % settings.columns, face / settings.columns) + tile.first;
    if (lane == 0u) { tile_met = 0u; }
    barrier();
    for (int i = 0; i < BLOCK * BLOCK; ++i) {
        ivec2 ray = tile_block(lane) + ivec2(i % BLOCK, i / BLOCK);
        bool inside = max(tile.first.x + ray.x, tile.first.y + ray.y) < tile.rays;
        uint name = inside ? uint(texelFetch(atlas, corner + ray, 0).r) : 0u;
        float nearness = 0.0;
        for (bool met = name > 0u; met; met = false) {
            Triangle triangle = triangles[min(name, triangle_count) - 1u];
            vec3 a = face_coordinates(tile.face, triangle.corners[0].xyz - point);
            vec3 b = face_coordinates(tile.face, triangle.corners[1].xyz - point);
            vec3 c = face_coordinates(tile.face, triangle.corners[2].xyz - point);
            float side;
            nearness = max(face_product(face_plane(a, b, c, side), tile_at(tile, ray)), 0.0);
            tile_met = 1u;
        }
        block.nearness[i] = nearness;
        block.names[i] = nearness > 0.0 ? name : 0u;
    }
    barrier();
    bool met = tile_met != 0u;
    barrier();
    return met;
}

#endif
