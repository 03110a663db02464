#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Renders to a vertex array by compute: one colour for each vertex of a chunk, written where the vertex input of
// the host's draw reads it.
//
// WORKGROUP  invocations in a workgroup
// VERTICES   vertices of one invocation, a workgroup apart

#include "relight/colour.glsl"

layout(local_size_x = WORKGROUP) in;

layout(std430, set = 0, binding = 2) buffer Colours {
    vec4 values[];
} colours;

#if VERTICES == 1

void main()
{
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex < chunk.vertex_count) { colours.values[vertex] = vec4(relight_colour(vertex), 1.0); }
}

#else

// One light for all: each of its coefficients is loaded once for several vertices.
void main()
{
    uint first = gl_WorkGroupID.x * uint(WORKGROUP * VERTICES) + gl_LocalInvocationID.x;
    uint last = chunk.vertex_count - 1u;
    vec3 sums[VERTICES];
    [[unroll]] for (uint k = 0u; k < uint(VERTICES); ++k) { sums[k] = vec3(0.0); }
    [[unroll]] for (uint block = 0u; block < uint(BLOCKS); ++block) {
        vec3 light[4];
        light_block(0u, block, light);
        [[unroll]] for (uint k = 0u; k < uint(VERTICES); ++k) {
            uint vertex = min(first + k * uint(WORKGROUP), last);
            sums[k] = add_block(sums[k], transfer_block(vertex, block), light);
        }
    }
    [[unroll]] for (uint k = 0u; k < uint(VERTICES); ++k) {
        uint vertex = first + k * uint(WORKGROUP);
        if (vertex <= last) { colours.values[vertex] = vec4(sums[k], 1.0); }
    }
}

#endif
