// The distance that a depth value stands for, whatever the host's projection is.

#ifndef COMMON_DEPTH_GLSL
#define COMMON_DEPTH_GLSL

// The distance along the view's axis, in metres, by the four coefficients that the host's World gives
// (`World::depth_coefficients`). The far end of an infinite perspective, and beyond, is finite: 1e30 units away.
float depth_view_distance(float depth, vec4 coefficients)
{
    float numerator = coefficients.x + coefficients.y * depth;
    float denominator = coefficients.z + coefficients.w * depth;
    return numerator / max(denominator, 1e-30);
}

#endif
