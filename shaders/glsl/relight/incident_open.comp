#version 460
#extension GL_GOOGLE_include_directive : require
// Incident radiance of a mesh that nothing shadows, neither baked nor dynamic: the visibility is 1 everywhere, so
// it is the light itself, handed to each vertex as incident.comp does.

#include "relight/chunk.glsl"
#include "relight/light.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) buffer Incident {
    float values[]; // three floats a coefficient, one vertex after another
} incident;

void main()
{
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= chunk.vertex_count) { return; }
    for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
        vec3 value = light_coefficient(vertex, i);
        uint at = 3u * (vertex * uint(COEFFICIENTS) + i);
        incident.values[at] = value.r;
        incident.values[at + 1u] = value.g;
        incident.values[at + 2u] = value.b;
    }
}
