// What the passes of a frame share: set 0, binding 0.

const int FOG_LIGHTS = 64;

layout(std140, set = 0, binding = 0) uniform Frame {
    // Start and direction of a view ray, relative to the eye, both linear in the place in the picture: at its upper
    // left, and the change to its right and lower edges. start[0].w: 1 where the starts differ.
    vec4 start[3];
    vec4 direction[3];
    vec4 depth;      // coefficients of common/depth.glsl
    vec4 extinction; // 1/m; w: 1 over the scale height
    vec4 scattering; // 1/m; w: what radiance is multiplied with for the host
    vec4 phase;
    uvec2 size;      // pixels
    int light_count;
    float farthest;  // the depth where there is no surface
    FogLight lights[FOG_LIGHTS];
} frame;
