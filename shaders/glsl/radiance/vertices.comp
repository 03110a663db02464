#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Light vectors of vertices from the samples whose domains hold them, as passes/radiance/src/reconstruct.rs has them:
// weights ((R - d) / (R d))^2 of the nodes not split (Franke and Nielson, "Smooth Interpolation of Large Sets of Scattered
// Data", 1980), each sample continued to first order (Annen, Kautz, Durand, Seidel, "Spherical Harmonic Gradients for
// Mid-Range Illumination", 2004). Samples are found by a walk of the tree itself.
//
// ORDER      3 to 6
// GRADIENTS  0 or 1: samples are continued by their gradients
// ROTATE     0 or 1: the result is turned into the space of an instance

#include "radiance/sample.glsl"
#include "radiance/tree.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Tree { Node nodes[]; } tree;
layout(std430, set = 0, binding = 1) readonly buffer Slots { uint values[]; } slots;
layout(std430, set = 0, binding = 2) readonly buffer Places { uint values[]; } places;
layout(std430, set = 0, binding = 3) readonly buffer Lights { vec4 values[]; } lights;
layout(std430, set = 0, binding = 4) readonly buffer State {
    Batch batch;
    uint taken;
} state;
layout(std430, set = 0, binding = 5) readonly buffer Positions { float values[]; } positions;
layout(std430, set = 0, binding = 6) buffer VertexLight { float values[]; } vertex_light;
// Light from far away, about the axes of the samples, which each vertex gets as well.
layout(std140, set = 0, binding = 7) uniform Distant { vec4 values[COEFFICIENTS]; } distant;
#if GRADIENTS
layout(std430, set = 0, binding = 8) readonly buffer Gradients { vec4 values[]; } gradients;
#endif
#if ROTATE
// Band after band, row-major.
layout(std430, set = 0, binding = 9) readonly buffer Rotation { float values[]; } rotation;
#endif

layout(push_constant) uniform Settings {
    uint vertices;
    uint nodes;
    float overlap; // domains over reach
    float trust; // of the distance of the light: how far a sample is continued
    float largest; // domain there can be, metres
} settings;

struct Sum {
    vec3 values[COEFFICIENTS];
    float weight;
};

void add(inout Sum sum, uint sampled, float weight, vec3 offset)
{
    uint first = sampled * uint(LIGHT_STRIDE);
    sum.weight += weight;
#if GRADIENTS
    vec4 extent = lights.values[first + uint(LIGHT_EXTENT)];
    float far = length(offset);
    // Without light the distance is infinite, and so are the steps allowed.
    float most = extent.y > 0.0 ? settings.trust * (extent.x / extent.y) : far;
    vec3 step_ = far > most ? offset * (most / far) : offset;
    uint slope = sampled * uint(GRADIENT_STRIDE);
    [[unroll]] for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
        uint at = slope + 3u * i;
        vec3 change = gradients.values[at].rgb * step_.x + gradients.values[at + 1u].rgb * step_.y
            + gradients.values[at + 2u].rgb * step_.z;
        sum.values[i] += weight * (lights.values[first + i].rgb + change);
    }
#else
    [[unroll]] for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
        sum.values[i] += weight * lights.values[first + i].rgb;
    }
#endif
}

// In units in which the largest domain is 1, so that no distance is too small for a float.
float domain_weight(float away, float radius)
{
    float near = max(away / settings.largest, 1e-6);
    float edge = radius / settings.largest;
    if (edge <= 1e-6) { return 1e12; } // a domain of one point: the vertex itself
    float weight = max((edge - near) / (edge * near), 0.0);
    return weight * weight;
}

void main()
{
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= settings.vertices) { return; }
    vec3 point = vec3(
        positions.values[3u * vertex], positions.values[3u * vertex + 1u], positions.values[3u * vertex + 2u]);
    Sum sum;
    [[unroll]] for (uint i = 0u; i < uint(COEFFICIENTS); ++i) { sum.values[i] = vec3(0.0); }
    sum.weight = 0.0;
    for (uint i = 0u; i < settings.nodes;) {
        Node node = tree.nodes[i];
        vec3 offset = point - node.mean;
        float away = length(offset);
        uint behind = i + nodes_with_and_below(node);
        if (away > node.bound || node.weight < 0.0) {
            i = behind;
            continue;
        }
        // A slot that nobody wrote may hold anything; the sample it names tells.
        uint sampled = slots.values[i];
        if (sampled >= state.taken || places.values[sampled] != i) {
            ++i;
            continue;
        }
        float radius = settings.overlap * node.reach;
        if (away <= radius) { add(sum, sampled, domain_weight(away, radius), offset); }
        i = behind;
    }
    float scale = sum.weight > 0.0 ? 1.0 / sum.weight : 0.0;
    [[unroll]] for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
        sum.values[i] = sum.values[i] * scale + distant.values[i].rgb;
    }
    uint at = 3u * uint(COEFFICIENTS) * vertex;
#if ROTATE
    [[unroll]] for (int l = 0; l < ORDER; ++l) {
        int side = 2 * l + 1;
        int matrix = l * (4 * l * l - 1) / 3;
        for (int row = 0; row < side; ++row) {
            vec3 turned = vec3(0.0);
            [[unroll]] for (int column = 0; column < side; ++column) {
                turned += rotation.values[matrix + row * side + column] * sum.values[l * l + column];
            }
            uint to = at + 3u * uint(l * l + row);
            vertex_light.values[to] = turned.r;
            vertex_light.values[to + 1u] = turned.g;
            vertex_light.values[to + 2u] = turned.b;
        }
    }
#else
    [[unroll]] for (uint i = 0u; i < uint(COEFFICIENTS); ++i) {
        vertex_light.values[at + 3u * i] = sum.values[i].r;
        vertex_light.values[at + 3u * i + 1u] = sum.values[i].g;
        vertex_light.values[at + 3u * i + 2u] = sum.values[i].b;
    }
#endif
}
