// What others keep of the normals under a texel, and what they reflect: functions over values, no bindings. Each takes the
// light and the half vector in tangent space and gives the radiance of a light of irradiance 1.
//
// Toksvig 2005; Olano and Baker 2010; Tokuyoshi and Kaplanyan 2019.

#ifndef NORMALS_RIVALS_GLSL
#define NORMALS_RIVALS_GLSL

#include "common/constants.glsl"

const float NORMALS_LAMBERT = 0.0;
const float NORMALS_BLINN_PHONG = 1.0;
const float NORMALS_GGX = 2.0;

// The kind and its exponent or alpha.
struct NormalsMaterial {
    float kind;
    float parameter;
};

// Without the cosine of the light.
float normals_value(NormalsMaterial material, float cosine)
{
    if (material.kind == NORMALS_LAMBERT) { return 1.0 / PI; }
    if (cosine <= 0.0) { return 0.0; }
    if (material.kind == NORMALS_BLINN_PHONG) {
        return (material.parameter + 8.0) / (8.0 * PI) * pow(cosine, material.parameter);
    }
    float square = material.parameter * material.parameter;
    float denominator = square * cosine * cosine + max(1.0 - cosine * cosine, 0.0);
    return square / (4.0 * PI * denominator * denominator);
}

// A normal as long as it is.
float normals_single(vec3 normal, NormalsMaterial material, vec3 light, vec3 half_vector)
{
    float value = normals_value(material, dot(normal, half_vector));
    return max(dot(normal, light), 0.0) * value;
}

vec3 normals_direction(vec3 mean)
{
    float size = length(mean);
    return size > 0.0 ? mean / size : vec3(0.0, 0.0, 1.0);
}

// The exponent falls with the length of the mean normal, and the height by (1 + s') / (1 + s); GGX takes it by
// s = 2 / alpha^2 - 2 and its own height.
float normals_toksvig(vec3 mean, NormalsMaterial material, vec3 light, vec3 half_vector)
{
    vec3 normal = normals_direction(mean);
    float size = clamp(length(mean), 0.0, 1.0);
    float s = material.parameter;
    if (material.kind == NORMALS_BLINN_PHONG) {
        float lowered = s * size / max(size + s * (1.0 - size), 1e-12);
        float height = (1.0 + lowered) / (1.0 + s) * (s + 8.0) / (lowered + 8.0);
        return height * normals_single(normal, NormalsMaterial(material.kind, lowered), light, half_vector);
    }
    if (material.kind == NORMALS_GGX) {
        s = 2.0 / (s * s) - 2.0;
        float lowered = s * size / max(size + s * (1.0 - size), 1e-12);
        material.parameter = sqrt(2.0 / (lowered + 2.0));
    }
    return normals_single(normal, material, light, half_vector);
}

// A normal under a material whose alpha^2 has grown.
float normals_widened(vec3 normal, float growth, NormalsMaterial material, vec3 light, vec3 half_vector)
{
    float p = material.parameter;
    if (material.kind == NORMALS_BLINN_PHONG) {
        float square = min(2.0 / (p + 2.0) + growth, 1.0);
        material.parameter = 2.0 / square - 2.0;
    } else if (material.kind == NORMALS_GGX) {
        material.parameter = sqrt(min(p * p + growth, 1.0));
    }
    return normals_single(normal, material, light, half_vector);
}

// The variance that the length of the mean stands for, as roughness.
float normals_roughened(vec3 mean, NormalsMaterial material, vec3 light, vec3 half_vector)
{
    float size = clamp(length(mean), 1e-3, 1.0);
    float growth = 2.0 * (1.0 - size) / size;
    return normals_widened(normals_direction(mean), growth, material, light, half_vector);
}

// `change`: the squared change of the normal from pixel to pixel, in x and y together.
float normals_geometric(vec3 mean, float change, NormalsMaterial material, vec3 light, vec3 half_vector)
{
    const float variance = 0.15915494; // of the pixel's filter, 1 / (2 pi)
    const float most = 0.18;
    float growth = min(2.0 * variance * change, most);
    return normals_widened(normals_direction(mean), growth, material, light, half_vector);
}

// Mean slope and mean products of slopes, xx, xy, yy.
float normals_lean(vec2 mean, vec3 moments, NormalsMaterial material, vec3 light, vec3 half_vector)
{
    vec3 normal = normalize(vec3(mean, 1.0));
    float cosine = max(dot(normal, light), 0.0);
    if (material.kind == NORMALS_LAMBERT) { return cosine / PI; }
    if (half_vector.z <= 0.0) { return 0.0; }
    bool ggx = material.kind == NORMALS_GGX;
    float p = material.parameter;
    float width = ggx ? 0.5 * p * p : 1.0 / max(p, 1e-3);
    vec2 offset = half_vector.xy / max(half_vector.z, 1e-6);
    float slope = length(offset);
    offset = (slope > 10.0 ? offset * (10.0 / slope) : offset) - mean;
    float xx = max(moments.x - mean.x * mean.x, 0.0) + width;
    float yy = max(moments.z - mean.y * mean.y, 0.0) + width;
    float xy = moments.y - mean.x * mean.y;
    float determinant = max(xx * yy - xy * xy, width * width);
    float far = (yy * offset.x * offset.x - 2.0 * xy * offset.x * offset.y + xx * offset.y * offset.y) / determinant;
    if (!ggx) { return cosine * (p + 8.0) / (8.0 * PI) * width / sqrt(determinant) * exp(-0.5 * far); }
    float tail = 1.0 + 0.5 * far;
    float facing = max(dot(normal, half_vector), 0.05);
    facing *= facing;
    return cosine / (8.0 * PI * sqrt(determinant) * facing * facing * tail * tail);
}

#endif
