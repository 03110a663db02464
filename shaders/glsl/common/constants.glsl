// Numbers that more than one file needs.

#ifndef COMMON_CONSTANTS_GLSL
#define COMMON_CONSTANTS_GLSL

const float PI = 3.14159265358979;
const float TWO_PI = 6.28318530717959;
const float HALF_PI = 1.57079632679490;
const float QUARTER_PI = 0.785398163397448;

#endif
