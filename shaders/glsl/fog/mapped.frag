#version 460
#extension GL_GOOGLE_include_directive : require
// The demo host's forward draw of surfaces with normal maps in fog: with AIRGLOW_FOG and AIRGLOW_NORMALS it calls the
// functions of both rooms.

#include "host/scene.glsl"
