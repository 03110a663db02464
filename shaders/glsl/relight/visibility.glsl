// The dynamic visibility vector of each vertex of the chunk (1 seen, 0 blocked, projected on the basis), one
// vertex after another.

layout(std430, set = 0, binding = 3) readonly buffer Visibility {
    float values[];
} visibility;

float visibility_coefficient(uint vertex, uint index)
{
    return visibility.values[vertex * uint(COEFFICIENTS) + index];
}
