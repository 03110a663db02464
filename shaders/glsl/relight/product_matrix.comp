#version 460
#extension GL_GOOGLE_include_directive : require
// The product matrix of each instance's light (Sun 2008, eq. 5.10): (M_l)_ij = sum over k of Gamma_ijk l_k, its
// lower triangle by rows. One invocation an element, one workgroup row an instance.
//
// ORDER  1-6

#define COEFFICIENTS (ORDER * ORDER)
#define ELEMENTS (COEFFICIENTS * (COEFFICIENTS + 1) / 2)
#define TENSOR_BINDING 0
#include "relight/tensor.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 1) readonly buffer Lights {
    vec4 coefficients[];
} lights;

layout(std430, set = 0, binding = 2) buffer Matrices {
    vec4 lower[];
} matrices;

// Distances between two instances, in vec4.
layout(push_constant) uniform Strides {
    uint light;
    uint matrix;
} strides;

void main()
{
    uint element = gl_GlobalInvocationID.x;
    uint instance = gl_WorkGroupID.y;
    if (element >= uint(ELEMENTS)) { return; }
    uint row = 0u;
    uint column = element;
    while (column > row) {
        ++row;
        column -= row;
    }
    vec3 sum = vec3(0.0);
    for (uint at = tensor.first[row]; at < tensor.first[row + 1u]; ++at) {
        TensorEntry entry = tensor.entries[at];
        if ((entry.pair & 0xffffu) == column) {
            sum = fma(vec3(entry.gamma), lights.coefficients[instance * strides.light + (entry.pair >> 16u)].rgb, sum);
        }
    }
    matrices.lower[instance * strides.matrix + element] = vec4(sum, 0.0);
}
