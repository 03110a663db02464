// What the medium before a surface scatters towards the eye of an environment's light. Functions over values, no
// bindings; after `airlight.glsl`, whose rule and mean density it uses.
//
// The environment is far beyond the surface, so that a point x along the ray gets its light after a path of R - x cos g:
//     exp(-T) / (4 pi) Integral of L (1 - exp(-t u)) / u, u = 1 - cos g, t = optical distance of the surface, T of the environment

#define ORDER 3
#include "common/sh_basis.glsl"

// `bands` are the coefficients of the environment's radiance, times the albedo and exp(-T); `optical` is that of the
// surface, at most T.
vec3 fog_environment(vec4 bands[9], vec3 direction, vec3 optical)
{
    float basis[9];
    sh_evaluate(direction, basis);
    vec3 light[3] = vec3[](bands[0].rgb * basis[0], vec3(0.0), vec3(0.0));
    for (int i = 1; i < 9; ++i) { light[i < 4 ? 1 : 2] += bands[i].rgb * basis[i]; }
    vec3 sum = vec3(0.0);
    for (int i = 0; i < FOG_TAPS; ++i) {
        bool mirrored = i >= FOG_TAPS / 2;
        vec2 rule = FOG_RULE[mirrored ? FOG_TAPS - 1 - i : i];
        float u = 2.0 * (mirrored ? 1.0 - rule.x : rule.x);
        float cosine = 1.0 - u;
        vec3 x = optical * u;
        vec3 kernel = optical * vec3(fog_mean_density(x.r), fog_mean_density(x.g), fog_mean_density(x.b));
        sum += rule.y * kernel * (light[0] + cosine * light[1] + (1.5 * cosine * cosine - 0.5) * light[2]);
    }
    // Three bands of a small sun are negative on its far side.
    return max(sum, vec3(0.0));
}
