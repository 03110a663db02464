#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Renders to a vertex array as the papers did: each pixel of a packed rectangle is one vertex, row after row; the
// image is then copied into the vertex buffer.

#include "relight/colour.glsl"

// Pixels in a row of the packed rectangle; the host's constant of the same name.
#define RECTANGLE_WIDTH 1024u

layout(location = 0) out vec4 colour;

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint vertex = (pixel.y - chunk.first_row) * RECTANGLE_WIDTH + pixel.x;
    colour = vertex < chunk.vertex_count ? vec4(relight_colour(vertex), 1.0) : vec4(0.0);
}
