// A tile of a face of a cube map, a block of rays an invocation, and what its rays see.
//
// The includer defines BLOCK.

#ifndef RADIANCE_TILE_GLSL
#define RADIANCE_TILE_GLSL

#define TILE (8 * BLOCK) // rays along a side

// Of each ray: bits of the nearness, length of the ray over distance, and the name of the triangle; 0 for none.
shared uint tile_nearness[TILE * TILE];
shared uint tile_name[TILE * TILE];
// 1 where any ray may see anything.
shared uint tile_met;

// A tile of a face: where it begins, and how wide its rays are.
struct Tile {
    uint face;
    vec2 low;
    float side;
    ivec2 first; // ray of the face
    int rays; // along a side of the face
};

// Where a ray of the tile passes the face.
vec2 tile_at(Tile tile, ivec2 ray)
{
    precise vec2 at = tile.low + tile.side * (vec2(ray) + 0.5);
    return at;
}

#endif
