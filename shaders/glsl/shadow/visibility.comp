#version 460
#extension GL_GOOGLE_include_directive : require
// What spheres leave each receiver to see, in spherical harmonics: log visibility of the spheres summed up, and one
// exponential (Sun 2008, section 5.2). A workgroup is a cluster of receivers that lie together: its spheres are chosen once,
// in a fixed order.
//
// The includer's defines: ORDER; EXPONENTIAL as in exponential.glsl, 7: the product of the visibilities one after the other,
// the rival; 8: none, the logarithm comes out; NORMALS: receivers lie on surfaces and see nothing below their tangent planes.

layout(local_size_x = 64) in;

// Object space, three floats a receiver.
layout(std430, set = 0, binding = 0) readonly buffer Positions {
    float values[];
} positions;

// Receivers in the order of their clusters; 0xffffffff where a cluster has fewer than 64.
layout(std430, set = 0, binding = 1) readonly buffer Slots {
    uint values[];
} slots;

// Object space, radius in w: as many as the smallest uniform range of any device holds.
const uint MOST_SPHERES = 1024u;
layout(std140, set = 0, binding = 2) uniform Spheres {
    vec4 values[1024];
} spheres;

// Band factors over the height of the cap, at TABLE + 1 heights from 0 to 1, in as many bytes.
#if ORDER > 4
const uint PARTS = 2u;
const uint TABLE = 511u;
#else
const uint PARTS = 1u;
const uint TABLE = 1023u;
#endif
layout(std140, set = 0, binding = 3) uniform Factors {
    vec4 values[1024];
} factors;

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

#if EXPONENTIAL == 2
layout(std430, set = 0, binding = 7) readonly buffer Linear {
    vec2 values[257];
} linear;
#define SHADOW_LINEAR(at) linear.values[at]
#define SHADOW_LINEAR_END settings.end
#endif

layout(push_constant) uniform Settings {
    uint sphere_count;
    uint degree;
    float norm;
    float reach;    // heights of caps below this are left out of a whole cluster
    float window;   // deringing: bands are divided by 1 + window l^2 (l + 1)^2
    uint clamped;   // 1: results are made ones that a visibility can have
    float end;
    uint first;     // first cluster of this dispatch
} settings;

#include "common/sh_basis.glsl"
#include "shadow/cap.glsl"
#include "shadow/exponential.glsl"

shared vec4 corners[2][64];
shared uint chosen[MOST_SPHERES / 32u];
shared uint clamps[64];

vec3 position(uint receiver)
{
    uint at = 3u * receiver;
    return vec3(positions.values[at], positions.values[at + 1u], positions.values[at + 2u]);
}

// The sphere around the box of the cluster's receivers.
vec4 cluster_bound(uint lane, vec3 place, bool there)
{
    corners[0][lane] = vec4(there ? place : vec3(1e30), 0.0);
    corners[1][lane] = vec4(there ? place : vec3(-1e30), 0.0);
    barrier();
    for (uint step = 32u; step > 0u; step /= 2u) {
        if (lane < step) {
            corners[0][lane] = min(corners[0][lane], corners[0][lane + step]);
            corners[1][lane] = max(corners[1][lane], corners[1][lane + step]);
        }
        barrier();
    }
    vec3 low = corners[0][0].xyz;
    vec3 high = corners[1][0].xyz;
    return vec4(0.5 * (low + high), 0.5 * length(high - low));
}

// Whether a sphere may be seen as a cap of at least the height `reach` from somewhere in the bound.
bool reaches(vec4 sphere, vec4 bound)
{
    if (!(sphere.w > 0.0)) { return false; }
    vec3 nearest = vec3(max(length(sphere.xyz - bound.xyz) - bound.w, 0.0), 0.0, 0.0);
    return shadow_cap(nearest, sphere.w, vec3(0.0)).w >= settings.reach;
}

// One bit for each sphere.
void choose(uint lane, vec4 bound)
{
    for (uint word = lane; word < MOST_SPHERES / 32u; word += 64u) {
        uint bits = 0u;
        for (uint bit = 0u; bit < 32u && 32u * word + bit < settings.sphere_count; ++bit) {
            if (reaches(spheres.values[32u * word + bit], bound)) { bits |= 1u << bit; }
        }
        chosen[word] = bits;
    }
    barrier();
}

// Coefficients of a cap by the table.
void cap_coefficients(vec4 cap, float share, out float f[COUNT])
{
    float place = cap.w * float(TABLE);
    uint entry = min(uint(place), TABLE - 1u);
    float t = place - float(entry);
    float scale = share * cap.w;
    vec4 low = scale * mix(factors.values[PARTS * entry], factors.values[PARTS * entry + PARTS], t);
#if ORDER > 4
    vec4 high = scale * mix(factors.values[PARTS * entry + 1u], factors.values[PARTS * entry + PARTS + 1u], t);
#endif
    sh_evaluate(cap.xyz, f);
    f[0] *= low.x;
    for (int i = 1; i < 4; ++i) { f[i] *= low.y; }
    for (int i = 4; i < 9; ++i) { f[i] *= low.z; }
#if ORDER > 3
    for (int i = 9; i < 16; ++i) { f[i] *= low.w; }
#endif
#if ORDER > 4
    for (int i = 16; i < 25; ++i) { f[i] *= high.x; }
#endif
#if ORDER > 5
    for (int i = 25; i < 36; ++i) { f[i] *= high.y; }
#endif
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    uint cluster = settings.first + gl_WorkGroupID.x;
    uint receiver = slots.values[64u * cluster + lane];
    bool there = receiver != 0xffffffffu;
    vec3 place = there ? position(receiver) : vec3(0.0);
    vec4 bound = cluster_bound(lane, place, there);
#ifdef NORMALS
    vec3 normal = vec3(0.0);
    if (there) {
        uint at = 3u * receiver;
        normal = vec3(normals.values[at], normals.values[at + 1u], normals.values[at + 2u]);
        normal *= inversesqrt(max(dot(normal, normal), 1e-30));
    }
#endif
    float sum[COUNT];
    float term[COUNT];
    EACH(i) { sum[i] = 0.0; }
#if EXPONENTIAL == 7
    sum[0] = ONE;
#endif
    uint spheres_here = 0u;
    choose(lane, bound);
    for (uint at = 0u; at < settings.sphere_count; ++at) {
        if ((chosen[at >> 5] >> (at & 31u) & 1u) == 0u) { continue; }
        ++spheres_here;
        vec4 sphere = spheres.values[at];
        float share = 1.0;
#ifdef NORMALS
        sphere = shadow_above(sphere, place, normal, share);
#endif
        cap_coefficients(shadow_cap(sphere.xyz, sphere.w, place), share, term);
#if EXPONENTIAL == 7
        term[0] += ONE;
        float product[COUNT];
        sh_product(sum, term, product);
        sum = product;
#else
        EACH(i) { sum[i] += term[i]; }
#endif
    }
    bool clamped = false;
    if (spheres_here == 0u) {
        // Out of reach of every sphere: no exponential.
        sum[0] = EXPONENTIAL == 8 ? 0.0 : ONE;
    } else {
#if EXPONENTIAL < 7
        exponential(sum, Exponential(settings.degree, settings.norm, 0u));
#endif
        if (settings.clamped != 0u) { clamped = clamp_visibility(sum); }
    }
    clamps[lane] = clamped && there ? 1u : 0u;
    barrier();
    if (lane == 0u) {
        uint count = 0u;
        for (uint i = 0u; i < 64u; ++i) { count += clamps[i]; }
        records.values[cluster] = uvec2(spheres_here, count);
    }
    if (!there) { return; }
    EACH(i) {
        float band = i < 1 ? 0.0 : i < 4 ? 2.0 : i < 9 ? 6.0 : i < 16 ? 12.0 : i < 25 ? 20.0 : 30.0; // l (l + 1)
        visibility.values[receiver * COUNT + i] = sum[i] / (1.0 + settings.window * band * band);
    }
}
