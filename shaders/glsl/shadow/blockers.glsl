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
layout(std430, set = 0, binding = 7) readonly buffer Table {
    float values[];
} table;
#define SHADOW_TABLE(at) table.values[at]
#ifndef SHADOW_TABLE_END
#define SHADOW_TABLE_END settings.end
#endif
#endif

#include "common/sh_basis.glsl"
#include "shadow/cap.glsl"
#include "shadow/exponential.glsl"

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
    for (uint at = lane; at < settings.count; at += 64u / uint(RECEIVERS)) {
        vec4 sphere = spheres.values[at];
        vec4 node = nodes.values[at];
        float sine2 = largest_square(sphere, bound);
        float height = height_of(sine2);
        float weight = node.z == 0.0 ? 1.0 : 1.0 - gives_way(height, cut);
        if (node.y >= 0.0) {
            float holder = height_of(largest_square(spheres.values[uint(node.y)], bound));
            weight -= 1.0 - gives_way(max(holder, height), cut);
        }
        if (weight > 0.0 && sphere.w > 0.0 && height >= reach) {
#if EXPONENTIAL < 7
            uint kind = weight == 1.0 && sine2 < factors.least.x ? SMALL : LARGE;
#else
            uint kind = SMALL;
#endif
            weights[at] = weight;
            atomicOr(chosen[kind][at / 32u], 1u << (at % 32u));
            atomicMax(words[kind], at / 32u + 1u);
        }
    }
    barrier();
}

// Over the coefficients i of a band, with bounds that a compiler sees.
#define BAND(l, begin, end, statement) for (int i = begin; i < end; ++i) { statement(i, l) }
#if ORDER > 3
#define BAND3(statement) BAND(3, 9, 16, statement)
#else
#define BAND3(statement)
#endif
#if ORDER > 4
#define BAND4(statement) BAND(4, 16, 25, statement)
#else
#define BAND4(statement)
#endif
#if ORDER > 5
#define BAND5(statement) BAND(5, 25, 36, statement)
#else
#define BAND5(statement)
#endif
#define EACH_BAND(statement)                                                                                            \
    BAND(0, 0, 1, statement) BAND(1, 1, 4, statement) BAND(2, 4, 9, statement) BAND3(statement) BAND4(statement)        \
    BAND5(statement)

#if EXPONENTIAL < 7
// Band factors of the logarithm of a small cap, by the square of its sine.
void small_factors(vec4 polynomials[ORDER], float square, float scale, out float bands[ORDER])
{
    for (int l = 0; l < ORDER; ++l) {
        vec4 c = polynomials[l];
        bands[l] = scale * (c.x + square * (c.y + square * (c.z + square * c.w)));
    }
}

// The same of any cap, by the table.
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
#else
// Band factors of the visibility of a cap less 1 (Sun 2008, equation 5.36).
void visibility_factors(float square, float scale, out float bands[ORDER])
{
    const float TWO_PI = 6.28318530717959;
    float c = sqrt(1.0 - square);
    float c2 = c * c;
    scale *= -TWO_PI;
    bands[0] = scale / (1.0 + c);
    bands[1] = scale * 0.5;
    bands[2] = scale * (0.5 * c);
#if ORDER > 3
    bands[3] = scale * (0.625 * c2 - 0.125);
#endif
#if ORDER > 4
    bands[4] = scale * (c * (0.875 * c2 - 0.375));
#endif
#if ORDER > 5
    bands[5] = scale * (c2 * (1.3125 * c2 - 0.875) + 0.0625);
#endif
}
#endif

// Small caps that are taken up at once, so that the sums are read and written less often.
const int TURNS = 2;

// A point of a surface.
struct Receiver {
    vec3 place;
    vec3 normal; // of length 1; with NORMALS
};

// What a sphere leaves one receiver: its logarithm, or its visibility less 1.
void cap_term(uint kind, vec4 sphere, float share, Receiver receiver, vec4 polynomials[ORDER], out float term[COUNT])
{
#ifdef NORMALS
    float above;
    sphere = shadow_above(sphere, receiver.place, receiver.normal, above);
    share *= above;
#endif
    vec4 cap = shadow_cap(sphere.xyz, sphere.w, receiver.place);
    float bands[ORDER];
#if EXPONENTIAL == 7
    visibility_factors(cap.w, share * cap.w, bands);
#else
    if (kind == SMALL) {
        small_factors(polynomials, cap.w, share * cap.w, bands);
    } else {
        large_factors(cap.w, share * cap.w, bands);
    }
#endif
    sh_evaluate(cap.xyz, term);
#define SCALED(i, l) term[i] *= bands[l];
    EACH_BAND(SCALED)
}

// Adds the logarithms of the chosen nodes of a kind, or multiplies by their visibility; how many there are.
uint accumulate_kind(uint kind, Receiver receivers[RECEIVERS], inout float sums[RECEIVERS][COUNT])
{
    uint here = 0u;
    vec4 polynomials[ORDER];
#if EXPONENTIAL < 7
    // Read once: to some drivers a uniform costs as much as a sphere.
    for (int l = 0; l < ORDER; ++l) { polynomials[l] = factors.small[l]; }
#endif
    for (uint word = 0u; word < words[kind]; ++word) {
        uint bits = chosen[kind][word];
        here += uint(bitCount(bits));
        while (bits != 0u) {
            int turns = kind == SMALL && EXPONENTIAL < 7 ? TURNS : 1;
            vec4 taken[TURNS];
            float shares[TURNS];
            for (int turn = 0; turn < turns; ++turn) {
                // Past the last one: any, of no share.
                uint at = 32u * word + (uint(findLSB(bits)) & 31u);
                taken[turn] = spheres.values[at];
                shares[turn] = bits != 0u ? nodes.values[at].x : 0.0;
                if (kind == LARGE) { shares[turn] *= weights[at]; }
                bits &= bits - 1u;
            }
            for (int r = 0; r < RECEIVERS; ++r) {
                float together[COUNT];
                cap_term(kind, taken[0], shares[0], receivers[r], polynomials, together);
#if EXPONENTIAL == 7
                together[0] += ONE;
                float product[COUNT];
                sh_product(sums[r], together, product);
                sums[r] = product;
#else
                for (int turn = 1; turn < turns; ++turn) {
                    float term[COUNT];
                    cap_term(kind, taken[turn], shares[turn], receivers[r], polynomials, term);
                    EACH(i) { together[i] += term[i]; }
                }
                EACH(i) { sums[r][i] += together[i]; }
#endif
            }
        }
    }
    return here;
}

// The same of all kinds.
uint accumulate(Receiver receivers[RECEIVERS], inout float sums[RECEIVERS][COUNT])
{
    uint here = accumulate_kind(SMALL, receivers, sums);
#if EXPONENTIAL < 7
    here += accumulate_kind(LARGE, receivers, sums);
#endif
    return here;
}

#endif
