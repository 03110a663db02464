#version 460
#extension GL_GOOGLE_include_directive : require
// The demo host's forward draw of surfaces with normal maps: with AIRGLOW_NORMALS it calls the functions of this room.

#include "host/scene.glsl"
