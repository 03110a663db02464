// The product of two functions given by spherical harmonics, projected on the same bands, by the sparse triple
// product tensor (Sun 2008, equation 5.9): h_i = sum over (j, k) of gamma_ijk f_j g_k.
//
// The entries are sorted by i, then j, then k, and lie where the includer says, because no shader array is as fast
// everywhere as a buffer. It defines
//   SH_TENSOR_FIRST(i)    uint   where the entries of coefficient i begin; i up to and including ORDER^2
//   SH_TENSOR_PAIR(at)    uint   j in the low 16 bits, k in the high ones, of entry `at`
//   SH_TENSOR_GAMMA(at)   float  gamma of entry `at`
//   SH_LEFT(j)            float  coefficient j of f
//   SH_RIGHT(k)           float  coefficient k of g

#ifndef COMMON_SH_PRODUCT_GLSL
#define COMMON_SH_PRODUCT_GLSL

#if !defined(SH_TENSOR_FIRST) || !defined(SH_TENSOR_PAIR) || !defined(SH_TENSOR_GAMMA)
#error sh_product.glsl: define SH_TENSOR_FIRST, SH_TENSOR_PAIR and SH_TENSOR_GAMMA
#endif
#if !defined(SH_LEFT) || !defined(SH_RIGHT)
#error sh_product.glsl: define SH_LEFT and SH_RIGHT
#endif

// Coefficient i of the product.
float sh_product(uint i)
{
    precise float sum = 0.0;
    for (uint at = SH_TENSOR_FIRST(i); at < SH_TENSOR_FIRST(i + 1u); ++at) {
        uint pair = SH_TENSOR_PAIR(at);
        precise float term = SH_LEFT(pair & 0xffffu) * SH_RIGHT(pair >> 16);
        sum = fma(SH_TENSOR_GAMMA(at), term, sum);
    }
    return sum;
}

#endif
