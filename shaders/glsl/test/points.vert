// Draws vertex i as a point on pixel i of a rectangle, with its colour from the vertex buffer.
#version 460
layout(location = 0) in vec4 colour;
layout(location = 0) flat out vec4 shaded;
layout(push_constant) uniform Settings { uvec2 size; } settings;

void main() {
    uvec2 pixel = uvec2(uint(gl_VertexIndex) % settings.size.x, uint(gl_VertexIndex) / settings.size.x);
    gl_Position = vec4((vec2(pixel) + 0.5) / vec2(settings.size) * 2.0 - 1.0, 0.0, 1.0);
    gl_PointSize = 1.0;
    shaded = colour;
}
