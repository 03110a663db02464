// From exposed linear Rec. 709 to the display: the Khronos Group's "PBR Neutral Tone Mapping" specification (2024),
// the same function as the scene crate's, then the encoding of IEC 61966-2-1 (sRGB).

#ifndef COMMON_TONE_MAP_GLSL
#define COMMON_TONE_MAP_GLSL

// Linear RGB, negative channels counted as 0, to display-linear RGB in [0, 1].
vec3 tone_map(vec3 rgb)
{
    const float reflectance = 0.04; // of a dielectric at normal incidence
    const float start = 0.8 - reflectance; // where compression begins
    const float room = 1.0 - start;
    const float desaturation = 0.15;
    rgb = clamp(rgb, 0.0, 3.4e38);
    float low = min(rgb.r, min(rgb.g, rgb.b));
    rgb -= low < 2.0 * reflectance ? low - low * low / (4.0 * reflectance) : reflectance;
    float peak = max(rgb.r, max(rgb.g, rgb.b));
    if (peak < start) {
        return rgb;
    }
    float new_peak = 1.0 - room * room / (peak + room - start);
    float white = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(rgb / peak * new_peak, vec3(new_peak), white);
}

// Display-linear [0, 1] to the sRGB encoding in [0, 1].
vec3 srgb_encode(vec3 linear)
{
    vec3 power = 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(power, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

// The sRGB encoding in [0, 1] to linear.
vec3 srgb_decode(vec3 encoded)
{
    vec3 power = pow((encoded + 0.055) / 1.055, vec3(2.4));
    return mix(power, encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

#endif
