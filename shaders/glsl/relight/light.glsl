// The light that meets the vectors of the vertices: SH RGB.
//
// LIGHT_UNIFORM  one vector for the mesh, vec4 a coefficient
// LIGHT_VERTEX   one for each vertex of the chunk, three floats a coefficient, one vertex after another

#ifdef LIGHT_UNIFORM
layout(std140, set = 0, binding = 1) uniform Light {
    vec4 coefficients[COEFFICIENTS];
} light;

vec3 light_coefficient(uint vertex, uint index)
{
    return light.coefficients[index].rgb;
}
#else
layout(std430, set = 0, binding = 1) readonly buffer Light {
    float values[];
} light;

vec3 light_coefficient(uint vertex, uint index)
{
    uint first = 3u * (vertex * uint(COEFFICIENTS) + index);
    return vec3(light.values[first], light.values[first + 1u], light.values[first + 2u]);
}
#endif
