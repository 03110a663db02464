// What shines on a surface beside what the passes wrote for its vertices, for the stage that shades it.
//
// FOG_COMPLETE 1 or 2: and what the medium leaves of it on its way to the eye and adds there: Sun 2008, eq. 3.29.

#if HOST_LIGHTS
#if AIRGLOW_FOG
layout(std430, set = 0, binding = 4) readonly buffer Lobes {
    float entries[];
} lobes;

#define FOG_LOBE_SIZE 64
#define FOG_LOBE_ENTRY(i) lobes.entries[i]
#include "fog/surface.glsl"
#endif
#include "host/lights.glsl"
#endif

#if FOG_COMPLETE
#define FOG_FRAME_BINDING 9
#define FOG_TAPS 6
#define PHASE_KIND_HENYEY_GREENSTEIN 1
#include "fog/airlight.glsl"
#include "fog/frame.glsl"
#include "fog/view.glsl"

// What is left of a surface's light at the eye, and what the medium adds; `way` leads from the eye to the surface.
void complete(vec3 way, out vec3 left, out vec3 before)
{
    float distance = length(way);
    vec3 direction = way / distance;
    FogMedium medium = fog_medium();
    left = fog_left(medium, direction, distance, false);
    before = fog_before(medium, vec3(0.0), direction, distance, false);
}
#endif
