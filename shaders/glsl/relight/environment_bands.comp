#version 460
// Second half of the exact projection: one workgroup a coefficient (l, m), the sum over the rows of the row integral
// of the normalised Legendre function times the row's sum, in a fixed order. The result is in the frame whose polar
// axis is that of the map.
//
// ORDER  1-6

#define AZIMUTHS (2 * ORDER - 1)
#define LATITUDES (ORDER * (ORDER + 1) / 2)
#define WORKGROUP 128
#define RUN 16

layout(local_size_x = WORKGROUP) in;

// [row][l (l + 1) / 2 + |m|].
layout(std430, set = 0, binding = 0) readonly buffer Latitudes {
    float integrals[];
} latitudes;

// [row][m + ORDER - 1].
layout(std430, set = 0, binding = 1) readonly buffer Rows {
    vec4 sums[];
} rows;

layout(std430, set = 0, binding = 2) buffer Coefficients {
    vec4 values[];
} coefficients;

layout(push_constant) uniform Size {
    uint width;
    uint height;
} size;

shared vec4 partial[WORKGROUP];

void main()
{
    uint i = gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
    uint l = 0u;
    while ((l + 1u) * (l + 1u) <= i) { ++l; }
    int m = int(i) - int(l * (l + 1u));
    uint latitude = l * (l + 1u) / 2u + uint(abs(m));
    uint azimuth = uint(m + ORDER - 1);
    vec3 total = vec3(0.0);
    for (uint first = lane; first < size.height; first += uint(RUN * WORKGROUP)) {
        vec3 run = vec3(0.0);
        for (uint k = 0u; k < uint(RUN); ++k) {
            uint row = first + k * uint(WORKGROUP);
            if (row < size.height) {
                float integral = latitudes.integrals[row * uint(LATITUDES) + latitude];
                run = fma(vec3(integral), rows.sums[row * uint(AZIMUTHS) + azimuth].rgb, run);
            }
        }
        total += run;
    }
    partial[lane] = vec4(total, 0.0);
    for (uint half_count = uint(WORKGROUP) / 2u; half_count > 0u; half_count /= 2u) {
        barrier();
        if (lane < half_count) { partial[lane] += partial[lane + half_count]; }
    }
    barrier();
    if (lane == 0u) { coefficients.values[i] = partial[0]; }
}
