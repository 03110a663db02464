#version 460
#extension GL_GOOGLE_include_directive : require
// The forward draw in clear air.

#include "host/scene.glsl"
