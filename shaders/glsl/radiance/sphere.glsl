// Unoccluded spheres of uniform radiance on spherical harmonics: passes/radiance/src/reference/sphere.rs is the same in f64.
//
// A sphere fills a cap of half-angle a, sin a = radius / distance. By Funk and Hecke its band factors are the integrals
// 2 pi P_l(t) dt over t from cos a to 1, and Legendre's equation makes that 2 pi sin2(a) P_l'(cos a) / (l (l + 1)). With the
// distance D the factors change by -2 pi sin(a) tan(a) P_l(cos a) / D, and across it the basis turns.

#ifndef RADIANCE_SPHERE_GLSL
#define RADIANCE_SPHERE_GLSL

// A sphere as the point sees it.
struct Cap {
    vec3 axis; // unit, to the centre
    float sine; // of the half-angle
    float cosine;
};

Cap cap_of(vec3 centre, float radius)
{
    float sine = min(radius * inversesqrt(max(dot(centre, centre), 1e-37)), 1.0);
    return Cap(normalize(centre), sine, sqrt((1.0 - sine) * (1.0 + sine)));
}

bool caps_overlap(Cap one, Cap other)
{
    // Past the sum of the half-angles, by more than rounding.
    return dot(one.axis, other.axis) > one.cosine * other.cosine - one.sine * other.sine - 1e-6;
}

// Whether no plane through the point parts a cap from the triangle of unit corners: neither that of an edge nor one that
// touches the cap before a corner.
bool cap_overlaps(Cap cap, vec3 corners[3])
{
    const float touch = 1e-6;
    float side = sign(dot(corners[0], cross(corners[1], corners[2])));
    bool apart = false;
    for (int i = 0; i < 3; ++i) {
        vec3 edge = cross(corners[i], corners[(i + 1) % 3]);
        apart = apart || -side * dot(edge, cap.axis) >= (cap.sine + touch) * length(edge);
        vec3 across = corners[i] - dot(corners[i], cap.axis) * cap.axis;
        float far = length(across);
        vec3 plane = cap.cosine * across / max(far, 1e-30) - cap.sine * cap.axis;
        vec3 before = vec3(dot(plane, corners[0]), dot(plane, corners[1]), dot(plane, corners[2]));
        apart = apart || (far > touch && all(greaterThanEqual(before, vec3(touch))));
    }
    return !apart;
}

// Integral of 1 / distance over the cap, the distance to the near surface, times the distance of the centre.
float cap_nearness(float sine)
{
    float square = sine * sine;
    // sine - (1 - sine^2) atanh(sine); near zero the two cancel, and its series does not.
    float rest = sine - 0.5 * (1.0 - square) * log((1.0 + sine) / (1.0 - sine));
    if (sine < 0.5) {
        rest = 0.0;
        float power = sine * square;
        for (int k = 1; k < 10; ++k) {
            rest += 2.0 * power / float(4 * k * k - 1);
            power *= square;
        }
    }
    return 3.14159265358979 * (square + rest) / ((1.0 - sine) * (1.0 + sine));
}

// The sums of a sphere, its centre relative to the point, which is outside.
void sphere_sums(vec3 centre, float radius, vec3 radiance, out vec4 sums[ELEMENTS])
{
    Cap cap = cap_of(centre, radius);
    float far = length(centre);
    float basis[COEFFICIENTS];
    sh_evaluate(cap.axis, basis);
#if GRADIENTS
    vec3 slopes[COEFFICIENTS];
    sh_slopes(cap.axis, basis, slopes);
#endif
    sums_clear(sums);
    float square = cap.sine * cap.sine;
    float solid_angle = 6.28318530717959 * square / (1.0 + cap.cosine);
    float value = 1.0; // P_l and, below, P_l', upwards: P_l' = t P_(l-1)' + l P_(l-1)
    float below = 0.0;
    float slope = 0.0;
    [[unroll]] for (int l = 0; l < ORDER; ++l) {
        if (l > 0) {
            float next = (float(2 * l - 1) * cap.cosine * value - float(l - 1) * below) / float(l);
            slope = cap.cosine * slope + float(l) * value;
            below = value;
            value = next;
        }
        // The mean of the basis over a cap is the factor times the basis at its axis.
        float factor = l == 0 ? solid_angle : 6.28318530717959 * square * slope / float(l * (l + 1));
        float change = 6.28318530717959 * square / max(cap.cosine, 1e-4) * value; // over far, when the point comes nearer
        [[unroll]] for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
            sums[i].rgb = factor * basis[i] * radiance;
#if GRADIENTS
            vec3 moved = (change * basis[i] * cap.axis - factor * slopes[i]) / far;
            [[unroll]] for (int k = 0; k < 3; ++k) { sums[COEFFICIENTS + 3 * i + k].rgb = moved[k] * radiance; }
#endif
        }
    }
    float nearness = cap_nearness(cap.sine) / far;
    sums[SUMS_SOLID_ANGLE].w = solid_angle;
    sums[SUMS_NEARNESS].w = nearness;
    [[unroll]] for (int k = 0; k < 3; ++k) { sums[SUMS_SLOPE + k].w = nearness * radiance[k]; }
}

#endif
