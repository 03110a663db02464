#version 460
#extension GL_GOOGLE_include_directive : require
// The demo host's forward draw in fog: with AIRGLOW_FOG it calls the functions of this room.

#include "host/scene.glsl"
