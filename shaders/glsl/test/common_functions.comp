#version 460
#extension GL_GOOGLE_include_directive : require
// Calls the functions of common/ for a test that compares them with f64: one row of results an invocation.

#define ORDER 6
#include "common/cube.glsl"
#include "common/depth.glsl"
#include "common/equirect.glsl"
#include "common/false_colour.glsl"
#include "common/half.glsl"
#include "common/sh_basis.glsl"
#include "common/tone_map.glsl"

layout(local_size_x = 64) in;

struct Input {
    vec4 direction; // unit; w a depth value
    vec4 color; // linear RGB, not negative; w a number to halve
    vec4 depth_coefficients;
};

layout(std430, set = 0, binding = 0) readonly buffer Inputs {
    Input rows[];
} inputs;

struct Result {
    float basis[36];
    vec2 equirect;
    vec2 cube;
    vec3 equirect_direction;
    float face;
    vec3 cube_direction;
    uint half_bits;
    vec3 display;
    float angle; // of (x, y)
    vec3 encoded;
    float view_distance;
    vec3 decoded;
    float padding;
    vec3 false_colour; // of x, between -0.8 and 0.8
    float not_a_number; // the red of its colour
};

layout(std430, set = 0, binding = 1) buffer Results {
    Result rows[];
} results;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(inputs.rows.length())) { return; }
    vec3 direction = inputs.rows[i].direction.xyz;
    float basis[36];
    sh_evaluate(direction, basis);
    for (int k = 0; k < 36; ++k) { results.rows[i].basis[k] = basis[k]; }
    vec2 uv = equirect_uv(direction);
    results.rows[i].equirect = uv;
    results.rows[i].equirect_direction = equirect_direction(uv);
    vec3 place = cube_place(direction);
    results.rows[i].cube = place.xy;
    results.rows[i].face = place.z;
    results.rows[i].cube_direction = normalize(cube_direction(uint(place.z), place.xy));
    results.rows[i].angle = angle_of(direction.y, direction.x);
    vec4 color = inputs.rows[i].color;
    results.rows[i].view_distance =
        depth_view_distance(inputs.rows[i].direction.w, inputs.rows[i].depth_coefficients);
    results.rows[i].half_bits = half_bits(color.w);
    vec3 display = tone_map(color.rgb);
    results.rows[i].display = display;
    results.rows[i].encoded = srgb_encode(display);
    results.rows[i].decoded = srgb_decode(results.rows[i].encoded);
    results.rows[i].false_colour = false_colour(direction.x, -0.8, 0.8);
    results.rows[i].not_a_number = false_colour(uintBitsToFloat(0x7fc00000u | floatBitsToUint(direction.x))).r;
}
