// The transfer vectors of vertices that nothing shadows, made from their current normals in place of baked ones:
// the clamped cosine lobe over pi. For meshes that are skinned, and for those without a bake.

#include "relight/chunk.glsl"
#include "common/sh_cosine.glsl"

#define BLOCKS ((COEFFICIENTS + 3) / 4)

// Three floats a vertex, of any length; one vertex after another.
layout(std430, set = 0, binding = 0) readonly buffer Normals {
    float values[];
} normals;

// The transfer vector of this invocation's vertex.
float lobe[COEFFICIENTS];

// Makes the vector of a vertex. Without a normal there is no surface to light: the vector is zero.
void load_transfer(uint vertex)
{
    uint first = 3u * vertex;
    vec3 normal = vec3(normals.values[first], normals.values[first + 1u], normals.values[first + 2u]);
    // Dividing first keeps the square of a very long or short normal in range.
    float largest = max(abs(normal.x), max(abs(normal.y), abs(normal.z)));
    if (largest > 0.0) {
        sh_cosine_lobe(normalize(normal / largest), lobe);
    } else {
        for (uint i = 0u; i < uint(COEFFICIENTS); ++i) { lobe[i] = 0.0; }
    }
}

float transfer_coefficient(uint vertex, uint index)
{
    return lobe[index];
}

// Coefficients 4 block .. 4 block + 3; those past the last are zero.
vec4 transfer_block(uint vertex, uint block)
{
    uint first = 4u * block;
    vec4 result = vec4(lobe[first], 0.0, 0.0, 0.0);
    if (first + 1u < uint(COEFFICIENTS)) { result.y = lobe[first + 1u]; }
    if (first + 2u < uint(COEFFICIENTS)) { result.z = lobe[first + 2u]; }
    if (first + 3u < uint(COEFFICIENTS)) { result.w = lobe[first + 3u]; }
    return result;
}
