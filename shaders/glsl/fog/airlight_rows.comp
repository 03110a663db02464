#version 460
#extension GL_GOOGLE_include_directive : require
// The airlight of rows of parameters, by the functions of the pass: for `airglow eval`, stability and tests.

#if FOG_WALL
// In the place of a host's shadow map: no light arrives beyond a wall across the view.
#define FOG_VISIBILITY(light, position) float((position).z >= -6.0)
#endif
#include "fog/airlight.glsl"

layout(local_size_x = 64) in;

struct Row {
    FogLight light;
    vec4 direction_distance; // unit vector; m
    vec4 extinction;         // w: 1 over the scale height
    vec4 scattering;         // w unused
    vec4 phase;
};

layout(std430, set = 0, binding = 0) readonly buffer Rows {
    Row values[];
} rows;

layout(std430, set = 0, binding = 1) buffer Airlight {
    vec4 values[];
} airlight;

layout(push_constant) uniform Settings {
    uint count;
} settings;

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.count) { return; }
    Row row = rows.values[at];
    FogMedium medium = FogMedium(row.extinction.rgb, row.scattering.rgb, row.phase, row.extinction.w);
    vec3 direction = row.direction_distance.xyz;
    float distance = row.direction_distance.w;
    airlight.values[at] = vec4(fog_airlight(medium, row.light, 0, direction, distance), 0.0);
}
