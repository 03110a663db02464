// On which side of an edge a ray passes, where single precision cannot tell: in sums of two floats, 48 bits (Dekker, "A
// Floating-Point Technique for Extending the Available Precision", 1971; Shewchuk, "Adaptive Precision Floating-Point
// Arithmetic and Fast Robust Geometric Predicates", 1997, whose filter decides when to ask).

#ifndef RADIANCE_EXACT_GLSL
#define RADIANCE_EXACT_GLSL

// The sum, rounded, and what rounding took away.
vec2 exact_sum(float a, float b)
{
    precise float sum = a + b;
    precise float second = sum - a;
    precise float first = sum - second;
    precise float rest = (a - first) + (b - second);
    return vec2(sum, rest);
}

// The upper and the lower half of a float's bits.
vec2 exact_halves(float a)
{
    precise float shifted = 4097.0 * a;
    precise float upper = shifted - (shifted - a);
    precise float lower = a - upper;
    return vec2(upper, lower);
}

// The product, rounded, and what rounding took away.
vec2 exact_product(float a, float b)
{
    vec2 x = exact_halves(a);
    vec2 y = exact_halves(b);
    precise float product = a * b;
    precise float rest = x.y * y.y - (((product - x.x * y.x) - x.y * y.x) - x.x * y.y);
    return vec2(product, rest);
}

vec2 pair_sum(vec2 a, vec2 b)
{
    vec2 sum = exact_sum(a.x, b.x);
    precise float rest = sum.y + (a.y + b.y);
    return exact_sum(sum.x, rest);
}

vec2 pair_product(vec2 a, vec2 b)
{
    vec2 product = exact_product(a.x, b.x);
    precise float rest = product.y + (a.x * b.y + a.y * b.x);
    return exact_sum(product.x, rest);
}

// A corner as seen from a point, x, y and z in sums of two floats.
struct Corner {
    vec2 axes[3];
};

// The determinant of a ray and two corners: above 0 where the ray passes inside the edge from one to the other.
float exact_side(vec3 ray, Corner b, Corner c)
{
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;
        vec2 minor = pair_sum(pair_product(b.axes[j], c.axes[k]), -pair_product(b.axes[k], c.axes[j]));
        sum = pair_sum(sum, pair_product(minor, vec2(ray[i], 0.0)));
    }
    return sum.x + sum.y;
}

#endif
