// Matt surfaces in spherical harmonics: distributions of normals under light, either of them given as nine coefficients.
// Functions over values, no bindings. Light may be an environment's or what the relight pass transfers to a vertex.
//
// Sun 2008, eq. 5.7; Ramamoorthi and Hanrahan 2001. Coefficients are those of common/sh_basis.glsl at ORDER 3 or more, in
// one frame with the normals.

#ifndef NORMALS_HARMONICS_GLSL
#define NORMALS_HARMONICS_GLSL

#include "normals/lobe.glsl"

// The clamped cosine over pi, band by band.
const vec3 NORMALS_COSINE_BANDS = vec3(1.0, 2.0 / 3.0, 0.25);

// Nine basis functions about a direction, each times the factor of its band, and the sum of their products with
// COEFFICIENT(i), which is any type that is linear.
#define NORMALS_HARMONIC_SUM(direction, bands, COEFFICIENT) \
    ((bands).x * 0.28209479 * COEFFICIENT(0) \
        + (bands).y * 0.48860251 \
            * (-(direction).y * COEFFICIENT(1) + (direction).z * COEFFICIENT(2) - (direction).x * COEFFICIENT(3)) \
        + (bands).z \
            * (1.09254843 * (direction).x * (direction).y * COEFFICIENT(4) \
                - 1.09254843 * (direction).y * (direction).z * COEFFICIENT(5) \
                + 0.31539157 * (3.0 * (direction).z * (direction).z - 1.0) * COEFFICIENT(6) \
                - 1.09254843 * (direction).x * (direction).z * COEFFICIENT(7) \
                + 0.54627421 * ((direction).x * (direction).x - (direction).y * (direction).y) * COEFFICIENT(8)))

// By how much a lobe dims each band.
vec3 normals_lobe_bands(NormalsLobe lobe)
{
    float r = lobe.mean;
    return vec3(1.0, r, clamp(1.0 - 3.0 * r / lobe.concentration, 0.0, 1.0));
}

// The bands of a lobe's Lambertian reflection: with NORMALS_HARMONIC_SUM about its axis and the light's coefficients, times
// its weight, this is its radiance at albedo 1.
vec3 normals_lambert_bands(NormalsLobe lobe)
{
    return NORMALS_COSINE_BANDS * normals_lobe_bands(lobe);
}

// The mean of max(0, x) for an x of which mean and mean square are given, spread evenly about the mean.
float normals_rectified_evenly(float mean, float square)
{
    float reach = sqrt(max(3.0 * (square - mean * mean), 1e-12));
    float above = max(mean + reach, 0.0);
    return mean > reach ? mean : 0.25 * above * above / reach;
}

// Lambert, albedo 1, of normals given as nine coefficients under a light of irradiance 1: three bands hold mean and mean
// square of n.l exactly, where the clamped cosine cut to three bands would be off by itself.
#define NORMALS_HARMONIC_LAMBERT(light, COEFFICIENT) \
    (normals_rectified_evenly( \
        NORMALS_HARMONIC_SUM(light, vec3(0.0, 4.0 / 3.0 * PI, 0.0), COEFFICIENT), \
        1.0 / 3.0 + NORMALS_HARMONIC_SUM(light, vec3(0.0, 0.0, 8.0 / 15.0 * PI), COEFFICIENT)) \
        / PI)

// What matters of a distribution of directions to light of nine coefficients: its weight, its mean vector, and the squares
// and products of its components, the unit matrix left out. A sum over lobes or texels, in any one frame.
struct NormalsMoments {
    float weight;
    vec3 mean;
    vec3 squares;  // xx, yy, zz
    vec3 products; // yz, zx, xy
};

// `bands`: of a lobe about the direction, times its weight.
void normals_add_moments(inout NormalsMoments sum, vec3 bands, vec3 direction)
{
    sum.weight += bands.x;
    sum.mean += bands.y * direction;
    sum.squares += bands.z * direction * direction;
    sum.products += bands.z * direction.yzx * direction.zxy;
}

// The same about other axes: `axes` has the old ones as columns.
NormalsMoments normals_turned_moments(NormalsMoments moments, mat3 axes)
{
    vec3 squares = moments.squares;
    vec3 products = moments.products;
    mat3 tensor = axes * mat3(squares.x, products.z, products.y, products.z, squares.y, products.x, products.y, products.x, squares.z);
    mat3 rows = transpose(axes);
    NormalsMoments turned;
    turned.weight = moments.weight;
    turned.mean = axes * moments.mean;
    turned.squares = vec3((tensor * rows[0]).x, (tensor * rows[1]).y, (tensor * rows[2]).z);
    turned.products = vec3((tensor * rows[2]).y, (tensor * rows[0]).z, (tensor * rows[1]).x);
    return turned;
}

// As NORMALS_HARMONIC_SUM, of moments in one frame with the light.
#define NORMALS_MOMENTS_SUM(moments, bands, COEFFICIENT) \
    ((bands).x * 0.28209479 * (moments).weight * COEFFICIENT(0) \
        + (bands).y * 0.48860251 \
            * (-(moments).mean.y * COEFFICIENT(1) + (moments).mean.z * COEFFICIENT(2) - (moments).mean.x * COEFFICIENT(3)) \
        + (bands).z \
            * (1.09254843 * ((moments).products.z * COEFFICIENT(4) - (moments).products.x * COEFFICIENT(5) \
                   - (moments).products.y * COEFFICIENT(7)) \
                + 0.31539157 * (2.0 * (moments).squares.z - (moments).squares.x - (moments).squares.y) * COEFFICIENT(6) \
                + 0.54627421 * ((moments).squares.x - (moments).squares.y) * COEFFICIENT(8)))

// What a lobe reflects of light all around, as an exponential about a direction.
struct NormalsGloss {
    vec3 direction;
    float sharpness;
    float weight; // of the light about that direction
};

// A lobe under the reflection `exp(sharpness (n.h - 1)) (n.l)+` towards `view`: convolved, then turned from half vectors to
// lights, which lie twice as far apart across the plane of view and normal and as far as its cosine says along it (Wang,
// Ren, Gong, Snyder and Guo, "All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance", 2009, section 4).
NormalsGloss normals_gloss(NormalsLobe lobe, float sharpness, vec3 view)
{
    float k = lobe.concentration;
    float nv = max(dot(lobe.axis, view), 0.05);
    NormalsGloss gloss;
    gloss.direction = 2.0 * dot(lobe.axis, view) * lobe.axis - view;
    float half_vectors = k * sharpness / (k + sharpness);
    gloss.sharpness = max(half_vectors / (4.0 * nv), NORMALS_MIN_CONCENTRATION);
    float both = k + sharpness;
    float r = 1.0 - 1.0 / max(both, 1.0);
    float cosine = normals_clamped_cosine(r / both, r, dot(lobe.axis, gloss.direction));
    gloss.weight = k / both * TWO_PI * normals_opening(gloss.sharpness) * cosine;
    return gloss;
}

// Its bands: with NORMALS_HARMONIC_SUM about its direction and the light's coefficients, times its weight, this is its
// radiance.
vec3 normals_gloss_bands(NormalsGloss gloss)
{
    float k = gloss.sharpness;
    float r = normals_mean_length(k);
    return vec3(1.0, r, k < 0.1 ? 0.0 : clamp(1.0 - 3.0 * r / k, 0.0, 1.0));
}

#endif
