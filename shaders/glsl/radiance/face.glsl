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
// |r| over the distance.
struct Seen {
    vec3 edges[3];
    vec3 plane;
    uint name; // 1 and its place in the buffer
};

// Distances below a nanometre count as one, so that no sum overflows.
#define MOST_NEARNESS 1e9

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
    return edge;
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
    return Seen(edges, plane, name);
}

// What a ray through `at` of the face makes of an edge or a plane: the same bits wherever it is asked, so that triangles that
// share an edge leave no gap between them.
float face_product(vec3 edge, vec2 at)
{
    precise float product = edge.x * at.x + (edge.y * at.y + edge.z);
    return product;
}

// The nearness at which a ray meets a triangle, 0 where it does not.
float face_nearness(Seen seen, vec2 at)
{
    float least = min(face_product(seen.edges[0], at),
        min(face_product(seen.edges[1], at), face_product(seen.edges[2], at)));
    float nearness = face_product(seen.plane, at);
    return least >= 0.0 && nearness > 0.0 ? nearness : 0.0;
}

#endif
