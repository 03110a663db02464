#version 460
#extension GL_GOOGLE_include_directive : require
// The background: one triangle over the whole view at the far plane, with the direction of each pixel.

#include "host/frame.glsl"

layout(location = 0) out vec3 direction;

void main()
{
    vec2 corner = vec2(float((gl_VertexIndex << 1) & 2), float(gl_VertexIndex & 2));
    vec2 position = 2.0 * corner - 1.0;
    gl_Position = vec4(position, 1.0, 1.0);
    vec4 near = frame.direction_from_clip * vec4(position, 0.0, 1.0);
    direction = near.xyz / near.w;
}
