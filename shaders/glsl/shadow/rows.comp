#version 460
#extension GL_GOOGLE_include_directive : require
// Exponentials, products and squares on rows of coefficients, by the functions that the pass ships: for tests, evaluation
// and timing. EXPONENTIAL as in exponential.glsl; 5: the product of the row with itself, 6: its square, each `repeat` times.

#if EXPONENTIAL < 3
layout(std430, set = 0, binding = 2) readonly buffer Table {
    float values[];
} table;
#define SHADOW_TABLE(at) table.values[at]
#define SHADOW_TABLE_END settings.end
#endif

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Rows {
    float values[];
} rows;

layout(std430, set = 0, binding = 1) buffer Results {
    float values[];
} results;

layout(push_constant) uniform Settings {
    uint count;
    uint degree;
    float norm;
    uint whole;
    uint repeat;
    float end;
} settings;

#include "shadow/exponential.glsl"

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.count) { return; }
    float f[COUNT];
    EACH(i) { f[i] = rows.values[at * COUNT + i]; }
#if EXPONENTIAL == 5 || EXPONENTIAL == 6
    float h[COUNT];
    float g[COUNT] = f;
    for (uint step = 0u; step < settings.repeat; ++step) {
#if EXPONENTIAL == 5
        sh_product(g, f, h);
#else
        sh_square(g, h);
#endif
        g = h;
    }
    f = g;
#else
    exponential(f, Exponential(settings.degree, settings.norm, settings.whole));
#endif
    EACH(i) { results.values[at * COUNT + i] = f[i]; }
}
