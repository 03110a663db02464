#version 460
#extension GL_GOOGLE_include_directive : require
// Light vectors of vertices from the samples whose domains hold them, as passes/radiance/src/reconstruct.rs has them:
// weights ((R - d) / (R d))^2 of the nodes not split (Franke and Nielson, "Smooth Interpolation of Large Sets of Scattered
// Data", 1980), each sample continued to first order (Annen, Kautz, Durand, Seidel, "Spherical Harmonic Gradients for
// Mid-Range Illumination", 2004).
//
// A workgroup has 64 vertices that are near one another. One walk of the tree finds the samples for all of them; each
// vertex then takes from these a few coefficients at a time, which needs neither many registers nor long unrolled code.
//
// ORDER      3 to 6
// GRADIENTS  0 or 1: samples are continued by their gradients

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

struct Vertex {
    vec3 position; // metres
    uint place; // in the light that is written
};
layout(std430, set = 0, binding = 5) readonly buffer Vertices { Vertex values[]; } vertices;
// Of each workgroup: a ball that holds its vertices.
layout(std430, set = 0, binding = 6) readonly buffer Groups { vec4 balls[]; } groups;
layout(std430, set = 0, binding = 7) buffer VertexLight { float values[]; } vertex_light;
// Light from far away, about the axes of the samples, which each vertex gets as well.
layout(std140, set = 0, binding = 8) uniform Distant { vec4 values[COEFFICIENTS]; } distant;
#if GRADIENTS
layout(std430, set = 0, binding = 9) readonly buffer Gradients { vec4 values[]; } gradients;
#endif

layout(push_constant) uniform Settings {
    uint count; // vertices
    uint first; // in vertices
    uint first_group;
    uint nodes;
    float overlap; // domains over reach
    float trust; // of the distance of the light: how far a sample is continued
    float largest; // domain there can be, metres
} settings;

const uint LIST = 256u;
shared vec4 domains[LIST]; // centre and radius
shared uint sampled[LIST];
// Of each vertex a bit for each listed sample whose domain holds it: neighbours take different samples at once.
shared int held[LIST / 32u * 64u];
shared uint found;
shared uint next; // node of the walk

// Lists samples from node `next` on whose domains meet a ball, until there are none or the list is full.
void walk(vec4 ball)
{
    uint count = 0u;
    uint i = next;
    while (i < settings.nodes && count < LIST) {
        Node node = tree.nodes[i];
        float away = distance(ball.xyz, node.mean) - ball.w;
        uint behind = i + nodes_with_and_below(node);
        if (away > node.bound || node.weight < 0.0) {
            i = behind;
            continue;
        }
        // A slot that nobody wrote may hold anything; the sample it names tells.
        uint number = slots.values[i];
        if (number >= state.taken || places.values[number] != i) {
            ++i;
            continue;
        }
        float radius = settings.overlap * node.reach;
        if (away <= radius) {
            domains[count] = vec4(node.mean, radius);
            sampled[count] = number;
            ++count;
        }
        i = behind;
    }
    next = i;
    found = count;
}

// In units in which the largest domain is 1, so that no distance is too small for a float.
float domain_weight(vec3 point, vec4 domain)
{
    float away = distance(point, domain.xyz);
    if (away > domain.w) { return 0.0; }
    float near = max(away / settings.largest, 1e-6);
    float edge = domain.w / settings.largest;
    if (edge <= 1e-6) { return 1e12; } // a domain of one point: the vertex itself
    float weight = max((edge - near) / (edge * near), 0.0);
    return weight * weight;
}

// Finds which of the listed samples hold a vertex. The sum of their weights.
float hold(vec3 point, uint local)
{
    float total = 0.0;
    for (uint begin = 0u; begin < found; begin += 32u) {
        int bits = 0;
        for (uint k = begin; k < min(found, begin + 32u); ++k) {
            float weight = domain_weight(point, domains[k]);
            total += weight;
            bits |= weight > 0.0 ? 1 << int(k - begin) : 0;
        }
        held[begin / 32u * 64u + local] = bits;
    }
    return total;
}

// Adds to four coefficients from the first on what a listed sample says of them at a point.
void add(inout vec3 sums[4], vec3 point, uint k, uint first)
{
    uint last = uint(COEFFICIENTS) - 1u;
    vec4 domain = domains[k];
    float weight = domain_weight(point, domain);
    uint light = sampled[k] * uint(LIGHT_STRIDE);
#if GRADIENTS
    vec4 extent = lights.values[light + uint(LIGHT_EXTENT)];
    vec3 step_ = point - domain.xyz;
    float far = length(step_);
    // Without light the distance is infinite, and so are the steps allowed.
    float most = extent.y > 0.0 ? settings.trust * (extent.x / extent.y) : far;
    if (far > most) { step_ *= most / far; }
    uint slope = sampled[k] * uint(GRADIENT_STRIDE);
#endif
    for (uint j = 0u; j < 4u; ++j) {
        uint i = min(first + j, last);
        vec3 value = lights.values[light + i].rgb;
#if GRADIENTS
        uint at = slope + 3u * i;
        value += gradients.values[at].rgb * step_.x + gradients.values[at + 1u].rgb * step_.y
            + gradients.values[at + 2u].rgb * step_.z;
#endif
        sums[j] += weight * value;
    }
}

void main()
{
    uint local = gl_LocalInvocationID.x;
    uint slot = gl_WorkGroupID.x * 64u + local;
    bool mine = slot < settings.count;
    Vertex vertex = vertices.values[settings.first + min(slot, settings.count - 1u)];
    uint light = 3u * uint(COEFFICIENTS) * vertex.place;
    if (local == 0u) { next = 0u; }
    float total = 0.0;
    // Once, unless there are more samples than the list holds: then light is summed up where it is written.
    bool begun = false;
    bool more = true;
    while (more) {
        barrier();
        if (local == 0u) { walk(groups.balls[settings.first_group + gl_WorkGroupID.x]); }
        barrier();
        more = next < settings.nodes;
        total += hold(vertex.position, local);
        for (uint first = 0u; first < uint(COEFFICIENTS) && mine; first += 4u) {
            vec3 sums[4] = vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
            for (uint begin = 0u; begin < found; begin += 32u) {
                for (int bits = held[begin / 32u * 64u + local]; bits != 0; bits &= bits - 1) {
                    add(sums, vertex.position, begin + uint(findLSB(bits)), first);
                }
            }
            for (uint j = 0u; j < 4u; ++j) {
                uint i = first + j;
                if (i >= uint(COEFFICIENTS)) { continue; }
                uint at = light + 3u * i;
                vec3 sum = sums[j];
                if (begun) {
                    sum += vec3(vertex_light.values[at], vertex_light.values[at + 1u], vertex_light.values[at + 2u]);
                }
                if (!more) { sum = (total > 0.0 ? sum / total : vec3(0.0)) + distant.values[i].rgb; }
                vertex_light.values[at] = sum.r;
                vertex_light.values[at + 1u] = sum.g;
                vertex_light.values[at + 2u] = sum.b;
            }
        }
        begun = true;
    }
}
