// The colour of a vertex: t_p . l (Sloan 2002), or with a dynamic visibility vector the triple product
// <t_p, l, v> = v^T M_l t_p (Sun 2008, section 5.2.1). Both methods of rendering to a vertex array call this one
// function; explicit fma and a fixed order keep their bits equal.
//
// VISIBILITY 0: none, 1: a dynamic visibility vector for each vertex
// STORAGE_NORMALS  transfer of the current normals; otherwise baked, see transfer.glsl

#ifdef STORAGE_NORMALS
#include "relight/normals.glsl"
#else
#include "relight/transfer.glsl"
#endif

#if VISIBILITY == 0

#include "relight/light.glsl"

// Adds the terms of one block of four coefficients; `light` is zero past the last.
vec3 add_block(vec3 colour, vec4 t, vec3 light[4])
{
    precise vec3 sum = colour;
    sum = fma(vec3(t.x), light[0], sum);
    sum = fma(vec3(t.y), light[1], sum);
    sum = fma(vec3(t.z), light[2], sum);
    sum = fma(vec3(t.w), light[3], sum);
    return sum;
}

void light_block(uint vertex, uint block, out vec3 light[4])
{
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        uint index = 4u * block + i;
        light[i] = index < uint(COEFFICIENTS) ? light_coefficient(vertex, min(index, uint(COEFFICIENTS - 1))) : vec3(0.0);
    }
}

vec3 relight_colour(uint vertex)
{
    load_transfer(vertex);
    vec3 sum = vec3(0.0);
    [[unroll]] for (uint block = 0u; block < uint(BLOCKS); ++block) {
        vec3 light[4];
        light_block(vertex, block, light);
        sum = add_block(sum, transfer_block(vertex, block), light);
    }
    return sum;
}

#elif defined(LIGHT_UNIFORM)

#include "relight/visibility.glsl"
#include "relight/product_matrix.glsl"

vec3 relight_colour(uint vertex)
{
    load_transfer(vertex);
    precise vec3 sum = vec3(0.0);
    uint at = 0u;
    for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
        float t_i = transfer_coefficient(vertex, i);
        float v_i = visibility_coefficient(vertex, i);
        for (uint j = 0u; j < i; ++j) {
            precise float pair = fma(t_i, visibility_coefficient(vertex, j), transfer_coefficient(vertex, j) * v_i);
            sum = fma(vec3(pair), product_matrix.lower[at].rgb, sum);
            ++at;
        }
        precise float square = t_i * v_i;
        sum = fma(vec3(square), product_matrix.lower[at].rgb, sum);
        ++at;
    }
    return sum;
}

#else

#include "relight/light.glsl"
#include "relight/visibility.glsl"
#define TENSOR_BINDING 4
#include "relight/tensor.glsl"

uint product_vertex; // the vertex whose product is made
#define SH_LEFT(j) transfer_coefficient(product_vertex, j)
#define SH_RIGHT(k) visibility_coefficient(product_vertex, k)
#include "common/sh_product.glsl"

vec3 relight_colour(uint vertex)
{
    product_vertex = vertex;
    load_transfer(vertex);
    precise vec3 sum = vec3(0.0);
    for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
        sum = fma(vec3(sh_product(i)), light_coefficient(vertex, i), sum);
    }
    return sum;
}

#endif
