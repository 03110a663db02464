// What all draws of one view share: set 0, binding 0.

layout(std140, set = 0, binding = 0) uniform Frame {
    mat4 clip_from_world;
    // A point of the near plane to its direction from the camera, in the world.
    mat4 direction_from_clip;
    // A direction of the world to one of the environment map.
    mat4 map_from_world;
    // Where the camera is in the world; w unused.
    vec4 eye;
    // Radiance of a white diffuse surface where no pass lights it; w unused.
    vec4 ambient;
} frame;
