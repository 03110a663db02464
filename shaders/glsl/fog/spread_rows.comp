#version 460
#extension GL_GOOGLE_include_directive : require
// The point spread function of rows of parameters: for `airglow eval` and tests.

#include "fog/spread.glsl"

layout(local_size_x = 64) in;

// Optical distance, sine, versine; w: 1 for the factored form.
layout(std430, set = 0, binding = 0) readonly buffer Rows {
    vec4 values[];
} rows;

layout(std430, set = 0, binding = 1) buffer Spread {
    float values[];
} spread;

layout(push_constant) uniform Settings {
    uint count;
} settings;

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.count) { return; }
    vec4 row = rows.values[at];
    spread.values[at] = row.w > 0.5 ? fog_spread_factored(row.x, row.y, row.z) : fog_spread(row.x, row.y, row.z);
}
