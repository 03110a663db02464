// The clamped cosine lobe max(0, n . s) / pi in spherical harmonics: the transfer vector of a diffuse vertex that
// nothing shadows (Ramamoorthi and Hanrahan 2001; Sun 2008, eqs. 2.21-2.25 and 5.14). Its dot product with the
// radiance is the colour of a white diffuse surface.
//
// The includer defines ORDER, a literal from 1 to 6.

#ifndef COMMON_SH_COSINE_GLSL
#define COMMON_SH_COSINE_GLSL

#include "common/sh_basis.glsl"

// The lobe about a unit normal: A_l / pi Y_lm(n), where A_l / pi = 1, 2/3, 1/4, 0, -1/24, 0.
void sh_cosine_lobe(vec3 normal, out float lobe[ORDER * ORDER])
{
    sh_evaluate(normal, lobe);
#if ORDER > 1
    for (int i = 1; i < 4; ++i) { lobe[i] *= 2.0 / 3.0; }
#endif
#if ORDER > 2
    for (int i = 4; i < 9; ++i) { lobe[i] *= 0.25; }
#endif
#if ORDER > 3
    for (int i = 9; i < 16; ++i) { lobe[i] = 0.0; }
#endif
#if ORDER > 4
    for (int i = 16; i < 25; ++i) { lobe[i] *= -1.0 / 24.0; }
#endif
#if ORDER > 5
    for (int i = 25; i < 36; ++i) { lobe[i] = 0.0; }
#endif
}

#endif
