#version 460
#extension GL_GOOGLE_include_directive : require
// Turns the light vectors of vertices, band by band, into the space of an instance.
//
// ORDER  3 to 6

#include "radiance/sample.glsl"

layout(local_size_x = 64) in;

// Band after band, row-major.
layout(std430, set = 0, binding = 0) readonly buffer Rotation { float values[]; } rotation;
layout(std430, set = 0, binding = 1) buffer VertexLight { float values[]; } vertex_light;

layout(push_constant) uniform Settings {
    uint count; // vertices
} settings;

void main()
{
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= settings.count) { return; }
    for (int l = 1; l < ORDER; ++l) {
        int side = 2 * l + 1;
        int matrix = l * (4 * l * l - 1) / 3;
        uint band = 3u * (uint(COEFFICIENTS) * vertex + uint(l * l));
        vec3 values[2 * ORDER - 1];
        for (int i = 0; i < side; ++i) {
            uint at = band + 3u * uint(i);
            values[i] = vec3(vertex_light.values[at], vertex_light.values[at + 1u], vertex_light.values[at + 2u]);
        }
        for (int row = 0; row < side; ++row) {
            vec3 turned = vec3(0.0);
            for (int i = 0; i < side; ++i) { turned += rotation.values[matrix + row * side + i] * values[i]; }
            uint at = band + 3u * uint(row);
            vertex_light.values[at] = turned.r;
            vertex_light.values[at + 1u] = turned.g;
            vertex_light.values[at + 2u] = turned.b;
        }
    }
}
