#version 460
#extension GL_GOOGLE_include_directive : require
// The tiles of a kind: an instance each, with the lights that may be seen in it.
//
// FOG_DARK 1: for tiles without a light

#include "fog/frame.glsl"

layout(location = 0) in uvec4 tile; // column and row; a bit for each light

#if !FOG_DARK
layout(location = 0) flat out uvec2 lights;
#endif

void main()
{
    // Two triangles: 0 1 2, 2 1 3.
    int corner = gl_VertexIndex < 3 ? gl_VertexIndex : gl_VertexIndex == 3 ? 2 : gl_VertexIndex == 4 ? 1 : 3;
    vec2 pixel = fog.start[1].w * vec2(tile.xy + uvec2(corner & 1, corner >> 1));
#if !FOG_DARK
    lights = tile.zw;
#endif
    gl_Position = vec4(2.0 * pixel / vec2(fog.size) - 1.0, 0.0, 1.0);
}
