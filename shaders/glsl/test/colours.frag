// The same colours as colours.comp, one per pixel of a packed rectangle: the fragment half of "render to a vertex array".
#version 460
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 1, std140) uniform Tint { vec4 tint; };
layout(push_constant) uniform Settings { uint count; uint width; } settings;

void main() {
    uint i = uint(gl_FragCoord.y) * settings.width + uint(gl_FragCoord.x);
    float t = float(i) / float(settings.count);
    colour = vec4(t, 1.0 - t, sin(6.0 * t), 1.0) * tint;
}
