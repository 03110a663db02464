// A triangle seen through a face of a cube, in homogeneous form (Olano and Greer, "Triangle Scan Conversion using 2D
// Homogeneous Coordinates", 1997): no clipping, whatever lies behind the point or around it. Coordinates of a face are
// (right, down, normal), so that the ray through (x, y) in [-1, 1]^2 is (x, y, 1).

#ifndef RADIANCE_FACE_GLSL
#define RADIANCE_FACE_GLSL

// Corners in metres; their fourth components are red, green and blue radiance.
struct Triangle {
    vec4 corners[3];
};

// A triangle as rays meet it: a ray r hits it where edge . r >= 0 for its three edges and plane . r > 0, which is then
// |r| over the distance. Edges are in units of their corners' lengths, so that rounding moves the products by less than
// FACE_CLOSE.
struct Seen {
    vec3 edges[3];
    vec3 plane;
    float side; // 1 or -1: the turn of its corners
    uint name; // 1 and its place in the buffer
};

// Distances below a nanometre count as one, so that no sum overflows.
#define MOST_NEARNESS 1e9
// Products of edges below it are decided in higher precision.
#define FACE_CLOSE 1e-6

vec3 face_coordinates(uint face, vec3 v)
{
    switch (face) {
    case 0u: return vec3(-v.z, -v.y, v.x);
    case 1u: return vec3(v.z, -v.y, -v.x);
    case 2u: return vec3(v.x, v.z, v.y);
    case 3u: return vec3(v.x, -v.z, -v.y);
    case 4u: return vec3(v.x, -v.y, v.z);
    default: return vec3(-v.x, -v.y, -v.z);
    }
}

// Back from the coordinates of a face.
vec3 face_world(uint face, vec3 v)
{
    switch (face) {
    case 0u: return vec3(v.z, -v.y, -v.x);
    case 1u: return vec3(-v.z, -v.y, v.x);
    case 2u: return vec3(v.x, v.z, v.y);
    case 3u: return vec3(v.x, -v.z, -v.y);
    case 4u: return vec3(v.x, -v.y, v.z);
    default: return vec3(-v.x, -v.y, -v.z);
    }
}

// Without contraction an edge that two triangles share is the same number in both, of opposite sign: no gap.
vec3 face_edge(vec3 a, vec3 b)
{
    precise vec3 left = a.yzx * b.zxy;
    precise vec3 right = a.zxy * b.yzx;
    precise vec3 edge = left - right;
    vec3 one = vec3(1.0);
    return edge / max(dot(abs(a), one) * dot(abs(b), one), 1e-37);
}

// Whether a triangle of these corners, in coordinates of the face, may be met by rays within low .. high.
bool face_meets(vec3 a, vec3 b, vec3 c, vec2 low, vec2 high)
{
    vec3 x = vec3(a.x, b.x, c.x);
    vec3 y = vec3(a.y, b.y, c.y);
    vec3 z = vec3(a.z, b.z, c.z);
    bool behind = all(lessThanEqual(z, vec3(0.0)));
    bool beside = all(lessThan(x, low.x * z)) || all(greaterThan(x, high.x * z));
    bool above = all(lessThan(y, low.y * z)) || all(greaterThan(y, high.y * z));
    return !behind && !beside && !above;
}

// The plane of a triangle: its product with a unit ray is 1 over the distance. Zero for a triangle of no area and for one
// whose plane holds the point: no ray meets these.
vec3 face_plane(vec3 a, vec3 b, vec3 c, out float side)
{
    vec3 normal = cross(b - a, c - a);
    float volume = dot(a, normal);
    side = sign(volume);
    return abs(volume) < 1e-37 ? vec3(0.0) : normal / volume;
}

Seen face_seen(vec3 a, vec3 b, vec3 c, uint name)
{
    float side;
    vec3 plane = face_plane(a, b, c, side);
    vec3 edges[3] = vec3[3](side * face_edge(b, c), side * face_edge(c, a), side * face_edge(a, b));
    return Seen(edges, plane, side, name);
}

// What a ray through `at` of the face makes of an edge or a plane: the same bits wherever it is asked, so that triangles that
// share an edge leave no gap between them.
float face_product(vec3 edge, vec2 at)
{
    precise float product = edge.x * at.x + (edge.y * at.y + edge.z);
    return product;
}

// The least product of a ray with the edges: 0 or more where it hits.
float face_least(vec3 edges[3], vec2 at)
{
    return min(face_product(edges[0], at), min(face_product(edges[1], at), face_product(edges[2], at)));
}

#endif
