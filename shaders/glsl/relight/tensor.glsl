// The sparse SH triple-product tensor (Sun 2008, eq. 5.9) in a buffer: the entries (i, j, k) sorted by i, then j,
// then k, and the macros by which common/sh_product.glsl reads it.
// TENSOR_BINDING names the binding of set 0.

struct TensorEntry {
    uint pair; // j in the low half, k in the high half
    float gamma;
};

layout(std430, set = 0, binding = TENSOR_BINDING) readonly buffer Tensor {
    uint first[COEFFICIENTS + 1]; // where the entries of i begin
    TensorEntry entries[];
} tensor;

#define SH_TENSOR_FIRST(i) tensor.first[i]
#define SH_TENSOR_PAIR(at) tensor.entries[at].pair
#define SH_TENSOR_GAMMA(at) tensor.entries[at].gamma
