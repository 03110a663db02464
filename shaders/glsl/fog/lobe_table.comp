#version 460
#extension GL_GOOGLE_include_directive : require
// Fills tables of the glow through lobes, one entry an invocation: quadrature about the light, with the polar axis on it,
// where dw = sin(gamma) dgamma dphi takes the singularity out of Sun 2008, eq. 3.23.
//
// FOG_LOBE_SIZE  entries along each side of a table

#include "fog/glow.glsl"
#include "fog/lobe.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Exponents {
    float values[];
} exponents;

layout(std430, set = 0, binding = 1) buffer Tables {
    float entries[];
} tables;

// Gauss-Legendre on [0, 1]: the first half of the nodes, the second mirrors them.
const vec2 RULE[8] = vec2[](
    vec2(0.0052995325041750, 0.0135762297058771),
    vec2(0.0277124884633837, 0.0311267619693237),
    vec2(0.0671843988060841, 0.0475792558412463),
    vec2(0.1222977958224985, 0.0623144856277670),
    vec2(0.1910618777986781, 0.0747979944082884),
    vec2(0.2709916111713863, 0.0845782596975013),
    vec2(0.3591982246103705, 0.0913017075224618),
    vec2(0.4524937450811813, 0.0947253052275343));

// A lobe ends where it has fallen to exp(-16).
const float END = 16.0;

struct Lobe {
    float exponent;
    float cosine; // of the angle between its axis and the light
    float sine;
    float rim;    // cosine of the angle at which it ends
};

vec2 rule(int i)
{
    vec2 node = RULE[i < 8 ? i : 15 - i];
    return i < 8 ? node : vec2(1.0 - node.x, node.y);
}

// The ring of directions at an angle from the light, through the lobe.
float ring(Lobe lobe, float optical, float gamma)
{
    float sine = sin(gamma);
    float a = lobe.cosine * cos(gamma);
    float b = lobe.sine * sine;
    float level = (lobe.rim - a) / max(b, 1e-30);
    if (level >= 1.0) { return 0.0; }
    float end = level <= -1.0 ? PI : angle_of(sqrt(1.0 - level * level), level);
    float sum = 0.0;
    for (int i = 0; i < 16; ++i) {
        vec2 node = rule(i);
        float cosine = a + b * cos(end * node.x);
        sum += cosine > 0.0 ? node.y * pow(cosine, lobe.exponent) : 0.0;
    }
    float sine_of_half = sin(0.5 * gamma);
    return 2.0 * end * sum * sine * fog_glow(optical, sine, 2.0 * sine_of_half * sine_of_half);
}

void main()
{
    uint at = gl_GlobalInvocationID.x;
    uint table = gl_WorkGroupID.y;
    uint size = uint(FOG_LOBE_SIZE);
    if (at >= size * size) { return; }
    float exponent = exponents.values[table];
    vec2 place = fog_lobe_place(vec2(at % size, at / size) / float(FOG_LOBE_SIZE - 1), exponent);
    float chord = place.x;
    float cosine = 1.0 - 0.5 * chord * chord;
    float sine = chord * sqrt(max(1.0 - 0.25 * chord * chord, 0.0));
    float theta = angle_of(sine, cosine);
    float rim_cosine = exp(-END / exponent);
    float rim = angle_of(sqrt(1.0 - rim_cosine * rim_cosine), rim_cosine);
    // Rings about the light are cut by the lobe's rim between |theta - rim| and the same about the far pole.
    float near = abs(theta - rim);
    float far = PI - abs(PI - theta - rim);
    float borders[4] = float[](theta > rim ? near : 0.0, near, far, theta + rim > PI ? PI : far);
    Lobe lobe = Lobe(exponent, cosine, sine, rim_cosine);
    float total = 0.0;
    for (int panel = 0; panel < 3; ++panel) {
        float begin = borders[panel];
        float extent = borders[panel + 1] - begin;
        if (extent <= 0.0) { continue; }
        for (int i = 0; i < 16; ++i) {
            vec2 node = rule(i);
            // The glow falls fast beside the light.
            vec2 stretched = begin == 0.0 ? vec2(node.x * node.x, 2.0 * node.x) : vec2(node.x, 1.0);
            total += extent * node.y * stretched.y * ring(lobe, place.y, begin + extent * stretched.x);
        }
    }
    tables.entries[table * size * size + at] = log(total);
}
