// Replaces values that are not finite by 0 and those above 1 by 1, counting both: a use of the health counters.
#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) buffer Values { float value[]; };
layout(set = 0, binding = 1, std430) buffer Health { uint not_finite; uint clamped; } health;
layout(push_constant) uniform Settings { uint count; } settings;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= settings.count) return;
    float x = value[i];
    // An exponent of all ones is infinity or NaN; comparisons with NaN may be optimised away.
    if ((floatBitsToUint(x) & 0x7f800000u) == 0x7f800000u) {
        atomicAdd(health.not_finite, 1u);
        value[i] = 0.0;
    } else if (x > 1.0) {
        atomicAdd(health.clamped, 1u);
        value[i] = 1.0;
    }
}
