#version 460
#extension GL_GOOGLE_include_directive : require
// Incident radiance with shadow in it, SH RGB for each vertex: the light times the visibility, M_l v
// (Sun 2008, section 5.2.1), for shaders that need its direction. Where both visibilities are there, v is their
// SH product.
//
// SOURCE_STATIC: baked visibility; SOURCE_DYNAMIC: dynamic visibility; SOURCE_BOTH: their product

#ifdef SOURCE_DYNAMIC
#include "relight/chunk.glsl"
#else
#include "relight/transfer.glsl"
#endif
#ifndef SOURCE_STATIC
#include "relight/visibility.glsl"
#endif
#ifdef LIGHT_UNIFORM
#include "relight/product_matrix.glsl"
#else
#include "relight/light.glsl"
#endif
#if defined(LIGHT_VERTEX) || defined(SOURCE_BOTH)
#define TENSOR_BINDING 5
#include "relight/tensor.glsl"
#endif

#ifdef SOURCE_BOTH
uint product_vertex; // the vertex whose product is made
#define SH_LEFT(j) transfer_coefficient(product_vertex, j)
#define SH_RIGHT(k) visibility_coefficient(product_vertex, k)
#include "common/sh_product.glsl"
#endif

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) buffer Incident {
    float values[]; // three floats a coefficient, one vertex after another
} incident;

// The visibility vector of this invocation's vertex.
float seen[COEFFICIENTS];

void load_visibility(uint vertex)
{
#ifdef SOURCE_BOTH
    product_vertex = vertex;
#endif
    for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
#ifdef SOURCE_STATIC
        seen[i] = transfer_coefficient(vertex, i);
#elif defined(SOURCE_DYNAMIC)
        seen[i] = visibility_coefficient(vertex, i);
#else
        seen[i] = sh_product(i);
#endif
    }
}

vec3 incident_coefficient(uint vertex, uint i)
{
    vec3 sum = vec3(0.0);
#ifdef LIGHT_UNIFORM
    for (uint j = 0u; j < uint(COEFFICIENTS); ++j) {
        uint row = max(i, j);
        sum = fma(vec3(seen[j]), product_matrix.lower[row * (row + 1u) / 2u + min(i, j)].rgb, sum);
    }
#else
    for (uint at = tensor.first[i]; at < tensor.first[i + 1u]; ++at) {
        TensorEntry entry = tensor.entries[at];
        float weight = entry.gamma * seen[entry.pair >> 16u];
        sum = fma(vec3(weight), light_coefficient(vertex, entry.pair & 0xffffu), sum);
    }
#endif
    return sum;
}

void main()
{
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= chunk.vertex_count) { return; }
    load_visibility(vertex);
    for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
        vec3 value = incident_coefficient(vertex, i);
        uint at = 3u * (vertex * uint(COEFFICIENTS) + i);
        incident.values[at] = value.r;
        incident.values[at + 1u] = value.g;
        incident.values[at + 2u] = value.b;
    }
}
