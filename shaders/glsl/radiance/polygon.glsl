// Unoccluded triangles of uniform radiance on spherical harmonics by their edges.
//
// On the sphere, band l is the eigenspace of the Laplacian to -l (l + 1), so by the divergence theorem the integral of Y_lm
// over a spherical polygon is that of its slope across the boundary over l (l + 1) (compare Snyder, "Area Light Sources for
// Real-Time Graphics", 1996). The slope of r^l Y_lm is made of band l - 1, and along an edge that is a polynomial of degree
// l - 1 in cosine and sine of the angle, which twelve Gauss-Legendre nodes integrate to rounding up to half a circle. When
// the point moves, an edge moves by its normal over the distance along it: the gradients are integrals over edges, too.

#ifndef RADIANCE_POLYGON_GLSL
#define RADIANCE_POLYGON_GLSL

#include "common/angle.glsl"

#define GAUSS_NODES 12
const vec2 GAUSS[6] = vec2[6]( // node in (0, 1) and weight, of the upper half
    vec2(0.125233408511469, 0.249147045813403), vec2(0.367831498998180, 0.233492536538355),
    vec2(0.587317954286617, 0.203167426723066), vec2(0.769902674194305, 0.160078328543346),
    vec2(0.904117256370475, 0.106939325995318), vec2(0.981560634246719, 0.047175336386512));

// Solid angle of a triangle of corners a, b, c, whose normal's product with a is `volume` (van Oosterom and Strackee 1983).
float triangle_solid_angle(vec3 a, vec3 b, vec3 c, float volume)
{
    vec3 far = vec3(length(a), length(b), length(c));
    float cosines = far.x * far.y * far.z + dot(a, b) * far.z + dot(b, c) * far.x + dot(c, a) * far.y;
    return 2.0 * angle_of(abs(volume), cosines);
}

// Triangles of smaller angles are taken as their middle: their edges would cancel to rounding. Both ways err by some 3e-5
// of the light at the limit.
#define SMALL_ANGLE 0.003

// Whether the triangles of unit corners share directions: no plane through the point parts them.
bool triangles_overlap(vec3 one[3], vec3 other[3])
{
    const float touch = 1e-6; // sines below it are rounding: neighbours in a mesh do not overlap
    // Nor does what has no more than twice that in steradians cover anything.
    float volume = abs(dot(one[0], cross(one[1], one[2])));
    float other_volume = abs(dot(other[0], cross(other[1], other[2])));
    bool apart = min(volume, other_volume) < touch;
    for (int i = 0; i < 15; ++i) {
        int j = i % 3;
        vec3 plane = i < 3 ? cross(one[j], one[(j + 1) % 3])
            : i < 6 ? cross(other[j], other[(j + 1) % 3])
                    : cross(one[j], other[(i - 6) / 3]);
        vec3 a = vec3(dot(one[0], plane), dot(one[1], plane), dot(one[2], plane));
        vec3 b = vec3(dot(other[0], plane), dot(other[1], plane), dot(other[2], plane));
        bool below = all(lessThanEqual(a, vec3(touch))) && all(greaterThanEqual(b, vec3(-touch)));
        bool above = all(greaterThanEqual(a, vec3(-touch))) && all(lessThanEqual(b, vec3(touch)));
        apart = apart || (length(plane) > touch && (below || above));
    }
    return !apart;
}

// a x b from the two shortest sides of the triangle of a, b and the point: what is left of the longest in rounding is more
// than the others are worth.
vec3 edge_axis(vec3 a, vec3 b)
{
    vec3 between = b - a;
    vec3 squares = vec3(dot(a, a), dot(b, b), dot(between, between));
    float most = max(squares.x, max(squares.y, squares.z));
    if (most == squares.z) { return cross(a, b); }
    return most == squares.x ? cross(b, between) : cross(a, between);
}

// Whether an edge passes the point so near, between its ends, that single precision cannot tell on which side.
bool edge_touches(vec3 a, vec3 b)
{
    vec3 axis = edge_axis(a, b);
    return dot(a, b) < 0.0 && dot(axis, axis) < 1e-6 * dot(a, a) * dot(b, b);
}

// A triangle's sums at radiance 1, and as if seen from its front.
struct Polygon {
    vec3 flux; // Lambert's vector
    float integrals[COEFFICIENTS];
#if GRADIENTS
    vec3 gradients[COEFFICIENTS];
#endif
};

// Adds an edge from a to b: the slopes of the basis across it, over l (l + 1), and the basis over the distance times the
// edge's normal.
void polygon_edge(vec3 a, vec3 b, inout Polygon polygon)
{
    vec3 axis = edge_axis(a, b);
    float sine = length(axis);
    if (sine == 0.0) { return; }
    float angle = angle_of(sine, dot(a, b));
    axis /= sine;
    polygon.flux += 0.5 * angle * axis;
    vec3 start = normalize(a);
    vec3 across = cross(axis, start);
    float line[COEFFICIENTS];
    [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) { line[i] = 0.0; }
#if GRADIENTS
    // The foot of the point on the edge's line, over its squared distance: times a unit ray it is 1 / distance.
    vec3 along = normalize(b - a);
    vec3 foot = a - dot(a, along) * along;
    foot /= max(dot(foot, foot), 1e-18);
    float moved[COEFFICIENTS];
    [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) { moved[i] = 0.0; }
#endif
    for (int k = 0; k < GAUSS_NODES; ++k) {
        vec2 node = GAUSS[k / 2];
        float phi = 0.5 * angle * (1.0 + ((k & 1) == 0 ? node.x : -node.x));
        float weight = 0.5 * angle * node.y;
        vec3 direction = cos(phi) * start + sin(phi) * across;
        float basis[COEFFICIENTS];
        sh_evaluate(direction, basis);
        [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) { line[i] += weight * basis[i]; }
#if GRADIENTS
        weight *= dot(foot, direction);
        [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) { moved[i] += weight * basis[i]; }
#endif
    }
    vec3 slopes[COEFFICIENTS];
    sh_slopes(vec3(0.0), line, slopes);
    [[unroll]] for (int l = 1; l < ORDER; ++l) {
        [[unroll]] for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
            polygon.integrals[i] += dot(slopes[i], axis) / float(l * (l + 1));
        }
    }
#if GRADIENTS
    [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) { polygon.gradients[i] += moved[i] * axis; }
#endif
}

// The sums of a triangle, corners relative to the point.
void polygon_sums(vec3 a, vec3 b, vec3 c, vec3 radiance, out vec4 sums[ELEMENTS])
{
    Polygon polygon;
    polygon.flux = vec3(0.0);
    [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) { polygon.integrals[i] = 0.0; }
#if GRADIENTS
    [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) { polygon.gradients[i] = vec3(0.0); }
#endif
    vec3 normal = cross(b - a, c - a);
    float area = 0.5 * length(normal);
    float volume = dot(a, normal);
    bool seen = volume != 0.0 && max(radiance.r, max(radiance.g, radiance.b)) > 0.0;
    vec3 middle = (a + b + c) / 3.0;
    float far = length(middle);
    float extent = max(distance(a, b), max(distance(b, c), distance(c, a)));
    bool small = extent < SMALL_ANGLE * far;
    vec3 corners[4] = vec3[4](a, b, c, a);
    for (int k = 0; k < (seen && !small ? 3 : 0); ++k) { polygon_edge(corners[k], corners[k + 1], polygon); }
    sums_clear(sums);
    if (seen && small) {
        Texel texel;
        texel.direction = middle / far;
        texel.solid_angle = 0.5 * abs(dot(normal, texel.direction)) / (far * far);
        texel.radiance = radiance;
        texel.covered = 1.0;
        texel.nearness = min(1.0 / far, MOST_NEARNESS);
        texel.slope = texel.nearness * radiance;
#if GRADIENTS
        vec3 tilt = normal / dot(normal, texel.direction);
        [[unroll]] for (int k = 0; k < 3; ++k) { texel.tilt[k] = tilt[k] * texel.slope; }
#endif
#if GRADIENTS
        texel.dimming = vec3(0.0);
#endif
        sums_add(texel, sums);
    }
    if (seen && !small) {
        vec3 power = sign(volume) * radiance;
        float solid_angle = triangle_solid_angle(a, b, c, volume);
        float height = abs(volume) / (2.0 * area);
        float nearness = abs(dot(polygon.flux, normal)) / (2.0 * area * height);
        nearness = min(nearness, MOST_NEARNESS * solid_angle);
        sums[0].rgb = 0.282094791773878 * solid_angle * radiance;
        [[unroll]] for (int i = 1; i < COEFFICIENTS; ++i) { sums[i].rgb = polygon.integrals[i] * power; }
        sums[SUMS_SOLID_ANGLE].w = solid_angle;
        sums[SUMS_NEARNESS].w = nearness;
        [[unroll]] for (int k = 0; k < 3; ++k) { sums[SUMS_SLOPE + k].w = nearness * radiance[k]; }
#if GRADIENTS
        [[unroll]] for (int i = 0; i < COEFFICIENTS; ++i) {
            [[unroll]] for (int k = 0; k < 3; ++k) {
                sums[COEFFICIENTS + 3 * i + k].rgb = polygon.gradients[i][k] * power;
            }
        }
#endif
    }
}

#endif
