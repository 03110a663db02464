// Writes one colour per vertex into a vertex buffer: the compute half of "render to a vertex array".
#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) buffer Colours { vec4 colour[]; };
layout(set = 0, binding = 1, std140) uniform Tint { vec4 tint; };
layout(push_constant) uniform Settings { uint count; } settings;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= settings.count) return;
    float t = float(i) / float(settings.count);
    colour[i] = vec4(t, 1.0 - t, sin(6.0 * t), 1.0) * tint;
}
