// How spherical harmonics change with direction. The solid harmonics r^l Y_lm are harmonic polynomials, whose derivatives
// are solid harmonics one band lower (Varshalovich, Moskalev, Khersonskii, "Quantum Theory of Angular Momentum", 1988,
// section 5.8): no angle, no pole. passes/radiance/src/reference/slope.rs is the same in f64.

#ifndef RADIANCE_SLOPE_GLSL
#define RADIANCE_SLOPE_GLSL

float sh_ladder(int l, int square)
{
    return sqrt(float((2 * l + 1) * square) / float(2 * l - 1));
}

// The two functions of order m in band l - 1 as parts of a complex number; for m = 0 real, times sqrt(2).
#define SH_BELOW(values, l, m) \
    ((m) >= (l) ? vec2(0.0) \
     : (m) == 0 ? vec2(1.41421356237310 * values[((l) - 1) * (l)], 0.0) \
                : vec2(values[((l) - 1) * (l) + (m)], values[((l) - 1) * (l) - (m)]))

// Gradients of the basis on the unit sphere at the unit `direction`, where its values are `values`; tangent vectors.
void sh_slopes(vec3 direction, float values[ORDER * ORDER], out vec3 slopes[ORDER * ORDER])
{
    slopes[0] = vec3(0.0);
    [[unroll]] for (int l = 1; l < ORDER; ++l) {
        vec3 radial = float(l) * direction; // of r^l
        [[unroll]] for (int m = 0; m <= l; ++m) {
            vec2 raised = 0.5 * sh_ladder(l, (l - m) * max(l - m - 1, 0)) * SH_BELOW(values, l, m + 1);
            float along = sh_ladder(l, l * l - m * m);
            int middle = l * (l + 1);
            if (m == 0) {
                vec2 across = 1.41421356237310 * raised;
                slopes[middle] = vec3(across, along * values[(l - 1) * l]) - radial * values[middle];
                continue;
            }
            vec2 lowered = 0.5 * sh_ladder(l, (l + m) * (l + m - 1)) * SH_BELOW(values, l, m - 1);
            vec2 level = m < l ? along * SH_BELOW(values, l, m) : vec2(0.0);
            vec3 cosine = vec3(raised.x - lowered.x, raised.y + lowered.y, level.x);
            vec3 sine = vec3(raised.y - lowered.y, -raised.x - lowered.x, level.y);
            slopes[middle + m] = cosine - radial * values[middle + m];
            slopes[middle - m] = sine - radial * values[middle - m];
        }
    }
}

#endif
