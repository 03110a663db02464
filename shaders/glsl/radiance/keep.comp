#version 460
#extension GL_GOOGLE_include_directive : require
// Samples that need not be taken again when emitters have moved a little: a workgroup a sample. What a sample may have
// changed by, since it was taken, adds up from frame to frame: an emitter that moves by a small step changes what it sends
// as the point's step would, by radiance times solid angle over distance times the step (the slope of
// passes/radiance/src/glow.rs), and one that hides others by no more than the brightest of them would.

#include "radiance/sample.glsl"
#include "radiance/tree.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Tree { Node nodes[]; } tree;
layout(std430, set = 0, binding = 1) readonly buffer State { Batch batch; } state;
// Where each sample is taken, and the number that the node's sample had in the frame before.
layout(std430, set = 0, binding = 2) readonly buffer Points { vec4 values[]; } points;
layout(std430, set = 0, binding = 3) readonly buffer Places { uint values[]; } places;
layout(std430, set = 0, binding = 4) buffer Lights { vec4 values[]; } lights;
layout(std430, set = 0, binding = 5) buffer Gradients { vec4 values[]; } gradients;
layout(std430, set = 0, binding = 6) readonly buffer Glows { Glow values[]; } glows;
// The frame before.
layout(std430, set = 0, binding = 7) readonly buffer OldState {
    Batch batch;
    uint taken;
} old_state;
layout(std430, set = 0, binding = 8) readonly buffer OldPlaces { uint values[]; } old_places;
layout(std430, set = 0, binding = 9) readonly buffer OldLights { vec4 values[]; } old_lights;
layout(std430, set = 0, binding = 10) readonly buffer OldGradients { vec4 values[]; } old_gradients;

layout(push_constant) uniform Settings {
    float allowed; // change of colours that samples may be stale by
    uint glows;
    uint coefficients;
    uint light_stride; // vec4 of a sample
    uint gradient_stride;
} settings;

const uint LANES = 64u;
shared vec3 changes[LANES];

// What the light at a point may change by in the step that the emitters took.
vec3 glow_change(Glow glow, vec3 point)
{
    float near = max(distance(point, glow.place.xyz), sqrt(glow.place.w * 0.159154943091895));
    float solid_angle = near > 0.0 ? glow.place.w / (near * near) : 0.0;
    return solid_angle * (glow.moved.rgb / max(near, 1e-30) + glow.dimmed.rgb);
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    uint number = state.batch.first + gl_WorkGroupID.x;
    vec4 point = points.values[number];
    vec3 sum = vec3(0.0);
    for (uint i = lane; i < settings.glows; i += LANES) { sum += glow_change(glows.values[i], point.xyz); }
    changes[lane] = sum;
    barrier();
    sum = vec3(0.0);
    for (uint i = 0u; i < LANES; ++i) { sum += changes[i]; }
    uint node = places.values[number] & ~SPLIT;
    bool known = point.w >= 0.0 && point.w < float(old_state.taken);
    uint old = known ? uint(point.w) : 0u;
    known = known && (old_places.values[old] & ~SPLIT) == node;
    uint record = old * settings.light_stride;
    vec4 extent = old_lights.values[record + settings.coefficients];
    float change = extent.w + length(sum) * 0.577350269189626; // mean over red, green and blue, as the oracle has it
    bool kept = known && change * tree.nodes[node].share <= settings.allowed;
    uint begin = number * settings.light_stride;
    for (uint i = lane; i < (kept ? settings.light_stride : 0u); i += LANES) {
        vec4 value = old_lights.values[record + i];
        bool exact = value.z == EXACT || value.z == KEPT_EXACT;
        vec4 now = vec4(value.xy, exact ? KEPT_EXACT : KEPT, change);
        lights.values[begin + i] = i == settings.coefficients ? now : value;
    }
    for (uint i = lane; i < (kept ? settings.gradient_stride : 0u); i += LANES) {
        gradients.values[number * settings.gradient_stride + i] = old_gradients.values[old * settings.gradient_stride + i];
    }
    if (!kept && lane == 0u) { lights.values[begin + settings.coefficients] = vec4(0.0); }
}
