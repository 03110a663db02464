// Passes the interpolated colour on.
#version 460
layout(location = 0) in vec4 shaded;
layout(location = 0) out vec4 colour;

void main() {
    colour = shaded;
}
