// What the passes of a frame share: set 0, binding FOG_FRAME_BINDING, 0 unless the includer defines another.

#include "fog/light.glsl"

#ifndef FOG_FRAME_BINDING
#define FOG_FRAME_BINDING 0
#endif

const int FOG_LIGHTS = 64;

layout(std140, set = 0, binding = FOG_FRAME_BINDING) uniform FogFrame {
    // Start and direction of a view ray, relative to the eye, both linear in the place in the picture: at its upper
    // left, and the change to its right and lower edges. start[0].w: 1 where the starts differ; start[1].w: pixels along
    // a side of a tile.
    vec4 start[3];
    vec4 direction[3];
    vec4 depth;      // coefficients of common/depth.glsl
    vec4 extinction; // 1/m; w: 1 over the scale height
    vec4 scattering; // 1/m; w: what radiance is multiplied with for the host
    vec4 phase;
    uvec2 size;      // pixels
    int light_count;
    float farthest;  // the depth where there is no surface
    // Coefficients of the environment's radiance, times the albedo and what is left of it; w of the first three: its
    // optical distance.
    vec4 environment[9];
    FogLight lights[FOG_LIGHTS];
} fog;
