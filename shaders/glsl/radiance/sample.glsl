// Where samples of incident radiance are taken, and what each of them holds: passes/radiance/src/gpu/layout.rs.
//
// The includer defines ORDER, 3 to 6.

#ifndef RADIANCE_SAMPLE_GLSL
#define RADIANCE_SAMPLE_GLSL

#define COEFFICIENTS (ORDER * ORDER)

// vec4 of a sample in `lights`: coefficients (RGB, 0), then (solid angle, nearness, 1 where
// they are exact, 0), then (slope RGB, 0).
#define LIGHT_STRIDE (COEFFICIENTS + 2)
#define LIGHT_EXTENT COEFFICIENTS
#define LIGHT_SLOPE (COEFFICIENTS + 1)

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

#endif
