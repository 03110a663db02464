// Real orthonormal spherical harmonics to order 6, as polynomials of the unit direction factored in z and in
// the real and imaginary parts of (x + iy)^m (Sloan, "Efficient Spherical Harmonic Evaluation", JCGT 2013).
// Polar axis +z, index l (l + 1) + m, the sign (-1)^m kept for every m (CONVENTIONS.md).
//
// The includer defines ORDER, a literal from 1 to 6: bands 0 .. ORDER - 1, ORDER^2 coefficients.

#ifndef COMMON_SH_BASIS_GLSL
#define COMMON_SH_BASIS_GLSL

#if !defined(ORDER) || ORDER < 1 || ORDER > 6
#error sh_basis.glsl: define ORDER as 1, 2, 3, 4, 5 or 6
#endif

// All basis functions at a unit direction.
void sh_evaluate(vec3 direction, out float basis[ORDER * ORDER])
{
    basis[0] = 0.282094791773878;
#if ORDER > 1
    float x = direction.x;
    float y = direction.y;
    float z = direction.z;
    basis[1] = -0.488602511902920 * y;
    basis[2] = 0.488602511902920 * z;
    basis[3] = -0.488602511902920 * x;
#endif
#if ORDER > 2
    float z2 = z * z;
    float c2 = x * x - y * y;
    float s2 = 2.0 * x * y;
    float p21 = -1.09254843059208 * z;
    basis[4] = 0.546274215296040 * s2;
    basis[5] = p21 * y;
    basis[6] = 0.946174695757560 * z2 - 0.315391565252520;
    basis[7] = p21 * x;
    basis[8] = 0.546274215296040 * c2;
#endif
#if ORDER > 3
    float c3 = x * c2 - y * s2;
    float s3 = x * s2 + y * c2;
    float p31 = -2.28522899732233 * z2 + 0.457045799464466;
    float p32 = 1.44530572132028 * z;
    basis[9] = -0.590043589926644 * s3;
    basis[10] = p32 * s2;
    basis[11] = p31 * y;
    basis[12] = z * (1.86588166295058 * z2 - 1.11952899777035);
    basis[13] = p31 * x;
    basis[14] = p32 * c2;
    basis[15] = -0.590043589926644 * c3;
#endif
#if ORDER > 4
    float c4 = x * c3 - y * s3;
    float s4 = x * s3 + y * c3;
    float p41 = z * (-4.68332580490102 * z2 + 2.00713963067187);
    float p42 = 3.31161143515146 * z2 - 0.473087347878780;
    float p43 = -1.77013076977993 * z;
    basis[16] = 0.625835735449176 * s4;
    basis[17] = p43 * s3;
    basis[18] = p42 * s2;
    basis[19] = p41 * y;
    basis[20] = z2 * (3.70249414203215 * z2 - 3.17356640745613) + 0.317356640745613;
    basis[21] = p41 * x;
    basis[22] = p42 * c2;
    basis[23] = p43 * c3;
    basis[24] = 0.625835735449176 * c4;
#endif
#if ORDER > 5
    float c5 = x * c4 - y * s4;
    float s5 = x * s4 + y * c4;
    float p51 = z2 * (-9.51187967510964 * z2 + 6.34125311673976) - 0.452946651195697;
    float p52 = z * (7.19030517745999 * z2 - 2.39676839248666);
    float p53 = -4.40314469491726 * z2 + 0.489238299435251;
    float p54 = 2.07566231488104 * z;
    basis[25] = -0.656382056840170 * s5;
    basis[26] = p54 * s4;
    basis[27] = p53 * s3;
    basis[28] = p52 * s2;
    basis[29] = p51 * y;
    basis[30] = z * (z2 * (7.36787031456569 * z2 - 8.18652257173965) + 1.75425483680135);
    basis[31] = p51 * x;
    basis[32] = p52 * c2;
    basis[33] = p53 * c3;
    basis[34] = p54 * c4;
    basis[35] = -0.656382056840170 * c5;
#endif
}

#endif
