// A view through the medium, as functions over the frame's constants: for the pass, and for a forward shader of a host
// that draws the complete model of a surface (Sun 2008, eq. 3.29) at once.
//
// The includer includes `airlight.glsl` and `frame.glsl` before, and may define
//   FOG_ENVIRONMENT  1: behind the surfaces the picture shows an environment through the medium already, and before them
//                    the medium scatters its light, too

#ifndef FOG_VIEW_GLSL
#define FOG_VIEW_GLSL

#if FOG_ENVIRONMENT
#include "fog/environment.glsl"
#endif

FogMedium fog_medium()
{
    return FogMedium(fog.extinction.rgb, fog.scattering.rgb, fog.phase, fog.extinction.w);
}

// What is left of the light of what lies behind a stretch of the view ray; `endless` where there is no surface.
vec3 fog_left(FogMedium medium, vec3 direction, float distance, bool endless)
{
#if FOG_ENVIRONMENT
    if (endless) { return vec3(1.0); }
#endif
    return fog_transmittance(medium, direction, distance);
}

// The airlight of light `i` before the end of that stretch. `start` is where a parallel view ray starts, relative to the
// eye.
vec3 fog_of_light(FogMedium medium, vec3 start, vec3 direction, float distance, int i)
{
    FogLight light = fog.lights[i];
    // Parallel rays have an eye each, and lights all of their way there before them.
    light.position_radius.xyz -= start;
#if !FOG_POINTS
    light.low.xyz -= start;
    light.high.xyz -= start;
#endif
    light.high.w = fog.start[0].w * length(light.position_radius);
    // Farther off the ray than this its airlight is below the bound.
    if (dot(light.position_radius.xyz, direction) < light.intensity_reach.w) { return vec3(0.0); }
    return fog_airlight(medium, light, i, direction, distance);
}

// What of the environment's light the medium scatters towards the eye before it.
vec3 fog_of_environment(FogMedium medium, vec3 direction, float distance, bool endless)
{
#if FOG_ENVIRONMENT
    if (!endless) {
        vec3 most = vec3(fog.environment[0].w, fog.environment[1].w, fog.environment[2].w);
        return fog_environment(fog.environment, direction, min(medium.extinction * distance, most));
    }
#endif
    return vec3(0.0);
}

// All that the medium scatters towards the eye before it, for the host.
vec3 fog_before(FogMedium medium, vec3 start, vec3 direction, float distance, bool endless)
{
    vec3 airlight = fog_of_environment(medium, direction, distance, endless);
    for (int i = 0; i < fog.light_count; ++i) {
        airlight += fog_of_light(medium, start, direction, distance, i);
    }
    return fog.scattering.w * airlight;
}

#endif
