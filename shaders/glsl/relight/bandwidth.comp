#version 460
#extension GL_GOOGLE_include_directive : require
// Rival for the report: reads the same transfer words and writes the same colours with no light and next to no
// arithmetic, so that the time of the colour kernel can be set against moving its bytes.

#include "relight/transfer.glsl"

layout(local_size_x = WORKGROUP) in;

layout(std430, set = 0, binding = 1) buffer Colours {
    vec4 values[];
} colours;

void main()
{
    uint vertex = gl_WorkGroupID.x * uint(WORKGROUP * VERTICES) + gl_LocalInvocationID.x;
    for (uint k = 0u; k < uint(VERTICES); ++k) {
        if (vertex < chunk.vertex_count) {
            vec4 sum = vec4(0.0);
            for (uint block = 0u; block < uint(BLOCKS); ++block) { sum += transfer_block(vertex, block); }
            colours.values[vertex] = sum;
        }
        vertex += uint(WORKGROUP);
    }
}
