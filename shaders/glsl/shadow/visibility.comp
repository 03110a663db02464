#version 460
#extension GL_GOOGLE_include_directive : require
// What spheres leave each receiver to see, in spherical harmonics: log visibility of the spheres summed up, and one
// exponential (Sun 2008, section 5.2). A workgroup is a cluster of receivers that lie together: its nodes of the hierarchy
// of spheres are chosen once, in a fixed order.
//
// The includer's defines: ORDER; EXPONENTIAL as in exponential.glsl, 7: the product of the visibilities one after the other,
// the rival; NORMALS: receivers lie on surfaces and see nothing below their tangent planes.

layout(local_size_x = 64) in;

// Object space, three floats a receiver.
layout(std430, set = 0, binding = 0) readonly buffer Positions {
    float values[];
} positions;

// Receivers in the order of their clusters; 0xffffffff where a cluster has fewer than 64.
layout(std430, set = 0, binding = 1) readonly buffer Slots {
    uint values[];
} slots;

// ORDER^2 floats a receiver, in the order of the positions.
layout(std430, set = 0, binding = 4) buffer Visibility {
    float values[];
} visibility;

// Spheres of each cluster, and its receivers that had to be clamped.
layout(std430, set = 0, binding = 5) buffer Records {
    uvec2 values[];
} records;

#ifdef NORMALS
layout(std430, set = 0, binding = 6) readonly buffer Normals {
    float values[];
} normals;
#endif

const uint CLAMPED = 1u;   // results are made ones that a visibility can have
const uint CONTINUED = 2u; // begins with the logarithm that the buffer holds
const uint LOGARITHM = 4u; // ends without exponential

layout(push_constant) uniform Settings {
    uint count;     // nodes
    uint degree;
    float norm;
    float reach;    // heights of caps below this are left out of a whole cluster
    float cut;      // nodes whose height is below this stand for what they hold
    float window;   // deringing: bands are divided by 1 + window l^2 (l + 1)^2
    uint flags;
    float end;
    uint first;     // first cluster of this dispatch
} settings;

#include "shadow/blockers.glsl"

// No receiver is there.
const float FAR = 1e30;

shared vec3 places[64];
shared vec3 corners[2][8];
shared uint clamped_here;

vec3 position(uint receiver)
{
    uint at = 3u * receiver;
    return vec3(positions.values[at], positions.values[at + 1u], positions.values[at + 2u]);
}

// The sphere around the box of the cluster's receivers that are somewhere; eight at a time, then the eight.
vec4 cluster_bound(uint lane, vec3 place, bool there)
{
    bool somewhere = there && all(lessThan(abs(place), vec3(FAR)));
    places[lane] = somewhere ? place : vec3(FAR);
    barrier();
    if (lane < 8u) {
        vec3 low = vec3(FAR);
        vec3 high = vec3(-FAR);
        for (uint i = 0u; i < 8u; ++i) {
            vec3 next = places[8u * lane + i];
            bool counts = next.x < FAR;
            low = counts ? min(low, next) : low;
            high = counts ? max(high, next) : high;
        }
        corners[0][lane] = low;
        corners[1][lane] = high;
    }
    barrier();
    vec3 low = corners[0][0];
    vec3 high = corners[1][0];
    for (uint i = 1u; i < 8u; ++i) {
        low = min(low, corners[0][i]);
        high = max(high, corners[1][i]);
    }
    return vec4(0.5 * (low + high), 0.5 * length(high - low));
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    uint cluster = settings.first + gl_WorkGroupID.x;
    uint receiver = slots.values[64u * cluster + lane];
    bool there = receiver != 0xffffffffu;
    vec3 place = there ? position(receiver) : vec3(0.0);
    vec3 normal = vec3(0.0);
#ifdef NORMALS
    if (there) {
        uint at = 3u * receiver;
        normal = vec3(normals.values[at], normals.values[at + 1u], normals.values[at + 2u]);
        normal *= inversesqrt(max(dot(normal, normal), 1e-30));
    }
#endif
    if (lane == 0u) { clamped_here = 0u; }
    choose(lane, cluster_bound(lane, place, there), settings.reach, settings.cut);
    float sum[COUNT];
    bool continued = (settings.flags & CONTINUED) != 0u && there;
    EACH(i) { sum[i] = continued ? visibility.values[receiver * COUNT + i] : 0.0; }
#if EXPONENTIAL == 7
    sum[0] = ONE;
#endif
    uint chosen_here = accumulate(place, normal, sum);
    uint before = (settings.flags & CONTINUED) != 0u ? records.values[cluster].x : 0u;
    bool logarithm = (settings.flags & LOGARITHM) != 0u;
    bool clamped = false;
    if (!logarithm) {
        if (before + chosen_here == 0u) {
            // Out of reach of every sphere: no exponential.
            sum[0] = ONE;
        } else {
#if EXPONENTIAL < 7
            exponential(sum, Exponential(settings.degree, settings.norm, 0u));
#endif
            if ((settings.flags & CLAMPED) != 0u) { clamped = clamp_visibility(sum); }
        }
    }
    if (clamped && there) { atomicAdd(clamped_here, 1u); }
    barrier();
    if (lane == 0u) { records.values[cluster] = uvec2(before + chosen_here, clamped_here); }
    if (!there) { return; }
    float window = logarithm ? 0.0 : settings.window;
    EACH(i) {
        float band = i < 1 ? 0.0 : i < 4 ? 2.0 : i < 9 ? 6.0 : i < 16 ? 12.0 : i < 25 ? 20.0 : 30.0; // l (l + 1)
        visibility.values[receiver * COUNT + i] = sum[i] / (1.0 + window * band * band);
    }
}
