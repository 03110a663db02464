// Light that is scattered once along a view ray: the geometry of its paths, without angles.
//
// The ray starts at the eye; the light lies `along` it and `off` it, both distances. At distance x on the ray the light
// is d = sqrt(off^2 + (x - along)^2) away, and the path from it by x to the eye is x + d long. In terms of
//     m = x + d - along > 0,    dm / (off^2 + m^2) = dx / (2 d^2),    cosine of the scattering angle (off^2 - m^2) / (off^2 + m^2)
// every quantity is a sum of positive terms. arctan(m / off) is the half angle of Sun 2008, eq. 3.9 to 3.11.

// A ray and a light.
struct FogPath {
    float along;
    float off_squared; // squared distance of the light from the ray, plus its squared radius
};

// Part of a ray, by the lengths of the light paths over its points.
struct FogSegment {
    float start;  // m where it begins
    float before; // by how much the path over its beginning is longer than the straight one to the eye
    float excess; // by how much the path over its end is longer still
};

// A ray from the eye in a unit direction; `light` is relative to the eye. A light of a radius is the disc that faces each
// point of the ray.
FogPath fog_path(vec3 light, vec3 direction, float radius)
{
    vec3 off = cross(light, direction);
    float along = dot(light, direction);
    // A point light on the ray itself has an airlight without end; what f32 can tell from it is as near as this.
    float least = 1e-8 * abs(along) + 1e-12;
    return FogPath(along, max(dot(off, off), least * least) + radius * radius);
}

// m and d at a distance beyond the light's foot.
vec2 fog_reckon(FogPath path, float delta)
{
    float d = sqrt(path.off_squared + delta * delta);
    return vec2(delta >= 0.0 ? delta + d : path.off_squared / (d - delta), d);
}

// By how much a path grows over a stretch of the ray between two places.
float fog_growth(float extent, vec2 from, vec2 to)
{
    return extent * (from.x + to.x) / (from.y + to.y);
}

// The part of the ray of a length from a distance on. An infinite length is one above 1e30. The length is told and not
// the end, whose difference from the beginning would be lost in rounding.
FogSegment fog_segment(FogPath path, float begin, float extent)
{
    vec2 near = fog_reckon(path, begin - path.along);
    float before = begin > 0.0 ? fog_growth(begin, fog_reckon(path, -path.along), near) : 0.0;
    if (extent > 1e30) { return FogSegment(near.x, before, extent); }
    return FogSegment(near.x, before, fog_growth(extent, near, fog_reckon(path, begin - path.along + extent)));
}

// The distance along the ray where m is reached.
float fog_distance(FogPath path, float m)
{
    return path.along + 0.5 * (m - path.off_squared / m);
}
