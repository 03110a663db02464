#version 460
#extension GL_GOOGLE_include_directive : require
// G_n of rows of parameters out of tables, by the functions a host's shader calls: for `airglow eval` and tests.

layout(local_size_x = 64) in;

struct Row {
    float optical;
    float chord;
    float exponent;
    int table;
};

layout(std430, set = 0, binding = 0) readonly buffer Rows {
    Row values[];
} rows;

layout(std430, set = 0, binding = 1) readonly buffer Tables {
    float entries[];
} tables;

layout(std430, set = 0, binding = 2) buffer Glow {
    float values[];
} glow;

layout(push_constant) uniform Settings {
    uint count;
} settings;

#define FOG_LOBE_ENTRY(i) tables.entries[i]
#include "fog/surface.glsl"

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.count) { return; }
    Row row = rows.values[at];
    glow.values[at] = fog_lobe(row.table, row.optical, fog_lobe_column(row.chord, row.exponent));
}
