#version 460
#extension GL_GOOGLE_include_directive : require
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

void main()
{
    uint vertex = gl_WorkGroupID.x * uint(WORKGROUP * VERTICES) + gl_LocalInvocationID.x;
    for (uint k = 0u; k < uint(VERTICES); ++k) {
        if (vertex < chunk.vertex_count) { colours.values[vertex] = vec4(relight_colour(vertex), 1.0); }
        vertex += uint(WORKGROUP);
    }
}
