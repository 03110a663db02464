#version 460
#extension GL_GOOGLE_include_directive : require
// Where the demo host draws the complete model and shows no surface: the airlight of endless rays over darkness.

#define FOG_FRAME_BINDING 9
#define FOG_TAPS 6
#define PHASE_KIND_HENYEY_GREENSTEIN 1
#include "fog/airlight.glsl"
#include "fog/frame.glsl"
#include "fog/view.glsl"

layout(location = 0) in vec3 direction;

layout(location = 0) out vec4 radiance;

void main()
{
    radiance = vec4(fog_before(fog_medium(), vec3(0.0), normalize(direction), 1e32, true), 1.0);
}
