#version 460
// Triangles of a user interface, in points from the upper left corner of the window.

layout(location = 0) in vec2 position; // points
layout(location = 1) in vec2 texture_coordinates;
layout(location = 2) in vec4 colour; // sRGB-encoded, multiplied by alpha

layout(push_constant) uniform Window {
    vec2 size;           // points
    uint decoded;        // 1 where the window encodes what is written
} window;

layout(location = 0) out vec2 place;
layout(location = 1) out vec4 tint;

void main()
{
    place = texture_coordinates;
    tint = colour;
    gl_Position = vec4(2.0 * position / window.size - 1.0, 0.0, 1.0);
}
