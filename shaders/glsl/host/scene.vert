#version 460
#extension GL_GOOGLE_include_directive : require
// The forward draw's vertices.

#include "host/place.glsl"
