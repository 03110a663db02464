#version 460
#extension GL_GOOGLE_include_directive : require
// Light vectors of vertices from the samples whose domains hold them, as passes/radiance/src/reconstruct.rs has them:
// weights ((R - d) / (R d))^2 / (1 + (d / H)^2)^4 of the nodes not split (Franke and Nielson, "Smooth Interpolation of Large
// Sets of Scattered Data", 1980), H the distance of a sample's emitters, each sample continued to first order (Annen, Kautz, Durand, Seidel, "Spherical Harmonic Gradients for
// Mid-Range Illumination", 2004).
//
// A workgroup has 256 vertices that are near one another, an invocation eight that are nearer still. One walk of the tree
// finds the samples for all of them; an invocation keeps those that any of its eight needs, and what it reads of a sample
// serves them all: reading takes longer than adding. Some coefficients at a time need neither all registers nor long code.
//
// ORDER      3 to 6
// GRADIENTS  0 or 1: samples are continued by their gradients

#extension GL_EXT_control_flow_attributes : require

#include "radiance/sample.glsl"
#include "radiance/tree.glsl"

#define LANES 32
#define EIGHT 8 // vertices of an invocation
// Coefficients that it takes at a time: weights are computed again for the next.
#define SOME 8
layout(local_size_x = LANES) in;

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
    float dark; // root of how much more a sample counts that no emitter reaches
} settings;

const uint LIST = 256u;
shared vec4 domains[LIST]; // centre and radius
shared uint sampled[LIST];
// Of each invocation a bit for each listed sample whose domain holds one of its vertices: neighbours take different
// samples at once.
shared int held[LIST / 32u * LANES];
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

// In units in which the largest domain is 1, so that no distance is too small for a float. `nearness` is 1 / H.
float domain_weight(vec3 point, vec4 domain, float unit, float nearness)
{
    float away = distance(point, domain.xyz);
    float near = max(away * unit, 1e-6);
    float edge = domain.w * unit;
    float far = min(away * nearness, 8.0);
    far = 1.0 + far * far;
    float known = nearness > 0.0 ? 1.0 / (far * far) : settings.dark;
    float weight = max((edge - near) / (edge * near), 0.0) * known;
    // A domain of one point: the vertex itself.
    weight = edge > 1e-6 ? weight * weight : 1e12;
    return away > domain.w ? 0.0 : weight;
}

// Finds which of the listed samples hold a vertex of the invocation.
void hold(vec3 points[EIGHT], uint lane)
{
    for (uint begin = 0u; begin < found; begin += 32u) {
        int bits = 0;
        for (uint k = begin; k < min(found, begin + 32u); ++k) {
            vec4 domain = domains[k];
            float nearest = distance(points[0], domain.xyz);
            [[unroll]] for (int v = 1; v < EIGHT; ++v) { nearest = min(nearest, distance(points[v], domain.xyz)); }
            bits |= nearest <= domain.w ? 1 << int(k - begin) : 0;
        }
        held[begin / 32u * LANES + lane] = bits;
    }
}

// Adds to some coefficients from the first on, of all vertices, what a listed sample says of them.
void add(inout vec3 sums[EIGHT * SOME], inout float totals[EIGHT], vec3 points[EIGHT], uint k, uint first)
{
    uint last = uint(COEFFICIENTS) - 1u;
    vec4 domain = domains[k];
    uint light = sampled[k] * uint(LIGHT_STRIDE);
    float weights[EIGHT];
    float unit = 1.0 / settings.largest;
    // Without light the distance of its emitters is infinite, and so are the steps allowed.
    vec2 extent = lights.values[light + uint(LIGHT_EXTENT)].xy;
    float nearness = extent.x > 0.0 ? extent.y / extent.x : 0.0;
    [[unroll]] for (int v = 0; v < EIGHT; ++v) {
        weights[v] = domain_weight(points[v], domain, unit, nearness);
        totals[v] += first == 0u ? weights[v] : 0.0;
    }
#if GRADIENTS
    uint slope = sampled[k] * uint(GRADIENT_STRIDE);
    vec3 steps[EIGHT];
    [[unroll]] for (int v = 0; v < EIGHT; ++v) {
        vec3 way = points[v] - domain.xyz;
        float far = length(way);
        float most = nearness > 0.0 ? settings.trust / nearness : far;
        steps[v] = weights[v] * (far > most ? most / far : 1.0) * way;
    }
#endif
    [[unroll]] for (int j = 0; j < SOME; ++j) {
        uint i = min(first + uint(j), last);
        vec3 value = lights.values[light + i].rgb;
#if GRADIENTS
        uint at = slope + 3u * i;
        vec3 x = gradients.values[at].rgb;
        vec3 y = gradients.values[at + 1u].rgb;
        vec3 z = gradients.values[at + 2u].rgb;
#endif
        [[unroll]] for (int v = 0; v < EIGHT; ++v) {
            vec3 sum = weights[v] * value;
#if GRADIENTS
            sum += steps[v].x * x + steps[v].y * y + steps[v].z * z;
#endif
            sums[v * SOME + j] += sum;
        }
    }
}

// Writes some coefficients of a vertex; those of a list before, if there was one, are there already.
void write(vec3 sums[EIGHT * SOME], int v, uint light, uint first, float total, bool begun, bool more)
{
    [[unroll]] for (int j = 0; j < SOME; ++j) {
        uint i = first + uint(j);
        uint at = light + 3u * i;
        vec3 sum = sums[v * SOME + j];
        // A loop, not a branch: software drivers run through a branch that nobody takes.
        for (bool add = begun && i < uint(COEFFICIENTS); add; add = false) {
            sum += vec3(vertex_light.values[at], vertex_light.values[at + 1u], vertex_light.values[at + 2u]);
        }
        for (bool last = !more && i < uint(COEFFICIENTS); last; last = false) {
            sum = (total > 0.0 ? sum / total : vec3(0.0)) + distant.values[i].rgb;
        }
        if (i < uint(COEFFICIENTS)) {
            vertex_light.values[at] = sum.r;
            vertex_light.values[at + 1u] = sum.g;
            vertex_light.values[at + 2u] = sum.b;
        }
    }
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    uint begin = uint(EIGHT) * (gl_WorkGroupID.x * uint(LANES) + lane);
    vec3 points[EIGHT];
    uint written[EIGHT];
    float totals[EIGHT];
    [[unroll]] for (int v = 0; v < EIGHT; ++v) {
        Vertex vertex = vertices.values[settings.first + min(begin + uint(v), settings.count - 1u)];
        points[v] = vertex.position;
        written[v] = 3u * uint(COEFFICIENTS) * vertex.place;
        totals[v] = 0.0;
    }
    if (lane == 0u) { next = 0u; }
    // Once, unless there are more samples than the list holds: then light is summed up where it is written.
    bool begun = false;
    bool more = true;
    while (more) {
        barrier();
        if (lane == 0u) { walk(groups.balls[settings.first_group + gl_WorkGroupID.x]); }
        barrier();
        more = next < settings.nodes;
        hold(points, lane);
        for (uint first = 0u; first < uint(COEFFICIENTS) && begin < settings.count; first += uint(SOME)) {
            vec3 sums[EIGHT * SOME];
            [[unroll]] for (int i = 0; i < EIGHT * SOME; ++i) { sums[i] = vec3(0.0); }
            for (uint from = 0u; from < found; from += 32u) {
                for (int bits = held[from / 32u * LANES + lane]; bits != 0; bits &= bits - 1) {
                    add(sums, totals, points, from + uint(findLSB(bits)), first);
                }
            }
            [[unroll]] for (int v = 0; v < EIGHT; ++v) {
                if (begin + uint(v) < settings.count) {
                    write(sums, v, written[v], first, totals[v], begun, more);
                }
            }
        }
        begun = true;
    }
}
