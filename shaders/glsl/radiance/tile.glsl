// A tile of a face of a cube map, a block of rays an invocation, and what its rays see.
//
// The includer defines BLOCK and RAYS.

#ifndef RADIANCE_TILE_GLSL
#define RADIANCE_TILE_GLSL

#define TILE (8 * BLOCK) // rays along a side

// What the rays of an invocation's block see, row by row: nearness, length of the ray over distance, and the name of the
// triangle, 1 and its place in the buffer; 0 for none.
struct Block {
    float nearness[BLOCK * BLOCK];
    uint names[BLOCK * BLOCK];
};

// The first ray of an invocation's block.
ivec2 tile_block(uint lane)
{
    return BLOCK * ivec2(lane % 8u, lane / 8u);
}

// A tile of a face: where it begins, and how wide its rays are.
struct Tile {
    uint face;
    vec2 low;
    float side;
    ivec2 first; // ray of the face
    int rays; // along a side of the face
};

// How far a ray lies off the middle of its part of a texel, in parts of 2 RAYS of that: rows and columns
// are sheared so that all rays of a texel have rows and columns of their own, and edges along the axes, which are many, pass
// as many as others do (Chiu, Shirley, Wang, "Multi-Jittered Sampling", Graphics Gems IV, 1994, without the jitter). A
// rasteriser does not. The quarters of a face mirror one another, so that no turn of the axes changes what is seen.
ivec2 tile_shear(Tile tile, ivec2 ray)
{
#ifdef ATLAS
    return ivec2(0);
#else
    ivec2 middle = 2 * (tile.first + ray) + 1 - tile.rays;
    int turn = (middle.x < 0) == (middle.y < 0) ? 1 : -1;
    return turn * (2 * (ray.yx & (RAYS - 1)) + 1 - RAYS);
#endif
}

// Where a ray of the tile passes the face.
vec2 tile_at(Tile tile, ivec2 ray)
{
    // Exact but for the last product and sum.
    vec2 place = vec2(ray) + (0.5 + (0.5 / float(RAYS)) * vec2(tile_shear(tile, ray)));
    precise vec2 at = tile.low + tile.side * place;
    return at;
}

#endif
