#version 460
#extension GL_GOOGLE_include_directive : require
// A rival of the pass's evaluator, or the evaluator itself, on configurations from a buffer: for `airglow report`.

#include "common/constants.glsl"
#include "fog/rivals/configuration.glsl"
#if defined(RIVAL_MARCH)
#define EQUIANGULAR 0
#include "fog/rivals/march.glsl"
#elif defined(RIVAL_EQUIANGULAR)
#define EQUIANGULAR 1
#include "fog/rivals/march.glsl"
#elif defined(RIVAL_TABLE)
#define ENTRIES_ONLY 0
#include "fog/rivals/table.glsl"
#elif defined(RIVAL_ENTRIES)
#define ENTRIES_ONLY 1
#include "fog/rivals/table.glsl"
#elif defined(RIVAL_DEPTH_FOG)
#include "fog/rivals/depth_fog.glsl"
#elif defined(RIVAL_POLES)
#include "fog/rivals/poles.glsl"
#elif defined(RIVAL_TAPS)
#include "fog/rivals/taps.glsl"
#else
// Nothing but what all share.
COLOUR rival_airlight(Configuration c, int steps)
{
    return c.extinction + c.seen + c.along + c.off + c.extent;
}
#endif

layout(local_size_x = 64) in;

struct Row {
    vec4 extinction_extent;
    vec4 seen_along;
    vec4 off_weight; // distance of the light from the ray; what the airlight is multiplied with
};

layout(std430, set = 0, binding = 0) readonly buffer Rows {
    Row values[];
} rows;

// What has been seen of all lights, for each pixel.
layout(std430, set = 0, binding = 1) buffer Airlight {
    vec4 values[];
} airlight;

layout(push_constant) uniform Settings {
    uint pixels;
    int lights;
    uint stride; // from a light's row of a pixel to the next light's
    uint mask;   // of the row's number
    int steps;
    int repeats; // lights of each row, the next a little farther off the ray than the last
} settings;

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= settings.pixels) { return; }
    vec3 sum = vec3(0.0);
    for (int light = 0; light < settings.lights; ++light) {
        Row row = rows.values[(pixel + uint(light) * settings.stride) & settings.mask];
#if CHANNELS == 3
        Configuration c = Configuration(row.extinction_extent.rgb, row.seen_along.rgb, row.seen_along.w, row.off_weight.x, row.extinction_extent.w);
#else
        Configuration c = Configuration(row.extinction_extent.r, row.seen_along.r, row.seen_along.w, row.off_weight.x, row.extinction_extent.w);
#endif
        for (int repeat = 0; repeat < settings.repeats; ++repeat) {
            sum += row.off_weight.yzw * rival_airlight(c, settings.steps);
            c.off *= 1.001;
        }
    }
    airlight.values[pixel] = vec4(sum, 1.0);
}
