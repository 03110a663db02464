// Where a sphere stands in the sky of a receiver, and which part of it counts (Sun 2008, equation 5.36).

#ifndef SHADOW_CAP_GLSL
#define SHADOW_CAP_GLSL

// Axis of the cap of directions that the sphere hides, and the square of the sine of its angular radius in w, 0 to 1: 1,
// half of the sky, from inside. Nothing is hidden by a sphere of radius 0. Distances from 1e-18 to 1e18.
vec4 shadow_cap(vec3 center, float radius, vec3 receiver)
{
    vec3 towards = center - receiver;
    float square = dot(towards, towards);
    // The centre itself: +Z.
    bool inside = !(square > 1e-37);
    float inverse = inversesqrt(max(square, 1e-37));
    float ratio = radius * inverse;
    return inside ? vec4(0.0, 0.0, 1.0, radius > 0.0 ? 1.0 : 0.0) : vec4(inverse * towards, min(ratio * ratio, 1.0));
}

// The part of a sphere above the tangent plane of a receiver that a surface lies on: a sphere below the plane counts
// nothing, one that pokes through counts as the smaller one between its top and the plane. One whose centre lies below fades
// out towards its own surface, because it stands for the surface itself there. Radius 0: nothing.
// After Ren et al. 2006, section 5.
vec4 shadow_above(vec4 sphere, vec3 receiver, vec3 normal, out float share)
{
    vec3 towards = sphere.xyz - receiver;
    float height = dot(towards, normal);
    share = 1.0;
    if (height >= sphere.w) { return sphere; }
    if (height <= -sphere.w) { return vec4(sphere.xyz, 0.0); }
    float outside = clamp(length(towards) / sphere.w - 1.0, 0.0, 1.0);
    share = mix(outside, 1.0, clamp(height / sphere.w, 0.0, 1.0));
    float radius = 0.5 * (sphere.w + height);
    return vec4(sphere.xyz + (radius - height) * normal, radius);
}

#endif
