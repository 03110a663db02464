// From exposed scene-linear radiance to display-encoded colour. The same function as `tone_map` of the scene room;
// a test of the command compares the two.
//
// Khronos Group, "PBR Neutral Tone Mapping" specification (2024).

vec3 tone_map(vec3 radiance)
{
    const float F90 = 0.04;
    const float START = 0.8 - F90;
    const float DESATURATION = 0.15;
    vec3 rgb = max(radiance, vec3(0.0));
    float low = min(rgb.r, min(rgb.g, rgb.b));
    rgb -= low < 2.0 * F90 ? low - low * low / (4.0 * F90) : F90;
    float peak = max(rgb.r, max(rgb.g, rgb.b));
    if (peak < START) { return rgb; }
    float room = 1.0 - START;
    float new_peak = 1.0 - room * room / (peak + room - START);
    float white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    return mix(rgb * (new_peak / peak), vec3(new_peak), white);
}

// IEC 61966-2-1.
vec3 srgb_encode(vec3 linear)
{
    vec3 low = 12.92 * linear;
    vec3 high = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}
