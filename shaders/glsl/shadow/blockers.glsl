// The spheres of a group of receivers, and what they leave each to see: the part that kernels over vertices and over pixels
// share.
//
// The includer defines ORDER, EXPONENTIAL, RECEIVERS, that a lane holds, and, for receivers on surfaces, NORMALS, and declares
// `settings` with `count`, the number of nodes. A workgroup has 64 receivers.

#ifndef SHADOW_BLOCKERS_GLSL
#define SHADOW_BLOCKERS_GLSL

// As many as the smallest uniform range of any device holds.
const uint MOST_NODES = 1024u;

// Object space, radius in w.
layout(std140, set = 0, binding = 2) uniform Spheres {
    vec4 values[1024];
} spheres;

// Of the hierarchy, by sphere: x the ratio its logarithm counts by; y the place of the node that holds it, -1 where none
// does; z 1 where it holds others.
layout(std140, set = 0, binding = 8) uniform Nodes {
    vec4 values[1024];
} nodes;

#if EXPONENTIAL < 7
// Band factors of the logarithm of a cap over the square of the sine: of small caps polynomials of that square, of
// large ones at TABLE steps of the cosine from 0 to 1, with their growth to the next step, sixteen bits each.
#if ORDER > 4
const uint TABLE = 508u;
#else
const uint TABLE = 1016u;
#endif
layout(std140, set = 0, binding = 3) uniform Factors {
    vec4 small[6];  // by band, growing powers
    vec4 least;     // x: the square of the sine from which on a cap is a large one
    uvec4 values[1017];
} factors;
#endif

#if EXPONENTIAL < 3
// The table of the exponential: polynomials, or the numbers of the optimal linear one.
layout(std140, set = 0, binding = 7) uniform Table {
    vec4 values[452];
} table;
#define SHADOW_TABLE(at) table.values[(at) / 4u][(at) % 4u]
#ifndef SHADOW_TABLE_END
#define SHADOW_TABLE_END settings.end
#endif
#endif

#include "shadow/cap.glsl"
#include "shadow/exponential.glsl"
#if EXPONENTIAL < 7
#include "shadow/sums.glsl"
#else
#include "common/sh_basis.glsl"
#endif

// By kind, one bit a node: small caps that count as they are, and others.
const uint SMALL = 0u;
const uint LARGE = 1u;
shared uint chosen[2][MOST_NODES / 32u];
// Of each kind, words up to the last that is not 0.
shared uint words[2];
// Of nodes that are not small: the share they count by.
shared float weights[MOST_NODES];

// The largest square of the sine that a sphere may have as a cap from somewhere in a bound.
float largest_square(vec4 sphere, vec4 bound)
{
    vec3 nearest = vec3(max(length(sphere.xyz - bound.xyz) - bound.w, 0.0), 0.0, 0.0);
    return shadow_cap(nearest, sphere.w, vec3(0.0)).w;
}

// The height of a cap.
float height_of(float sine2)
{
    return sine2 / (1.0 + sqrt(1.0 - sine2));
}

// How far a node of a height gives way to what it holds, from 0 to 1: from the cut on by and by, so that what moves does
// not step.
float gives_way(float height, float cut)
{
    return cut > 0.0 ? clamp((height / cut - 1.0) / 0.2, 0.0, 1.0) : 1.0;
}

// Chooses the cut of the hierarchy: nodes that stand for themselves below nodes that give way. A node lies within the one
// that holds it and is never higher, so that shares along every way down add up to 1 by looking at its holder alone.
void choose(uint lane, vec4 bound, float reach, float cut)
{
    if (lane < MOST_NODES / 32u) {
        chosen[SMALL][lane] = 0u;
        chosen[LARGE][lane] = 0u;
    }
    if (lane < 2u) { words[lane] = 0u; }
    barrier();
    // Loops end where they are asked to go on: a driver whose lanes all take every branch runs through the rest of a loop
    // that ends at its head once more.
    uint at = lane;
    do {
        uint place = min(at, MOST_NODES - 1u);
        vec4 sphere = spheres.values[place];
        vec4 node = nodes.values[place];
        float sine2 = largest_square(sphere, bound);
        float height = height_of(sine2);
        float weight = node.z == 0.0 ? 1.0 : 1.0 - gives_way(height, cut);
        if (node.y >= 0.0) {
            float holder = height_of(largest_square(spheres.values[uint(node.y)], bound));
            weight -= 1.0 - gives_way(max(holder, height), cut);
        }
        if (at < settings.count && weight > 0.0 && sphere.w > 0.0 && height >= reach) {
#if EXPONENTIAL < 7
            uint kind = weight == 1.0 && sine2 < factors.least.x ? SMALL : LARGE;
#else
            uint kind = SMALL;
#endif
            weights[at] = weight;
            atomicOr(chosen[kind][at / 32u], 1u << (at % 32u));
            atomicMax(words[kind], at / 32u + 1u);
        }
        at += 64u / uint(RECEIVERS);
    } while (at < settings.count);
    barrier();
}

// A point of a surface.
struct Receiver {
    vec3 place;
    vec3 normal; // of length 1; with NORMALS
};

// By bits: comparisons of what is no number are whatever a driver makes of them.
bool finite(vec4 v)
{
    return all(notEqual(floatBitsToUint(v) & 0x7f800000u, uvec4(0x7f800000u)));
}

#if EXPONENTIAL < 7
// Nodes that are taken up at once.
const int TURNS = 2;

// Adds the logarithms of two small caps, by polynomials of the square of the sine.
void add_small(vec4 a, vec4 b, vec2 shares, Receiver receiver, vec4 polynomials[ORDER], inout float sum[COUNT])
{
#ifdef NORMALS
    vec2 above;
    a = shadow_above(a, receiver.place, receiver.normal, above.x);
    b = shadow_above(b, receiver.place, receiver.normal, above.y);
    shares *= above;
#endif
    vec2 x = vec2(a.x, b.x) - receiver.place.x;
    vec2 y = vec2(a.y, b.y) - receiver.place.y;
    vec2 z = vec2(a.z, b.z) - receiver.place.z;
    // As shadow_cap, but for what small caps never are: around the receiver.
    vec2 radii = vec2(a.w, b.w) * vec2(a.w, b.w);
    vec2 inverse = inversesqrt(max(x * x + y * y + z * z, max(radii, vec2(1e-37))));
    vec2 square = radii * inverse * inverse;
    vec2 scale = shares * square;
    vec2 bands[ORDER];
    for (int l = 0; l < ORDER; ++l) {
        vec4 c = polynomials[l];
        bands[l] = scale * (c.x + square * (c.y + square * (c.z + square * c.w)));
    }
    sums_add(bands, inverse * x, inverse * y, inverse * z, sum);
}

// Band factors of the logarithm of any cap, by the table over the cosine.
void large_factors(float square, float scale, out float bands[ORDER])
{
    float place = sqrt(1.0 - square) * float(TABLE);
    uint entry = min(uint(place), TABLE - 1u);
    float t = place - float(entry);
#if ORDER > 4
    uvec4 values = factors.values[2u * entry];
    uvec4 growth = factors.values[2u * entry + 1u];
#else
    uvec4 values = factors.values[entry];
    uvec4 growth = uvec4(values.zw, 0u, 0u);
#endif
    for (int l = 0; l < ORDER; ++l) {
        vec2 here = unpackHalf2x16(values[l / 2]);
        vec2 more = unpackHalf2x16(growth[l / 2]);
        bands[l] = scale * (here[l % 2] + t * more[l % 2]);
    }
}

// Adds the logarithms of two caps of any size.
void add_large(vec4 a, vec4 b, vec2 shares, Receiver receiver, inout float sum[COUNT])
{
#ifdef NORMALS
    vec2 above;
    a = shadow_above(a, receiver.place, receiver.normal, above.x);
    b = shadow_above(b, receiver.place, receiver.normal, above.y);
    shares *= above;
#endif
    vec4 first = shadow_cap(a.xyz, a.w, receiver.place);
    vec4 second = shadow_cap(b.xyz, b.w, receiver.place);
    float of_first[ORDER];
    float of_second[ORDER];
    large_factors(first.w, shares.x * first.w, of_first);
    large_factors(second.w, shares.y * second.w, of_second);
    vec2 bands[ORDER];
    for (int l = 0; l < ORDER; ++l) { bands[l] = vec2(of_first[l], of_second[l]); }
    sums_add(bands, vec2(first.x, second.x), vec2(first.y, second.y), vec2(first.z, second.z), sum);
}

// Adds the logarithms of the chosen nodes of a kind; how many there are.
uint accumulate_kind(uint kind, Receiver receivers[RECEIVERS], inout float sums[RECEIVERS][COUNT])
{
    uint here = 0u;
    vec4 polynomials[ORDER];
    // Read once: to some drivers a uniform costs as much as a sphere.
    for (int l = 0; l < ORDER; ++l) { polynomials[l] = factors.small[l]; }
    uint word = 0u;
    uint at = 0u;
    do {
        uint bits = chosen[kind][word];
        here += uint(bitCount(bits));
        do {
            vec4 taken[TURNS];
            vec2 shares;
            for (int turn = 0; turn < TURNS; ++turn) {
                // Past the last one: the last one, of no share.
                bool there = bits != 0u;
                at = there ? 32u * word + uint(findLSB(bits)) : at;
                taken[turn] = spheres.values[at];
                shares[turn] = there ? nodes.values[at].x : 0.0;
                if (kind == LARGE) { shares[turn] *= there ? weights[at] : 0.0; }
                bits &= bits - 1u;
            }
            for (int r = 0; r < RECEIVERS; ++r) {
                if (kind == SMALL) {
                    add_small(taken[0], taken[1], shares, receivers[r], polynomials, sums[r]);
                } else {
                    add_large(taken[0], taken[1], shares, receivers[r], sums[r]);
                }
            }
        } while (bits != 0u);
        ++word;
    } while (word < words[kind]);
    return here;
}

// Sums of the logarithms of all chosen nodes; how many there are.
uint accumulate(Receiver receivers[RECEIVERS], out float sums[RECEIVERS][COUNT])
{
    for (int r = 0; r < RECEIVERS; ++r) {
        EACH(i) { sums[r][i] = 0.0; }
    }
    uint here = accumulate_kind(SMALL, receivers, sums);
    here += accumulate_kind(LARGE, receivers, sums);
    for (int r = 0; r < RECEIVERS; ++r) { sums_finish(sums[r]); }
    return here;
}
#else
#include "shadow/chained.glsl"
#endif

#endif
