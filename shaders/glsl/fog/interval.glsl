// Which part of a ray a light can reach: intervals of the distance from the eye, empty where x >= y.

// Within a sphere.
vec2 fog_in_sphere(vec2 interval, vec3 center, float radius, vec3 direction)
{
    float along = dot(center, direction);
    vec3 off = cross(center, direction);
    float squared = radius * radius - dot(off, off);
    if (squared <= 0.0) { return vec2(0.0); }
    float half_chord = sqrt(squared);
    return vec2(max(interval.x, along - half_chord), min(interval.y, along + half_chord));
}

// Within a box, its corners relative to the eye.
vec2 fog_in_box(vec2 interval, vec3 low, vec3 high, vec3 direction)
{
    // A direction along a face would give 0 / 0 there.
    vec3 along = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 to_low = low / along;
    vec3 to_high = high / along;
    vec3 near = min(to_low, to_high);
    vec3 far = max(to_low, to_high);
    return vec2(max(max(interval.x, near.x), max(near.y, near.z)), min(min(interval.y, far.x), min(far.y, far.z)));
}

// Within the cone of a spot light about a unit axis, by the cosine of its half angle, which is at most pi / 2: a convex
// set, so that one interval is left of the ray.
vec2 fog_in_cone(vec2 interval, vec3 apex, vec3 axis, float cosine, vec3 direction)
{
    // dot(p, axis)^2 - cosine^2 dot(p, p) >= 0 at p = x direction - apex: a x^2 + 2 b x + c >= 0.
    float squared = cosine * cosine;
    float slope = dot(direction, axis);
    float height = -dot(apex, axis);
    float a = slope * slope - squared;
    float b = slope * height + squared * dot(apex, direction);
    float c = height * height - squared * dot(apex, apex);
    float discriminant = b * b - a * c;
    if (discriminant <= 0.0) {
        // The ray passes the cone, or runs through its apex.
        if (a <= 0.0) { return vec2(0.0); }
        discriminant = 0.0;
    }
    float larger = -(b + (b < 0.0 ? -1.0 : 1.0) * sqrt(discriminant));
    float first = larger / (abs(a) < 1e-20 ? 1e-20 : a);
    float second = larger == 0.0 ? first : c / larger;
    float begin = min(first, second);
    float end = max(first, second);
    if (a > 0.0) {
        // The direction itself lies within the cone, or within the one behind it.
        return slope > 0.0 ? vec2(max(interval.x, end), interval.y) : vec2(interval.x, min(interval.y, begin));
    }
    // Both ends lie on the cone, or both on the one behind it.
    if (height + 0.5 * (begin + end) * slope <= 0.0) { return vec2(0.0); }
    return vec2(max(interval.x, begin), min(interval.y, end));
}
