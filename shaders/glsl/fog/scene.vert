#version 460
#extension GL_GOOGLE_include_directive : require
// The demo host's vertices in fog: the complete model at each of them.

#include "host/place.glsl"
