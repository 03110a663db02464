#ifndef FOG_LIGHT_GLSL
#define FOG_LIGHT_GLSL

// A light, relative to the eye.
struct FogLight {
    vec4 position_radius;  // m
    vec4 intensity_reach;  // W/sr, see fog_seen; least distance along a ray at which it is evaluated
    vec4 axis_cosine;      // of a spot's cone, away from the light; cosine of its half angle, -2 for none
    vec4 falloff_range;    // scale and offset of the cosine; range, m, 0 for none; 1 where it shines within a box
    vec4 low;              // corners of the box
    vec4 high;             // w: metres of the way to the eye that are not in the intensity, 0 after fog_seen
};

#endif
