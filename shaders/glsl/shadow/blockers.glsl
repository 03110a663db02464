// The spheres of a group of receivers, and what they leave one receiver to see: the part that kernels over vertices and
// over pixels share.
//
// The includer defines ORDER, EXPONENTIAL and, for receivers on surfaces, NORMALS, and declares `settings` with `count`, the
// number of nodes.

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

// Band factors over the square of the sine, at TABLE steps of the cosine from 0 to 1, and their growth to the next step:
// sixteen bits each, in as many bytes.
#if ORDER > 4
const uint TABLE = 512u;
#else
const uint TABLE = 1024u;
#endif
layout(std140, set = 0, binding = 3) uniform Factors {
    uvec4 values[1024];
} factors;

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

shared uint chosen[MOST_NODES / 32u];

// The largest height that a sphere may have as a cap from somewhere in a bound.
float largest_height(vec4 sphere, vec4 bound)
{
    vec3 nearest = vec3(max(length(sphere.xyz - bound.xyz) - bound.w, 0.0), 0.0, 0.0);
    float sine2 = shadow_cap(nearest, sphere.w, vec3(0.0)).w;
    return sine2 / (1.0 + sqrt(1.0 - sine2));
}

// Chooses the cut of the hierarchy: nodes that stand for themselves below nodes that do not. A node lies within the one
// that holds it, so that none below a node that stands is taken by looking at its holder alone. One bit a node.
void choose(uint lane, vec4 bound, float reach, float cut)
{
    if (lane < MOST_NODES / 32u) { chosen[lane] = 0u; }
    barrier();
    for (uint at = lane; at < settings.count; at += 64u) {
        vec4 sphere = spheres.values[at];
        vec4 node = nodes.values[at];
        float height = sphere.w > 0.0 ? largest_height(sphere, bound) : -1.0;
        bool taken = height >= reach && (node.z == 0.0 || height < cut);
        if (taken && node.y >= 0.0) { taken = largest_height(spheres.values[uint(node.y)], bound) >= cut; }
        if (taken) { atomicOr(chosen[at / 32u], 1u << (at % 32u)); }
    }
    barrier();
}

// Coefficients of a cap, axis and square of the sine, by the table.
void cap_coefficients(vec4 cap, float share, out float f[COUNT])
{
    float place = sqrt(1.0 - cap.w) * float(TABLE);
    uint entry = min(uint(place), TABLE - 1u);
    float t = place - float(entry);
    float scale = share * cap.w;
#if ORDER > 4
    uvec4 values = factors.values[2u * entry];
    uvec4 growth = factors.values[2u * entry + 1u];
    vec2 first = scale * (unpackHalf2x16(values.x) + t * unpackHalf2x16(growth.x));
    vec2 second = scale * (unpackHalf2x16(values.y) + t * unpackHalf2x16(growth.y));
    vec2 third = scale * (unpackHalf2x16(values.z) + t * unpackHalf2x16(growth.z));
#else
    uvec4 values = factors.values[entry];
    vec2 first = scale * (unpackHalf2x16(values.x) + t * unpackHalf2x16(values.z));
    vec2 second = scale * (unpackHalf2x16(values.y) + t * unpackHalf2x16(values.w));
#endif
    sh_evaluate(cap.xyz, f);
    f[0] *= first.x;
    for (int i = 1; i < 4; ++i) { f[i] *= first.y; }
    for (int i = 4; i < 9; ++i) { f[i] *= second.x; }
#if ORDER > 3
    for (int i = 9; i < 16; ++i) { f[i] *= second.y; }
#endif
#if ORDER > 4
    for (int i = 16; i < 25; ++i) { f[i] *= third.x; }
#endif
#if ORDER > 5
    for (int i = 25; i < 36; ++i) { f[i] *= third.y; }
#endif
}

// Adds the logarithms of the chosen nodes, or multiplies by their visibility; how many there are.
uint accumulate(vec3 place, vec3 normal, inout float sum[COUNT])
{
    uint here = 0u;
    for (uint word = 0u; 32u * word < settings.count; ++word) {
        uint bits = chosen[word];
        here += uint(bitCount(bits));
        while (bits != 0u) {
            uint at = 32u * word + uint(findLSB(bits));
            bits &= bits - 1u;
            vec4 sphere = spheres.values[at];
            float share = nodes.values[at].x;
#ifdef NORMALS
            float above;
            sphere = shadow_above(sphere, place, normal, above);
            share *= above;
#endif
            float term[COUNT];
            cap_coefficients(shadow_cap(sphere.xyz, sphere.w, place), share, term);
#if EXPONENTIAL == 7
            term[0] += ONE;
            float product[COUNT];
            sh_product(sum, term, product);
            sum = product;
#else
            EACH(i) { sum[i] += term[i]; }
#endif
        }
    }
    return here;
}

#endif
