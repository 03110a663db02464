// Half-precision bits rounded to nearest, ties to even: packHalf2x16 may round either way, and does.
// Reading needs nothing of its own: unpackHalf2x16 is exact.

#ifndef COMMON_HALF_GLSL
#define COMMON_HALF_GLSL

// The 16 bits of one number. From 65520 up it becomes infinity; NaN stays NaN.
uint half_bits(float value)
{
    uint bits = floatBitsToUint(value);
    uint sign = (bits >> 16) & 0x8000u;
    uint magnitude = bits & 0x7fffffffu;
    if (magnitude >= 0x47800000u) { // 65536 and more
        return sign | (magnitude > 0x7f800000u ? 0x7e00u : 0x7c00u);
    }
    if (magnitude < 0x38800000u) { // below 2^-14: adding 1/2 shifts the last bit to that of a subnormal, rounded
        precise float shifted = uintBitsToFloat(magnitude) + 0.5;
        return sign | (floatBitsToUint(shifted) - 0x3f000000u);
    }
    uint even = (magnitude >> 13) & 1u;
    return sign | ((magnitude - 0x38000000u + 0xfffu + even) >> 13); // the exponent's bias falls from 127 to 15
}

// Two numbers in one word, the first in the low half.
uint half_pack(vec2 pair)
{
    return half_bits(pair.x) | (half_bits(pair.y) << 16);
}

#endif
