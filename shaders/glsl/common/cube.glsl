// Cube maps: faces +x, -x, +y, -y, +z, -z as 0 .. 5, oriented as Vulkan has them (Vulkan 1.3, "Cube Map Face
// Selection" and "Cube Map Coordinate Transformation").

#ifndef COMMON_CUBE_GLSL
#define COMMON_CUBE_GLSL

// The direction, of length at least 1 and not normalised, of (u, v) in [0, 1]^2 on a face, v down.
vec3 cube_direction(uint face, vec2 uv)
{
    float s = 2.0 * uv.x - 1.0;
    float t = 2.0 * uv.y - 1.0;
    switch (face) {
    case 0u: return vec3(1.0, -t, -s);
    case 1u: return vec3(-1.0, -t, s);
    case 2u: return vec3(s, 1.0, t);
    case 3u: return vec3(s, -1.0, -t);
    case 4u: return vec3(s, -t, 1.0);
    default: return vec3(-s, -t, -1.0);
    }
}

// The face (z before y before x where components tie) and place on it of a direction of any length but zero:
// (u, v, face).
vec3 cube_place(vec3 direction)
{
    vec3 size = abs(direction);
    float face;
    vec2 st;
    float major;
    if (size.z >= size.x && size.z >= size.y) {
        bool positive = direction.z >= 0.0;
        face = positive ? 4.0 : 5.0;
        st = vec2(positive ? direction.x : -direction.x, -direction.y);
        major = size.z;
    } else if (size.y >= size.x) {
        bool positive = direction.y >= 0.0;
        face = positive ? 2.0 : 3.0;
        st = vec2(direction.x, positive ? direction.z : -direction.z);
        major = size.y;
    } else {
        bool positive = direction.x >= 0.0;
        face = positive ? 0.0 : 1.0;
        st = vec2(positive ? -direction.z : direction.z, -direction.y);
        major = size.x;
    }
    return vec3(0.5 * st / major + 0.5, face);
}

#endif
