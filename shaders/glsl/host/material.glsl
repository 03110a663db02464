// One draw: where the mesh stands and what it is made of.

layout(push_constant) uniform Material {
    mat4 world_from_object;
    // Linear base colour and alpha, multiplied with the texture.
    vec4 base_colour;
    // Emitted radiance; w: alpha below which the surface is a hole, 0 for none.
    vec4 emissive_cutoff;
    // Rows of the linear part of the texture coordinates' transform.
    vec4 uv_linear;
    vec2 uv_offset;
    // Lowest bit: unlit, the base colour is the picture. In fog, from bit 8 and 16 on: tables of the diffuse and the
    // specular lobe.
    uint flags;
    // Halves: metallic, roughness.
    uint surface;
} material;
