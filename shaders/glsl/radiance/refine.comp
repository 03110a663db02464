#version 460
#extension GL_GOOGLE_include_directive : require
// One round of refinement: which of the nodes sampled last are split, and where the next samples are taken. Sun 2005,
// section 3.3.3 and algorithm 3.4, as passes/radiance/src/refine.rs has it; oracles as in oracle.rs.
//
// One workgroup for the whole round: offsets come from a sum in order, not from atomics, so that the same samples lie in
// the same places on every device.

#include "radiance/sample.glsl"
#include "radiance/tree.glsl"

layout(local_size_x = 256) in;

layout(std430, set = 0, binding = 0) readonly buffer Tree { Node nodes[]; } tree;
// For each node the number of its sample; anything where there is none.
layout(std430, set = 0, binding = 1) buffer Slots { uint values[]; } slots;
// For each sample its node, with SPLIT.
layout(std430, set = 0, binding = 2) buffer Places { uint values[]; } places;
// And in the fourth component the number that the node's sample had in the frame before, or anything.
layout(std430, set = 0, binding = 3) buffer Points { vec4 values[]; } points;
layout(std430, set = 0, binding = 4) readonly buffer Lights { vec4 values[]; } lights;
layout(std430, set = 0, binding = 5) buffer State {
    Batch batch; // what to sample next
    uint taken; // samples, those of the batch among them
    uint limited; // 1: the limit kept a node from being split
    uint rounds;
    uint estimate; // the largest of a node not split, as bits
    uint fresh; // samples that were taken in this frame
    uint exact; // samples in closed form
} state;
layout(std430, set = 0, binding = 6) readonly buffer Glows { Glow values[]; } glows;

const uint PRINTED = 0u;
const uint ARGUED = 1u;

layout(push_constant) uniform Round {
    uint seed; // 1: the first round, which samples the root
    uint oracle;
    uint stride; // levels that a split goes down
    uint limit; // samples
    float bound;
    float hidden; // part of what emitters would send unhidden that a sample is taken to miss
    uint glows;
    uint coefficients;
    uint light_stride; // vec4 of a sample
} settings;

const uint NONE = 0xffffffffu;
const uint DEEPEST = 8u;
const float SQRT_3 = 1.73205080756888;

shared uint parts[256];
shared uint next;
shared uint limited;

// Slope of the light if nothing hid any emitter, from their sizes and distances alone.
vec3 unhidden_slope(vec3 point)
{
    vec3 slope = vec3(0.0);
    for (uint i = 0u; i < settings.glows; ++i) {
        vec4 place = glows.values[i].place;
        // Not more than the half space in front of it.
        float near = max(distance(point, place.xyz), sqrt(place.w * 0.159154943091895));
        if (near > 0.0) { slope += glows.values[i].radiance.rgb * (place.w / (near * near * near)); }
    }
    return slope;
}

// What the oracle multiplies with a node's weight.
float signal(uint sampled)
{
    uint first = sampled * settings.light_stride;
    if (settings.oracle == PRINTED || settings.oracle == ARGUED) {
        float square = 0.0;
        for (uint i = 0u; i < settings.coefficients; ++i) {
            vec3 light = lights.values[first + i].rgb;
            square += dot(light, light);
        }
        vec4 extent = lights.values[first + settings.coefficients];
        float near = extent.x > 0.0 ? extent.y / extent.x : 0.0;
        return sqrt(square) / SQRT_3 * (settings.oracle == PRINTED ? near * near : near);
    }
    vec3 slope = lights.values[first + settings.coefficients + 1u].rgb;
    float seen = length(slope);
    if (settings.hidden > 0.0) {
        seen = max(seen, settings.hidden * length(unhidden_slope(points.values[sampled].xyz)));
    }
    return seen / SQRT_3;
}

// Visits the nodes below `node` that a split samples, in order; with `offset` NONE it only counts them.
uint split(uint node, float strength, uint offset)
{
    uint ends[DEEPEST + 1u];
    uint level = 0u;
    uint found = 0u;
    ends[0] = node + nodes_with_and_below(tree.nodes[node]);
    for (uint i = node + 1u; i < ends[0];) {
        while (i >= ends[level]) { --level; }
        Node part = tree.nodes[i];
        uint end = i + nodes_with_and_below(part);
        if (part.weight < 0.0) {
            i = end;
            continue;
        }
        bool enough = part.weight * strength <= settings.bound;
        if (!enough && level + 1u < settings.stride && part.count > 1u) {
            ++level;
            ends[level] = end;
            ++i;
            continue;
        }
        if (offset != NONE) {
            uint sampled = offset + found;
            places.values[sampled] = i;
            points.values[sampled] = vec4(part.mean, float(slots.values[i]));
            slots.values[i] = sampled;
        }
        ++found;
        i = end;
    }
    return found;
}

void begin()
{
    places.values[0] = 0u;
    points.values[0] = vec4(tree.nodes[0].mean, float(slots.values[0]));
    slots.values[0] = 0u;
    state.batch = Batch(1u, 1u, 1u, 0u);
    state.taken = 1u;
    state.limited = 0u;
    state.rounds = 1u;
    state.estimate = 0u;
    state.fresh = 0u;
    state.exact = 0u;
}

void main()
{
    uint local = gl_LocalInvocationID.x;
    if (settings.seed == 1u) {
        if (local == 0u) { begin(); }
        return;
    }
    uint first = state.batch.first;
    uint end = state.taken;
    if (local == 0u) {
        next = end;
        limited = 0u;
    }
    for (uint chunk = first; chunk < end; chunk += 256u) {
        uint sampled = chunk + local;
        bool mine = sampled < end;
        uint node = 0u;
        float strength = 0.0;
        float estimate = 0.0;
        uint wanted = 0u;
        if (mine) {
            node = places.values[sampled];
            strength = signal(sampled);
            estimate = tree.nodes[node].weight * strength;
            float how = lights.values[sampled * settings.light_stride + settings.coefficients].z;
            if (how < KEPT) { atomicAdd(state.fresh, 1u); }
            if (how == EXACT || how == KEPT_EXACT) { atomicAdd(state.exact, 1u); }
            if (estimate > settings.bound) { wanted = split(node, strength, NONE); }
        }
        parts[local] = wanted;
        barrier();
        // In order, and past what does not fit: as the reference goes on.
        if (local == 0u) {
            for (uint i = 0u; i < 256u; ++i) {
                uint count = parts[i];
                bool fits = next + count <= settings.limit;
                if (count > 0u && !fits) { limited = 1u; }
                parts[i] = count > 0u && fits ? next : NONE;
                if (count > 0u && fits) { next += count; }
            }
        }
        barrier();
        uint offset = parts[local];
        if (mine && offset != NONE) {
            places.values[sampled] = node | SPLIT;
            split(node, strength, offset);
        } else if (mine) {
            atomicMax(state.estimate, floatBitsToUint(estimate));
        }
        barrier();
    }
    barrier();
    if (local == 0u) {
        state.batch.first = end;
        state.batch.count = next - end;
        state.taken = next;
        state.limited |= limited;
        if (next > end) { state.rounds += 1u; }
    }
}
