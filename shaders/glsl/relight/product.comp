#version 460
#extension GL_GOOGLE_include_directive : require
// SH products of many pairs, order n in and order n out (Sun 2008, eq. 5.8): the sparse tensor that the per-vertex
// kernels read, alone. One workgroup row a pair, one invocation a coefficient.
//
// ORDER  1-6

#define COEFFICIENTS (ORDER * ORDER)
#define TENSOR_BINDING 0
#include "relight/tensor.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 1) readonly buffer Left {
    float values[];
} left;

layout(std430, set = 0, binding = 2) readonly buffer Right {
    float values[];
} right;

uint product_base; // where the pair's vectors start
#define SH_LEFT(j) left.values[product_base + (j)]
#define SH_RIGHT(k) right.values[product_base + (k)]
#include "common/sh_product.glsl"

layout(std430, set = 0, binding = 3) buffer Product {
    float values[];
} product;

void main()
{
    uint i = gl_LocalInvocationID.x;
    if (i >= uint(COEFFICIENTS)) { return; }
    product_base = gl_WorkGroupID.x * uint(COEFFICIENTS);
    product.values[product_base + i] = sh_product(i);
}
