// Equirectangular maps: the centre looks down -z, u grows towards +x, the first row is +y (CONVENTIONS.md).

#ifndef COMMON_EQUIRECT_GLSL
#define COMMON_EQUIRECT_GLSL

#include "common/angle.glsl"

// The unit direction of (u, v) in [0, 1]^2, v down.
vec3 equirect_direction(vec2 uv)
{
    float phi = TWO_PI * (uv.x - 0.5);
    float theta = PI * uv.y;
    float ring = sin(theta);
    return vec3(ring * sin(phi), cos(theta), -ring * cos(phi));
}

// The place of a direction of any length but zero, in [0, 1]^2; a pole gets u = 1/2.
vec2 equirect_uv(vec3 direction)
{
    float phi = angle_of(direction.x, -direction.z);
    float theta = angle_of(length(direction.xz), direction.y);
    return vec2(phi / TWO_PI + 0.5, theta / PI);
}

#endif
