// Sums over caps of factors of their bands times the basis functions of their axes, the rotation of a zonal function (Sun
// 2008, equation 5.36): two caps at once, so that a sum is read and written once for both.
//
// The basis functions are those of common/sh_basis.glsl without their constants, which are multiplied in once, with
// `sums_finish`, after all caps. The includer defines ORDER and COUNT.

#ifndef SHADOW_SUMS_GLSL
#define SHADOW_SUMS_GLSL

// Adds caps of unit axes.
void sums_add(vec2 bands[ORDER], vec2 x, vec2 y, vec2 z, inout float sum[COUNT])
{
#define ADD(i, values)                                                                                                  \
    {                                                                                                                   \
        vec2 both = values;                                                                                             \
        sum[i] += both.x + both.y;                                                                                      \
    }
    vec2 b = bands[1];
    ADD(0, bands[0])
    ADD(1, b * y)
    ADD(2, b * z)
    ADD(3, b * x)
    vec2 xx = x * x;
    vec2 yy = y * y;
    vec2 zz = z * z;
    vec2 xy = x * y;
    vec2 c2 = xx - yy;
    b = bands[2];
    vec2 bz = b * z;
    ADD(4, b * xy)
    ADD(5, bz * y)
    ADD(6, b * (zz - 0.333333333))
    ADD(7, bz * x)
    ADD(8, b * c2)
#if ORDER > 3
    vec2 c3 = x * (xx - 3.0 * yy);
    vec2 s3 = y * (3.0 * xx - yy);
    b = bands[3];
    bz = b * z;
    vec2 p = b * (zz - 0.2);
    ADD(9, b * s3)
    ADD(10, bz * xy)
    ADD(11, p * y)
    ADD(12, bz * (zz - 0.6))
    ADD(13, p * x)
    ADD(14, bz * c2)
    ADD(15, b * c3)
#endif
#if ORDER > 4
    vec2 s4 = xy * c2; // a fourth of the imaginary part
    vec2 c4 = c2 * c2 - 4.0 * xy * xy;
    b = bands[4];
    bz = b * z;
    p = b * (zz - 0.142857143);
    vec2 q = bz * (zz - 0.428571429);
    ADD(16, b * s4)
    ADD(17, bz * s3)
    ADD(18, p * xy)
    ADD(19, q * y)
    ADD(20, b * (zz * (zz - 0.857142857) + 0.0857142857))
    ADD(21, q * x)
    ADD(22, p * c2)
    ADD(23, bz * c3)
    ADD(24, b * c4)
#endif
#if ORDER > 5
    vec2 s4_whole = 4.0 * s4;
    b = bands[5];
    bz = b * z;
    p = b * (zz - 0.111111111);
    q = bz * (zz - 0.333333333);
    vec2 r = b * (zz * (zz - 0.666666667) + 0.0476190476);
    ADD(25, b * (x * s4_whole + y * c4))
    ADD(26, bz * s4)
    ADD(27, p * s3)
    ADD(28, q * xy)
    ADD(29, r * y)
    ADD(30, bz * (zz * (zz - 1.11111111) + 0.238095238))
    ADD(31, r * x)
    ADD(32, q * c2)
    ADD(33, p * c3)
    ADD(34, bz * c4)
    ADD(35, b * (x * c4 - y * s4_whole))
#endif
#undef ADD
}

// Multiplies the constants in.
void sums_finish(inout float sum[COUNT])
{
#define SCALE(a, b, factor)                                                                                             \
    sum[a] *= factor;                                                                                                   \
    if (b != a) { sum[b] *= factor; }
    SCALE(0, 0, 0.282094791773878)
    SCALE(1, 3, -0.488602511902920)
    SCALE(2, 2, 0.488602511902920)
    SCALE(4, 4, 1.09254843059208)
    SCALE(5, 7, -1.09254843059208)
    SCALE(6, 6, 0.946174695757560)
    SCALE(8, 8, 0.546274215296040)
#if ORDER > 3
    SCALE(9, 15, -0.590043589926644)
    SCALE(10, 10, 2.89061144264055)
    SCALE(11, 13, -2.28522899732233)
    SCALE(12, 12, 1.86588166295058)
    SCALE(14, 14, 1.44530572132028)
#endif
#if ORDER > 4
    SCALE(16, 16, 2.50334294179670)
    SCALE(17, 23, -1.77013076977993)
    SCALE(18, 18, 6.62322287030292)
    SCALE(19, 21, -4.68332580490102)
    SCALE(20, 20, 3.70249414203215)
    SCALE(22, 22, 3.31161143515146)
    SCALE(24, 24, 0.625835735449176)
#endif
#if ORDER > 5
    SCALE(25, 35, -0.656382056840170)
    SCALE(26, 26, 8.30264925952416)
    SCALE(27, 33, -4.40314469491726)
    SCALE(28, 28, 14.3806103549200)
    SCALE(29, 31, -9.51187967510964)
    SCALE(30, 30, 7.36787031456569)
    SCALE(32, 32, 7.19030517745999)
    SCALE(34, 34, 2.07566231488104)
#endif
#undef SCALE
}

#endif
