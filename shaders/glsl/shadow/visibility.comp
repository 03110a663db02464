#version 460
#extension GL_GOOGLE_include_directive : require
// What spheres leave each receiver to see, in spherical harmonics: log visibility of the spheres summed up, and one
// exponential (Sun 2008, section 5.2). A workgroup is a cluster of receivers that lie together: its nodes of the hierarchy
// of spheres are chosen once, in a fixed order.
//
// The includer's defines: ORDER; EXPONENTIAL as in exponential.glsl, 7: the product of the visibilities one after the other,
// the rival; NORMALS: receivers lie on surfaces and see nothing below their tangent planes.

// A lane holds two receivers, for which it reads a sphere once; the rival one, whose products take longer.
#if EXPONENTIAL == 7
#define RECEIVERS 1
#else
#define RECEIVERS 2
#endif
const uint CLUSTER = 64u;
const uint LANES = CLUSTER / uint(RECEIVERS);

layout(local_size_x = 64 / RECEIVERS) in;

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

const uint NOBODY = 0xffffffffu;

// Of the box of the cluster's receivers, as numbers in the order of floats.
shared uint corners[6];
shared uint clamped_here;

// Beyond every receiver.
const float FAR = 3e38;

vec3 position(uint receiver)
{
    uint at = 3u * receiver;
    return vec3(positions.values[at], positions.values[at + 1u], positions.values[at + 2u]);
}

// The receiver of a number; at the origin where nobody is there, or where it is not finite.
Receiver read(uint number, out bool there)
{
    Receiver receiver = Receiver(vec3(0.0), vec3(0.0));
    there = number != NOBODY;
    if (there) {
        Receiver raw = receiver;
        raw.place = position(number);
        there = finite(vec4(raw.place, 0.0));
#ifdef NORMALS
        uint at = 3u * number;
        raw.normal = vec3(normals.values[at], normals.values[at + 1u], normals.values[at + 2u]);
        there = there && finite(vec4(raw.normal, 0.0));
        raw.normal *= inversesqrt(max(dot(raw.normal, raw.normal), 1e-30));
#endif
        if (there) { receiver = raw; }
    }
    return receiver;
}

// Floats as numbers in the same order.
uint ordered(float value)
{
    uint bits = floatBitsToUint(value);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float of_ordered(uint number)
{
    return uintBitsToFloat((number & 0x80000000u) != 0u ? number & 0x7fffffffu : ~number);
}

// The sphere around the box of all receivers of the cluster, of which a lane knows the box of its own.
vec4 cluster_bound(uint lane, vec3 low, vec3 high)
{
    if (lane < 6u) { corners[lane] = lane < 3u ? 0xffffffffu : 0u; }
    barrier();
    for (uint axis = 0u; axis < 3u; ++axis) {
        atomicMin(corners[axis], ordered(low[axis]));
        atomicMax(corners[axis + 3u], ordered(high[axis]));
    }
    barrier();
    for (uint axis = 0u; axis < 3u; ++axis) {
        low[axis] = of_ordered(corners[axis]);
        high[axis] = of_ordered(corners[axis + 3u]);
    }
    return vec4(0.5 * (low + high), 0.5 * length(high - low));
}

// What a receiver sees by the sum of its spheres, in place of that; whether it had to be clamped.
bool see(inout float sum[COUNT], bool open)
{
    if (open) {
        // Out of reach of every sphere: no exponential.
        EACH(i) { sum[i] = i == 0 ? ONE : 0.0; }
        return false;
    }
#if EXPONENTIAL < 7
    exponential(sum, Exponential(settings.degree, settings.norm, 0u));
#endif
    return (settings.flags & CLAMPED) != 0u && clamp_visibility(sum);
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    uint cluster = settings.first + gl_WorkGroupID.x;
    bool continued = (settings.flags & CONTINUED) != 0u;
    bool logarithm = (settings.flags & LOGARITHM) != 0u;
    uint numbers[RECEIVERS];
    bool there[RECEIVERS];
    Receiver receivers[RECEIVERS];
    float sums[RECEIVERS][COUNT];
    vec3 low = vec3(FAR);
    vec3 high = vec3(-FAR);
    if (lane == 0u) { clamped_here = 0u; }
    for (int r = 0; r < RECEIVERS; ++r) {
        numbers[r] = slots.values[CLUSTER * cluster + LANES * uint(r) + lane];
        receivers[r] = read(numbers[r], there[r]);
        low = there[r] ? min(low, receivers[r].place) : low;
        high = there[r] ? max(high, receivers[r].place) : high;
    }
    choose(lane, cluster_bound(lane, low, high), settings.reach, settings.cut);
    uint chosen_here = accumulate(receivers, sums);
    uint before = continued ? records.values[cluster].x : 0u;
    float window = logarithm ? 0.0 : settings.window;
    // A loop that is not unrolled, so that the exponential stands in the program once.
    uint r = 0u;
    do {
        bool first = r == 0u;
        uint number = first ? numbers[0] : numbers[RECEIVERS - 1];
        bool blocked = first ? there[0] : there[RECEIVERS - 1];
        float sum[COUNT];
        EACH(i) { sum[i] = !blocked ? 0.0 : first ? sums[0][i] : sums[RECEIVERS - 1][i]; }
        if (continued && blocked) {
            EACH(i) { sum[i] += visibility.values[number * COUNT + i]; }
        }
        if (!logarithm && see(sum, !blocked || before + chosen_here == 0u)) { atomicAdd(clamped_here, 1u); }
        if (number != NOBODY) {
            EACH(i) {
                float band = i < 1 ? 0.0 : i < 4 ? 2.0 : i < 9 ? 6.0 : i < 16 ? 12.0 : i < 25 ? 20.0 : 30.0; // l (l + 1)
                visibility.values[number * COUNT + i] = sum[i] / (1.0 + window * band * band);
            }
        }
        ++r;
    } while (r < uint(RECEIVERS));
    barrier();
    if (lane == 0u) { records.values[cluster] = uvec2(before + chosen_here, clamped_here); }
}
