// What the rays of a tile see of triangles that hide one another: the nearest.
//
// A triangle that few rays may meet is cast by one invocation, ray by ray, as a rasteriser does; one that more may meet is
// tried by all invocations, each for the rays of its block. The includer defines BLOCK and has a workgroup of LANES
// invocations and the buffer `triangles`.

#ifndef RADIANCE_VISIBLE_GLSL
#define RADIANCE_VISIBLE_GLSL

#include "radiance/exact.glsl"
#include "radiance/face.glsl"
#include "radiance/tile.glsl"

// The most rays that a triangle is cast through by one invocation. Of 0, 4, 8 and 16 it takes the least time.
#define FEW 16

// Triangles that all invocations try, of LANES gathered at a time, and the rays that may meet them, a byte a number.
shared Seen tile_seen[LANES];
shared uint tile_spans[LANES];
shared uint tile_mask[2];
// Of each ray: bits of the nearness and the name of what one invocation cast. Zero between tiles.
shared uint tile_nearness[TILE * TILE];
shared uint tile_name[TILE * TILE];
// 1 where any ray may see anything, and where anything was cast. Zero between tiles.
shared uint tile_met;
shared uint tile_any_cast;

// A corner of a triangle as seen from a point.
Corner tile_corner(vec3 point, uint index, int k)
{
    vec3 place = triangles[index].corners[k].xyz;
    Corner corner;
    [[unroll]] for (int i = 0; i < 3; ++i) { corner.axes[i] = exact_sum(place[i], -point[i]); }
    return corner;
}

// Whether a ray that passes an edge within rounding hits: as the numbers of the buffers have it, not what is left of them.
// Edges one after another: three copies of the code would take drivers longer to compile than rays ever take.
bool tile_decides(Tile tile, vec3 point, uint name, float turn, ivec2 ray)
{
    // Whole numbers, since rays lie at multiples of 1 / (RAYS rays).
    ivec2 middle = 2 * (tile.first + ray) + 1 - tile.rays;
    vec3 way = face_world(tile.face, vec3(RAYS * middle + tile_shear(tile, ray), RAYS * tile.rays));
    bool inside = true;
    [[dont_unroll]] for (int k = 0; k < 3; ++k) {
        Corner from = tile_corner(point, name - 1u, (k + 1) % 3);
        Corner to = tile_corner(point, name - 1u, (k + 2) % 3);
        float side = exact_side(way, from, to);
        // Coordinates of a face mirror the world.
        inside = inside && turn * side <= 0.0;
    }
    return inside;
}

// The rays that may meet a triangle of these corners, in coordinates of the face: from xy to zw.
ivec4 tile_span(Tile tile, vec3 a, vec3 b, vec3 c)
{
    // Of rays: how far one is off the middle of its part, and more than rounding moves an edge.
    const float slack = 0.5 * float(RAYS - 1) / float(RAYS) + 0.01;
    const ivec4 all_ = ivec4(0, 0, TILE - 1, TILE - 1);
    float least = min(a.z, min(b.z, c.z));
    if (!face_meets(a, b, c, tile.low, tile.low + float(TILE) * tile.side)) { return ivec4(1, 1, 0, 0); }
    vec2 corners[3] = vec2[3](a.xy / a.z, b.xy / b.z, c.xy / c.z);
    vec2 low = min(corners[0], min(corners[1], corners[2]));
    vec2 high = max(corners[0], max(corners[1], corners[2]));
    vec2 first = clamp((low - tile.low) / tile.side - (0.5 + slack), vec2(0.0), vec2(float(TILE)));
    vec2 last = clamp((high - tile.low) / tile.side - (0.5 - slack), vec2(-1.0), vec2(float(TILE) - 1.0));
    // What reaches behind the point is nowhere on the face that its corners would say.
    return least > 1e-30 ? ivec4(ceil(first), floor(last)) : all_;
}

// The ray of a span after `ray`, row by row.
ivec2 tile_next(ivec4 span, ivec2 ray)
{
    bool ends = ray.x == span.z;
    return ends ? ivec2(span.x, ray.y + 1) : ivec2(ray.x + 1, ray.y);
}

uint tile_nearness_of(Tile tile, Seen seen, ivec2 ray)
{
    return floatBitsToUint(max(face_product(seen.plane, tile_at(tile, ray)), 0.0));
}

// Casts a triangle through the first rays of a span, and keeps the nearest of all that are cast at once. A bit for each ray
// that hits.
uint tile_cast(Tile tile, vec3 point, Seen seen, ivec4 span, uint count)
{
    uint hits = 0u;
    ivec2 ray = span.xy;
    for (uint i = 0u; i < count; ++i) {
        float least = face_least(seen.edges, tile_at(tile, ray));
        bool hit = least >= 0.0;
        // Loops, not branches: software drivers run through a branch that nobody takes.
        for (bool close = abs(least) < FACE_CLOSE; close; close = false) { hit = tile_decides(tile, point, seen.name, seen.side, ray); }
        for (; hit; hit = false) {
            atomicMax(tile_nearness[ray.y * TILE + ray.x], tile_nearness_of(tile, seen, ray));
            hits |= 1u << i;
        }
        ray = tile_next(span, ray);
    }
    return hits;
}

// Names the triangle where it is the nearest: of those that are as near the last, for an order that no scheduling changes.
void tile_sign(Tile tile, Seen seen, ivec4 span, uint hits)
{
    ivec2 ray = span.xy;
    for (; hits != 0u; hits >>= 1u) {
        for (bool hit = (hits & 1u) != 0u; hit; hit = false) {
            uint nearness = tile_nearness_of(tile, seen, ray);
            int place = ray.y * TILE + ray.x;
            if (nearness > 0u && nearness == tile_nearness[place]) { atomicMax(tile_name[place], seen.name); }
        }
        ray = tile_next(span, ray);
    }
}

// Of the first FACED times LANES triangles those of an invocation that faces may meet: a bit for each of six faces.
#define FACED 5
uint tile_faces(vec3 point, uint triangle_count)
{
    uint faces = 0u;
    for (uint i = 0u; i < uint(FACED); ++i) {
        uint index = i * uint(LANES) + gl_LocalInvocationIndex;
        // A loop, not a branch: software drivers run through a branch that nobody takes.
        for (bool is = index < triangle_count; is; is = false) {
            Triangle triangle = triangles[index];
            [[unroll]] for (uint face = 0u; face < 6u; ++face) {
                vec3 a = face_coordinates(face, triangle.corners[0].xyz - point);
                vec3 b = face_coordinates(face, triangle.corners[1].xyz - point);
                vec3 c = face_coordinates(face, triangle.corners[2].xyz - point);
                faces |= face_meets(a, b, c, vec2(-1.0), vec2(1.0)) ? 1u << (6u * i + face) : 0u;
            }
        }
    }
    return faces;
}

// Tries LANES triangles from `first` on: casts the small ones, and keeps the others in `tile_seen`, in their order. Their
// number.
uint tile_gather(Tile tile, vec3 point, uint first, uint triangle_count, uint faces)
{
    uint lane = gl_LocalInvocationIndex;
    uint index = first + lane;
    uint chunk = first / uint(LANES);
    Seen seen = Seen(vec3[3](vec3(0.0), vec3(0.0), vec3(0.0)), vec3(0.0), 0.0, index + 1u);
    ivec4 span = ivec4(1, 1, 0, 0);
    uint rays = 0u;
    bool may = chunk >= uint(FACED) || (faces >> (6u * chunk + tile.face) & 1u) != 0u;
    for (bool is = may && index < triangle_count; is; is = false) {
        vec3 a = face_coordinates(tile.face, triangles[index].corners[0].xyz - point);
        vec3 b = face_coordinates(tile.face, triangles[index].corners[1].xyz - point);
        vec3 c = face_coordinates(tile.face, triangles[index].corners[2].xyz - point);
        seen = face_seen(a, b, c, index + 1u);
        span = tile_span(tile, a, b, c);
        ivec2 extent = max(span.zw - span.xy + 1, ivec2(0));
        rays = uint(extent.x * extent.y);
    }
    uint few = rays <= uint(FEW) ? rays : 0u;
    bool many = rays > few;
    if (lane < 2u) { tile_mask[lane] = 0u; }
    barrier();
    for (bool mark = many; mark; mark = false) { atomicOr(tile_mask[lane / 32u], 1u << (lane % 32u)); }
    for (bool mark = rays > 0u; mark; mark = false) {
        tile_met = 1u;
        if (few > 0u) { tile_any_cast = 1u; }
    }
    uint hits = tile_cast(tile, point, seen, span, few);
    barrier();
    tile_sign(tile, seen, span, hits);
    ivec2 mask = ivec2(tile_mask[0], tile_mask[1]); // signed as what bitCount returns: naga has no other
    for (; many; many = false) {
        int below = int((1u << (lane % 32u)) - 1u);
        int place = lane < 32u ? bitCount(mask.x & below) : bitCount(mask.x) + bitCount(mask.y & below);
        tile_seen[place] = seen;
        tile_spans[place] = uint(span.x | span.y << 8 | span.z << 16 | span.w << 24);
    }
    barrier();
    return uint(bitCount(mask.x) + bitCount(mask.y));
}

// Tries the rays of a block with triangle `k` of those gathered. Reading it takes longer than trying it: what tells that no
// ray hits comes first.
void tile_try(Tile tile, vec3 point, ivec2 first, uint k, inout Block block)
{
    vec3 edges[3] = tile_seen[k].edges;
    int hits = 0;
    int close = 0;
    [[unroll]] for (int i = 0; i < BLOCK * BLOCK; ++i) {
        float least = face_least(edges, tile_at(tile, first + ivec2(i % BLOCK, i / BLOCK)));
        hits |= least >= FACE_CLOSE ? 1 << i : 0;
        close |= abs(least) < FACE_CLOSE ? 1 << i : 0;
    }
    for (; close != 0; close &= close - 1) {
        int i = findLSB(close);
        bool hit = tile_decides(tile, point, tile_seen[k].name, tile_seen[k].side, first + ivec2(i % BLOCK, i / BLOCK));
        hits |= hit ? 1 << i : 0;
    }
    // A loop, not a branch: software drivers run through a branch that nobody takes.
    for (; hits != 0; hits = 0) {
        vec3 plane = tile_seen[k].plane;
        uint name = tile_seen[k].name;
        [[unroll]] for (int i = 0; i < BLOCK * BLOCK; ++i) {
            float near = face_product(plane, tile_at(tile, first + ivec2(i % BLOCK, i / BLOCK)));
            bool nearer = (hits & 1 << i) != 0 && near > block.nearness[i];
            block.nearness[i] = nearer ? near : block.nearness[i];
            block.names[i] = nearer ? name : block.names[i];
        }
    }
}

// Takes what was cast through the rays of a block where it is as near, and leaves zeros.
void tile_merge(ivec2 first, inout Block block)
{
    [[unroll]] for (int i = 0; i < BLOCK * BLOCK; ++i) {
        int place = (first.y + i / BLOCK) * TILE + first.x + i % BLOCK;
        uint bits = tile_nearness[place];
        for (bool cast_ = bits != 0u; cast_; cast_ = false) {
            bool nearer = bits >= floatBitsToUint(block.nearness[i]);
            block.nearness[i] = nearer ? uintBitsToFloat(bits) : block.nearness[i];
            block.names[i] = nearer ? tile_name[place] : block.names[i];
            tile_nearness[place] = 0u;
            tile_name[place] = 0u;
        }
    }
}

// Before the first tile. What `tile_find` takes as the faces of the triangles.
uint tile_begin(vec3 point, uint triangle_count)
{
    uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) {
        tile_met = 0u;
        tile_any_cast = 0u;
    }
    for (uint place = lane; place < uint(TILE * TILE); place += uint(LANES)) {
        tile_nearness[place] = 0u;
        tile_name[place] = 0u;
    }
    barrier();
    return tile_faces(point, triangle_count);
}

// Finds what the rays of an invocation's block see. False where no triangle meets the tile.
bool tile_find(Tile tile, vec3 point, uint triangle_count, uint faces, out Block block)
{
    uint lane = gl_LocalInvocationIndex;
    ivec2 ray = tile_block(lane);
    [[unroll]] for (int i = 0; i < BLOCK * BLOCK; ++i) {
        block.nearness[i] = 0.0;
        block.names[i] = 0u;
    }
    for (uint first = 0u; first < triangle_count; first += uint(LANES)) {
        uint count = tile_gather(tile, point, first, triangle_count, faces);
        for (uint k = 0u; k < count; ++k) {
            ivec4 span = ivec4(uvec4(tile_spans[k]) >> uvec4(0u, 8u, 16u, 24u) & 0xffu);
            bool meets = all(lessThanEqual(ray, span.zw)) && all(greaterThan(ray + BLOCK, span.xy));
            for (; meets; meets = false) { tile_try(tile, point, ray, k, block); }
        }
    }
    for (bool merge = tile_any_cast != 0u; merge; merge = false) { tile_merge(ray, block); }
    bool met = tile_met != 0u;
    barrier();
    if (lane == 0u) {
        tile_met = 0u;
        tile_any_cast = 0u;
    }
    return met;
}

#endif
