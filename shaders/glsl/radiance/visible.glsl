// What the rays of a tile see of triangles that hide one another, in shared memory: the nearest.
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

// Triangles that all invocations try, of LANES gathered at a time.
shared Seen tile_seen[LANES];
shared uint tile_mask[2];

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
bool tile_decides(Tile tile, vec3 point, Seen seen, ivec2 ray)
{
    // Whole numbers, since rays lie at multiples of 1 / (RAYS rays).
    ivec2 middle = 2 * (tile.first + ray) + 1 - tile.rays;
    vec3 way = face_world(tile.face, vec3(RAYS * middle + tile_shear(tile, ray), RAYS * tile.rays));
    bool inside = true;
    [[dont_unroll]] for (int k = 0; k < 3; ++k) {
        Corner from = tile_corner(point, seen.name - 1u, (k + 1) % 3);
        Corner to = tile_corner(point, seen.name - 1u, (k + 2) % 3);
        float side = exact_side(way, from, to);
        // Coordinates of a face mirror the world.
        inside = inside && seen.side * side <= 0.0;
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

// Casts a triangle through the rays of a span. First the nearest is found among all that are cast at once, then its name:
// of names that are as near the last, for an order that no scheduling changes.
void tile_cast(Tile tile, vec3 point, Seen seen, ivec4 span, uint count, bool named)
{
    ivec2 ray = span.xy;
    for (uint i = 0u; i < count; ++i) {
        vec2 at = tile_at(tile, ray);
        float least = face_least(seen, at);
        bool hit = least >= 0.0;
        // A loop, not a branch: software drivers run through a branch that nobody takes.
        for (bool close = abs(least) < FACE_CLOSE; close; close = false) { hit = tile_decides(tile, point, seen, ray); }
        uint nearness = hit ? floatBitsToUint(max(face_product(seen.plane, at), 0.0)) : 0u;
        int place = ray.y * TILE + ray.x;
        if (!named && nearness > 0u) { atomicMax(tile_nearness[place], nearness); }
        if (named && nearness > 0u && nearness == tile_nearness[place]) { atomicMax(tile_name[place], seen.name); }
        bool ends = ray.x == span.z;
        ray = ends ? ivec2(span.x, ray.y + 1) : ivec2(ray.x + 1, ray.y);
    }
}

// Tries LANES triangles from `first` on: casts the small ones, and keeps the others in `tile_seen`, in their order. Their
// number.
uint tile_gather(Tile tile, vec3 point, uint first, uint triangle_count)
{
    uint lane = gl_LocalInvocationIndex;
    uint index = first + lane;
    Seen seen;
    ivec4 span = ivec4(1, 1, 0, 0);
    if (index < triangle_count) {
        vec3 a = face_coordinates(tile.face, triangles[index].corners[0].xyz - point);
        vec3 b = face_coordinates(tile.face, triangles[index].corners[1].xyz - point);
        vec3 c = face_coordinates(tile.face, triangles[index].corners[2].xyz - point);
        seen = face_seen(a, b, c, index + 1u);
        span = tile_span(tile, a, b, c);
    }
    ivec2 extent = max(span.zw - span.xy + 1, ivec2(0));
    uint rays = uint(extent.x * extent.y);
    uint few = rays <= uint(FEW) ? rays : 0u;
    bool many = rays > few;
    if (lane < 2u) { tile_mask[lane] = 0u; }
    barrier();
    if (many) { atomicOr(tile_mask[lane / 32u], 1u << (lane % 32u)); }
    if (rays > 0u) { tile_met = 1u; }
    for (uint pass_ = 0u; pass_ < 2u; ++pass_) {
        tile_cast(tile, point, seen, span, few, pass_ == 1u);
        barrier();
    }
    ivec2 mask = ivec2(tile_mask[0], tile_mask[1]); // signed as what bitCount returns: naga has no other
    if (many) {
        int below = int((1u << (lane % 32u)) - 1u);
        int place = lane < 32u ? bitCount(mask.x & below) : bitCount(mask.x) + bitCount(mask.y & below);
        tile_seen[place] = seen;
    }
    barrier();
    return uint(bitCount(mask.x) + bitCount(mask.y));
}

// Finds what each ray of the tile sees. False where no triangle meets the tile.
bool tile_find(Tile tile, vec3 point, uint triangle_count)
{
    uint lane = gl_LocalInvocationIndex;
    ivec2 block = BLOCK * ivec2(lane % 8u, lane / 8u);
    float nearness[BLOCK * BLOCK];
    uint names[BLOCK * BLOCK];
    [[unroll]] for (int i = 0; i < BLOCK * BLOCK; ++i) {
        nearness[i] = 0.0;
        names[i] = 0u;
        int place = (block.y + i / BLOCK) * TILE + block.x + i % BLOCK;
        tile_nearness[place] = 0u;
        tile_name[place] = 0u;
    }
    if (lane == 0u) { tile_met = 0u; }
    for (uint first = 0u; first < triangle_count; first += uint(LANES)) {
        uint count = tile_gather(tile, point, first, triangle_count);
        for (uint k = 0u; k < count; ++k) {
            Seen seen = tile_seen[k];
            int hits = 0;
            int close = 0;
            [[unroll]] for (int i = 0; i < BLOCK * BLOCK; ++i) {
                float least = face_least(seen, tile_at(tile, block + ivec2(i % BLOCK, i / BLOCK)));
                hits |= least >= FACE_CLOSE ? 1 << i : 0;
                close |= abs(least) < FACE_CLOSE ? 1 << i : 0;
            }
            for (; close != 0; close &= close - 1) {
                int i = findLSB(close);
                bool hit = tile_decides(tile, point, seen, block + ivec2(i % BLOCK, i / BLOCK));
                hits |= hit ? 1 << i : 0;
            }
            [[unroll]] for (int i = 0; i < BLOCK * BLOCK; ++i) {
                float near = face_product(seen.plane, tile_at(tile, block + ivec2(i % BLOCK, i / BLOCK)));
                bool nearer = (hits & 1 << i) != 0 && near > nearness[i];
                nearness[i] = nearer ? near : nearness[i];
                names[i] = nearer ? seen.name : names[i];
            }
        }
    }
    [[unroll]] for (int i = 0; i < BLOCK * BLOCK; ++i) {
        int place = (block.y + i / BLOCK) * TILE + block.x + i % BLOCK;
        uint bits = floatBitsToUint(nearness[i]);
        if (bits > tile_nearness[place]) {
            tile_nearness[place] = bits;
            tile_name[place] = names[i];
        }
    }
    bool met = tile_met != 0u;
    barrier();
    return met;
}

#endif
