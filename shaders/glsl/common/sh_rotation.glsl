// Rotation matrices of real spherical harmonics, band by band from the rotation of space: Ivanic and
// Ruedenberg, "Rotation Matrices for Real Spherical Harmonics. Direct Determination by Recursion" (J. Phys.
// Chem. 100, 1996), equation 8.1 and Tables 1 and 2 with the corrections of J. Phys. Chem. A 102 (1998); V for
// m < 0 has the factor sqrt(1 + delta_{m,-1}).
//
// One workgroup makes the matrices together in memory that it shares. The includer defines
//   ORDER            a literal from 1 to 6
//   SH_ROTATION(i)   element i of a float array of SH_ROTATION_COUNT, usually in shared memory
// then calls sh_rotation_build from every invocation and reads sh_rotation_at. Loops are kept as loops: unrolled,
// the recursion takes software drivers most of a second to compile.

#ifndef COMMON_SH_ROTATION_GLSL
#define COMMON_SH_ROTATION_GLSL

#if !defined(ORDER) || ORDER < 1 || ORDER > 6
#error sh_rotation.glsl: define ORDER as 1, 2, 3, 4, 5 or 6
#endif
#ifndef SH_ROTATION
#error sh_rotation.glsl: define SH_ROTATION(i) as element i of an array of SH_ROTATION_COUNT floats
#endif

#define SH_ROTATION_COUNT (ORDER * (4 * ORDER * ORDER - 1) / 3)

// Where element (m, n) of band l stands: bands one after another, each row-major with rows and columns from -l.
int sh_rotation_index(int l, int m, int n)
{
    return l * (4 * l * l - 1) / 3 + (m + l) * (2 * l + 1) + n + l;
}

// Element (m, n) as the paper has it, without the sign (-1)^(m + n) of our basis.
float sh_rotation_unsigned(int l, int m, int n)
{
    return SH_ROTATION(sh_rotation_index(l, m, n));
}

// P of Table 2: products of band 1 with the band below l.
float sh_rotation_p(int l, int i, int mu, int n)
{
    int k = l - 1;
    if (n == l) {
        return sh_rotation_unsigned(1, i, 1) * sh_rotation_unsigned(k, mu, k)
            - sh_rotation_unsigned(1, i, -1) * sh_rotation_unsigned(k, mu, -k);
    }
    if (n == -l) {
        return sh_rotation_unsigned(1, i, 1) * sh_rotation_unsigned(k, mu, -k)
            + sh_rotation_unsigned(1, i, -1) * sh_rotation_unsigned(k, mu, k);
    }
    return sh_rotation_unsigned(1, i, 0) * sh_rotation_unsigned(k, mu, n);
}

// Element (m, n) of a band l >= 2, from bands 1 and l - 1. A term whose weight is zero would read outside the
// band below, so it is not computed.
float sh_rotation_element(int l, int m, int n)
{
    int a = abs(m);
    int side = m < 0 ? -1 : 1;
    float scale = inversesqrt(float(abs(n) == l ? 2 * l * (2 * l - 1) : (l + n) * (l - n)));
    float sum = 0.0;
    if (a < l) {
        sum += sqrt(float((l + m) * (l - m))) * sh_rotation_p(l, 0, m, n);
    }
    if (m == 0) {
        float v = sh_rotation_p(l, 1, 1, n) + sh_rotation_p(l, -1, -1, n);
        return (sum - 0.5 * sqrt(float(2 * l * (l - 1))) * v) * scale;
    }
    // With s the sign of m: V is p(s, |m| - 1) - p(-s, ...) for m > 0 and their sum for m < 0, one term at |m| = 1.
    float v = a == 1 ? 1.41421356237310 * sh_rotation_p(l, side, 0, n)
        : sh_rotation_p(l, 1, m - side, n) - float(side) * sh_rotation_p(l, -1, side - m, n);
    sum += 0.5 * sqrt(float((l + a - 1) * (l + a))) * v;
    if (a < l - 1) {
        float w = sh_rotation_p(l, 1, m + side, n) + float(side) * sh_rotation_p(l, -1, -m - side, n);
        sum -= 0.5 * sqrt(float((l - a - 1) * (l - a))) * w;
    }
    return sum * scale;
}

// Makes all bands. `rotation` takes a direction to its rotated place; `invocation` counts the `invocations` of
// the workgroup, all of which must call this together; it ends with a barrier.
void sh_rotation_build(mat3 rotation, uint invocation, uint invocations)
{
    if (invocation == 0u) {
        SH_ROTATION(0) = 1.0;
    }
#if ORDER > 1
    // Band 1 is the rotation itself, its axes in the order y, z, x.
    for (uint i = invocation; i < 9u; i += invocations) {
        uint row = i / 3u;
        uint column = i % 3u;
        SH_ROTATION(1u + i) = rotation[(column + 1u) % 3u][(row + 1u) % 3u];
    }
#endif
    barrier();
    for (int l = 2; l < ORDER; ++l) {
        uint width = uint(2 * l + 1);
        for (uint i = invocation; i < width * width; i += invocations) {
            int m = int(i / width) - l;
            int n = int(i % width) - l;
            SH_ROTATION(sh_rotation_index(l, m, n)) = sh_rotation_element(l, m, n);
        }
        barrier();
    }
}

// The factor of input coefficient (l, n) in output coefficient (l, m): rotated(s) = f(rotation^-1 s).
float sh_rotation_at(int l, int m, int n)
{
    float element = sh_rotation_unsigned(l, m, n);
    return ((m + n) & 1) == 0 ? element : -element;
}

// The band of coefficient `index`: the integer square root.
int sh_band(uint index)
{
    return int(sqrt(float(index) + 0.5)); // the half keeps an inexact root of a square from falling below it
}

#endif
