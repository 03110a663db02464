// Where samples of incident radiance are taken, and what each of them holds: passes/radiance/src/gpu/layout.rs.
//
// The includer defines ORDER, 3 to 6.

#ifndef RADIANCE_SAMPLE_GLSL
#define RADIANCE_SAMPLE_GLSL

#define COEFFICIENTS (ORDER * ORDER)

// vec4 of a sample in `lights`: coefficients (RGB, 0), then (solid angle, nearness, how it was found, what it may have changed
// by since it was taken), then (slope RGB, 0).
#define LIGHT_STRIDE (COEFFICIENTS + 2)
#define LIGHT_EXTENT COEFFICIENTS
#define LIGHT_SLOPE (COEFFICIENTS + 1)

// How a sample was found: 0 by a cube map, or
const float EXACT = 1.0; // in closed form
const float KEPT = 2.0; // in an earlier frame by a cube map
const float KEPT_EXACT = 3.0; // in an earlier frame in closed form

// vec4 of a sample in `gradients`: d/dx, d/dy and d/dz (RGB, 0) of the first coefficient, then of the next.
#define GRADIENT_STRIDE (3 * COEFFICIENTS)

// The samples that one dispatch takes: `count` of them from `first` on. The first three words are the arguments of an
// indirect dispatch: a workgroup for each sample.
struct Batch {
    uint count;
    uint height;
    uint depth;
    uint first;
};

// A triangle that emits, or that moved.
struct Glow {
    vec4 place; // centre, metres; area
    vec4 radiance; // RGB
    vec4 moved; // by how far since the last frame, times the radiance that it shows or hides; RGB metres
    vec4 dimmed; // by how much its radiance has changed; RGB
};

#endif
