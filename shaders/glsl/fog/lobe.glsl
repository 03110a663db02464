// The glow of a light through a reflecting lobe, G_n of Sun 2008, eq. 3.23, as a table that `lobe_table.comp` fills.
//
// An entry is T + ln G_n, so that G_n is its exponential less T: smooth, and as flat, over every optical distance T. It
// lies over ln(1 + 8 sqrt(T)) and over an inverse hyperbolic sine of the chord of the angle between the lobe's axis and
// the light, the length of the difference of the two unit vectors; the first and last entries lie on the borders.
//
// FOG_LOBE_SIZE  entries along each side of a table

#ifndef FOG_LOBE_GLSL
#define FOG_LOBE_GLSL

const float FOG_LOBE_FARTHEST = 100.0; // exp(-100) is 0 in single precision
const float FOG_LOBE_NEAREST = 1e-6;   // where G_n is its limit
const float FOG_LOBE_SPREAD = 8.0;
const float FOG_LOBE_LOGARITHM = 4.39444915467244; // ln(1 + 8 sqrt(100))

float fog_inverse_sinh(float x)
{
    return log(x + sqrt(x * x + 1.0));
}

// Place in the table of a chord, in [0, 1].
float fog_lobe_column(float chord, float exponent)
{
    float root = sqrt(exponent);
    return fog_inverse_sinh(0.5 * root * chord) / fog_inverse_sinh(root);
}

// Place in the table of an optical distance, in [0, 1].
float fog_lobe_row(float optical)
{
    float root = sqrt(clamp(optical, 0.0, FOG_LOBE_FARTHEST));
    return log(1.0 + FOG_LOBE_SPREAD * root) / FOG_LOBE_LOGARITHM;
}

// Chord and optical distance at a place.
vec2 fog_lobe_place(vec2 place, float exponent)
{
    float root = sqrt(exponent);
    float grown = exp(place.x * fog_inverse_sinh(root));
    float distance = (exp(place.y * FOG_LOBE_LOGARITHM) - 1.0) / FOG_LOBE_SPREAD;
    return vec2(min((grown - 1.0 / grown) / root, 2.0), max(distance * distance, FOG_LOBE_NEAREST));
}

#ifdef FOG_LOBE_ENTRY
// G_n by bilinear interpolation. FOG_LOBE_ENTRY(i) gives entry i of the tables, which follow one another.
float fog_lobe(int table, float optical, float column)
{
    vec2 at = clamp(vec2(column, fog_lobe_row(optical)), 0.0, 1.0) * float(FOG_LOBE_SIZE - 1);
    ivec2 low = min(ivec2(at), ivec2(FOG_LOBE_SIZE - 2));
    vec2 share = at - vec2(low);
    int first = (table * FOG_LOBE_SIZE + low.y) * FOG_LOBE_SIZE + low.x;
    vec2 upper = vec2(FOG_LOBE_ENTRY(first), FOG_LOBE_ENTRY(first + 1));
    vec2 lower = vec2(FOG_LOBE_ENTRY(first + FOG_LOBE_SIZE), FOG_LOBE_ENTRY(first + FOG_LOBE_SIZE + 1));
    vec2 mixed = mix(upper, lower, share.y);
    return exp(mix(mixed.x, mixed.y, share.x) - optical);
}

// G_n of each channel; `grey` where their optical distances are one: then a single turn of the loop, which spares software
// renderers what they do on both sides of a branch.
vec3 fog_lobe_rgb(int table, vec3 optical, bool grey, float column)
{
    vec3 found = vec3(0.0);
    int channel = 0;
    do {
        float value = fog_lobe(table, optical[channel], column);
        found = vec3(channel == 0 ? value : found.r, channel <= 1 ? value : found.g, value);
        ++channel;
    } while (!grey && channel < 3);
    return found;
}
#endif

#endif
