// A normal map seen through a pixel: the lobes of what lies under it, by the functions of the normals room, or what others
// keep of it, and what these reflect of the scene's lights.
//
// FILTER_LOBES    mixtures of MAPPED_LAYERS lobes
// FILTER_TOKSVIG  the mean normal and its length (Toksvig 2005)
// FILTER_LEAN     mean and moments of the slope (Olano and Baker 2010)
// FILTER_MIP      the mean normal, scaled to length 1
// FILTER_TEXELS   the map itself at every distance: what many samples a pixel make the truth
// FILTER_HARMONICS nine coefficients of the normals in three layers, for matt surfaces
// MAPPED_OCTAHEDRAL 1: lobes in four bytes each
// MAPPED_PARTS 4: a pixel's footprint in quarters, each looked up and shaded by itself; 1: as a whole
// HOST_INCIDENT 1: light from all around too, by the incident radiance of the vertices

#ifndef MAPPED_PARTS
#define MAPPED_PARTS 1
#endif

#include "normals/harmonics.glsl"
#include "normals/microfacet.glsl"
#if HOST_INCIDENT
#include "host/incident.glsl"
#endif

layout(set = 0, binding = 5) uniform texture2D normal_map; // RGB = normal * 0.5 + 0.5
layout(set = 0, binding = 6) uniform sampler normal_map_sampler;
layout(set = 0, binding = 7) uniform texture2DArray coarse_normals; // from half the size of the map down
layout(set = 0, binding = 8) uniform sampler coarse_normals_sampler;

// Samples along the longer axis of a pixel's footprint: what is kept is linear, so that it adds up.
const float MAPPED_TAPS = 8.0;

// What a pixel sees: the interpolated normal of the map, by its share, and what is kept of the distribution.
struct Mapped {
    vec3 normal;
    float share;
    vec4 kept[MAPPED_LAYERS];
};

vec3 map_normal(vec2 uv)
{
    vec3 normal = textureLod(sampler2D(normal_map, normal_map_sampler), uv, 0.0).xyz * 2.0 - 1.0;
    return dot(normal, normal) > 0.0 ? normalize(normal) : vec3(0.0, 0.0, 1.0);
}

// Of a footprint about a place, given by its two sides.
Mapped mapped_at(vec2 uv, vec2 across, vec2 along)
{
    Mapped mapped;
    mapped.normal = map_normal(uv);
    mapped.share = 1.0;
    for (int i = 0; i < MAPPED_LAYERS; ++i) { mapped.kept[i] = vec4(0.0); }
#ifndef FILTER_TEXELS
    vec2 size = vec2(textureSize(sampler2D(normal_map, normal_map_sampler), 0));
    float a = length(across * size);
    float b = length(along * size);
    vec2 longer = a > b ? across : along;
    float taps = clamp(ceil(max(a, b) / max(min(a, b), 1e-3)), 1.0, MAPPED_TAPS);
    float level = log2(max(max(a, b) / taps, 1e-6));
    // Where a single texel is seen, the normal itself is shaded; the first level of what is kept is level 1.
    mapped.share = clamp(1.0 - level, 0.0, 1.0);
    if (mapped.share < 1.0) {
        // Never without a turn: a loop that may end before its first costs software renderers one turn more.
        float tap = 0.5;
        do {
            vec2 place = uv + longer * (tap / taps - 0.5);
            for (int i = 0; i < MAPPED_LAYERS; ++i) {
                vec4 found =
                    textureLod(sampler2DArray(coarse_normals, coarse_normals_sampler), vec3(place, float(i)), level - 1.0);
#if MAPPED_OCTAHEDRAL
                found = normals_octahedral(found);
#endif
                mapped.kept[i] += found / taps;
            }
            tap += 1.0;
        } while (tap < taps);
    }
#endif
    return mapped;
}

// D of GGX.
float normal_facets(float nh, float alpha)
{
    float square = alpha * alpha;
    float denominator = nh * nh * (square - 1.0) + 1.0;
    return square / (PI * denominator * denominator);
}

// Diffuse reflection and, without Fresnel's factor, that of facets, of a single normal.
vec2 normal_reflected(vec3 normal, float alpha, vec3 l, vec3 v, vec3 h)
{
    float nl = max(dot(normal, l), 0.0);
    float nh = max(dot(normal, h), 0.0);
    return nl * vec2(1.0 / PI, normal_facets(nh, alpha) * normals_masking(alpha, nl, max(dot(normal, v), 1e-4)));
}

// What the length of the mean normal makes of alpha.
float mean_widened(float size, float alpha)
{
    float exponent = 2.0 / (alpha * alpha) - 2.0;
    float lowered = exponent * size / (size + exponent * (1.0 - size));
    return sqrt(2.0 / (lowered + 2.0));
}

// The mean normal, whose length widens the reflection.
vec2 mean_reflected(vec3 mean, float alpha, vec3 l, vec3 v, vec3 h)
{
    float size = clamp(length(mean), 1e-3, 1.0);
    return normal_reflected(mean / size, mean_widened(size, alpha), l, v, h);
}

// How a pixel sees the surface: tangent, bitangent and normal in the world, the view in these axes, and the material.
struct Seen {
    mat3 axes;
    vec3 view;
    float alpha;
    NormalsGgx ggx; // of alpha
    vec3 f0;
    vec3 diffuse; // share that does not mirror, times the colour
};

// What `normal_reflected` gives, of what is kept of the distribution.
vec2 kept_reflected(Mapped mapped, Seen seen, vec3 l, vec3 h)
{
    float alpha = seen.alpha;
    vec3 v = seen.view;
#if defined(FILTER_LOBES)
    vec2 sum = vec2(0.0);
    for (int i = 0; i < MAPPED_LAYERS; ++i) {
        vec4 lobe = mapped.kept[i];
        if (lobe.w > 1e-4) {
            sum += vec2(normals_lambert(lobe, l), normals_torrance_sparrow(lobe, seen.ggx, alpha, l, v, h));
        }
    }
    return sum;
#elif defined(FILTER_TOKSVIG)
    return mean_reflected(mapped.kept[0].xyz, alpha, l, v, h);
#elif defined(FILTER_HARMONICS)
#define COEFFICIENT(i) mapped.kept[(i) / 4][(i) % 4]
    // The first band is the mean normal, in another order and with other signs.
    vec3 mean = 2.0466534 * vec3(-COEFFICIENT(3), -COEFFICIENT(1), COEFFICIENT(2));
    return vec2(NORMALS_HARMONIC_LAMBERT(l, COEFFICIENT), mean_reflected(mean, alpha, l, v, h).y);
#elif defined(FILTER_LEAN)
    vec2 mean = mapped.kept[0].xy;
    vec3 moments = mapped.kept[1].xyz; // xx, xy, yy
    vec3 normal = normalize(vec3(mean, 1.0));
    vec2 reflected = normal_reflected(normal, alpha, l, v, h);
    if (h.z <= 0.0) { return vec2(reflected.x, 0.0); }
    float width = 0.5 * alpha * alpha;
    float xx = max(moments.x - mean.x * mean.x, 0.0) + width;
    float yy = max(moments.z - mean.y * mean.y, 0.0) + width;
    float xy = moments.y - mean.x * mean.y;
    float determinant = max(xx * yy - xy * xy, width * width);
    vec2 offset = h.xy / h.z - mean;
    float tail = 1.0 + 0.5 * (yy * offset.x * offset.x - 2.0 * xy * offset.x * offset.y + xx * offset.y * offset.y) / determinant;
    float cosine = max(dot(normal, h), h.z);
    float facets = 1.0 / (2.0 * PI * sqrt(determinant) * cosine * cosine * cosine * cosine * tail * tail);
    float nl = max(dot(normal, l), 0.0);
    float widened = min(sqrt(xx + yy), 1.0);
    return vec2(reflected.x, nl * facets * normals_masking(widened, nl, max(dot(normal, v), 1e-4)));
#else
    return normal_reflected(normalize(mapped.kept[0].xyz + vec3(0.0, 0.0, 1e-6)), alpha, l, v, h);
#endif
}

#if HOST_INCIDENT
// The same of light from all around.
void kept_gathered(inout Gathered sum, float share, Mapped mapped, float alpha, vec3 view)
{
#if defined(FILTER_LOBES)
    for (int i = 0; i < MAPPED_LAYERS; ++i) {
        vec4 stored = mapped.kept[i];
        if (stored.w > 1e-4) {
            NormalsLobe lobe = normals_lobe(stored);
            normals_add_moments(sum.diffuse, share * stored.w * normals_lobe_bands(lobe), lobe.axis);
            gather_specular(sum, share * stored.w, lobe, alpha, view);
        }
    }
#elif defined(FILTER_TOKSVIG)
    vec3 mean = mapped.kept[0].xyz;
    gather_normal(sum, share, normalize(mean + vec3(0.0, 0.0, 1e-6)), mean_widened(clamp(length(mean), 1e-3, 1.0), alpha), view);
#elif defined(FILTER_HARMONICS)
#define COEFFICIENT(i) mapped.kept[(i) / 4][(i) % 4]
    vec3 mean = 2.0466534 * vec3(-COEFFICIENT(3), -COEFFICIENT(1), COEFFICIENT(2));
    sum.diffuse.weight += share;
    sum.diffuse.mean += share * mean;
    float zz = 2.1137 * COEFFICIENT(6);
    float difference = 1.8305733 * COEFFICIENT(8);
    sum.diffuse.squares += share * vec3(0.5 * difference, -0.5 * difference, 0.5 * zz);
    sum.diffuse.products += share * 0.9152912 * vec3(-COEFFICIENT(5), -COEFFICIENT(7), COEFFICIENT(4));
    gather_specular(sum, share, normals_lobe(vec4(mean, 1.0)), alpha, view);
#elif defined(FILTER_LEAN)
    vec2 mean = mapped.kept[0].xy;
    vec3 moments = mapped.kept[1].xyz;
    float spread = max(moments.x - mean.x * mean.x, 0.0) + max(moments.z - mean.y * mean.y, 0.0);
    gather_normal(sum, share, normalize(vec3(mean, 1.0)), min(sqrt(alpha * alpha + spread), 1.0), view);
#else
    gather_normal(sum, share, normalize(mapped.kept[0].xyz + vec3(0.0, 0.0, 1e-6)), alpha, view);
#endif
}
#endif

#if AIRGLOW_FOG
// What the medium scatters onto the surface of the scene's lights: each lobe's, as of a normal on its axis. The glow is as
// wide as the lobes of reflection, and lobes of normals are narrower.
vec3 mapped_glow(Mapped mapped, Seen seen, vec3 base, vec2 surface, vec3 position)
{
    vec3 view = seen.axes * seen.view;
    float rest = 1.0 - mapped.share;
    vec3 sum = vec3(0.0);
    uint i = 0u;
    do {
        FogIncident incident = light_scattered(lights.lights[i], position);
#define GLOW(n) glow_reflected(incident, base, surface, seen.alpha, seen.f0, normalize(seen.axes * (n)), view)
        if (mapped.share > 0.0) { sum += mapped.share * GLOW(mapped.normal); }
        if (rest > 0.0) {
#if defined(FILTER_LOBES)
            for (int j = 0; j < MAPPED_LAYERS; ++j) {
                vec4 lobe = mapped.kept[j];
                if (lobe.w > 1e-4) { sum += rest * lobe.w * GLOW(lobe.xyz); }
            }
#elif defined(FILTER_HARMONICS)
            sum += rest * GLOW(vec3(-mapped.kept[0].w, -mapped.kept[0].y, mapped.kept[0].z));
#elif defined(FILTER_LEAN)
            sum += rest * GLOW(vec3(mapped.kept[0].xy, 1.0));
#else
            sum += rest * GLOW(mapped.kept[0].xyz + vec3(0.0, 0.0, 1e-6));
#endif
        }
        ++i;
    } while (i < lights.count.x);
    return sum;
}
#endif

// Radiance of the scene's lights, of which there is at least one.
vec3 mapped_lit(Mapped mapped, Seen seen, vec3 position)
{
    vec3 sum = vec3(0.0);
    uint i = 0u;
    do {
        vec3 towards;
        vec3 irradiance = light_irradiance(lights.lights[i], position, towards);
        vec3 l = towards * seen.axes;
        vec3 h = normalize(l + seen.view);
        vec2 reflected = vec2(0.0);
        if (mapped.share > 0.0) {
            reflected += mapped.share * normal_reflected(mapped.normal, seen.alpha, l, seen.view, h);
        }
        if (mapped.share < 1.0) { reflected += (1.0 - mapped.share) * kept_reflected(mapped, seen, l, h); }
        vec3 fresnel = seen.f0 + (1.0 - seen.f0) * pow(clamp(1.0 - dot(l, h), 0.0, 1.0), 5.0);
        sum += irradiance * ((1.0 - fresnel) * seen.diffuse * reflected.x + fresnel * reflected.y);
        ++i;
    } while (i < lights.count.x);
    return sum;
}

// Radiance towards the eye; `surface` is metallic and roughness, `tangent` has the sign of the bitangent as w, `flat_colour` is
// the light that a white diffuse surface would reflect of what comes from all around, were its map flat.
vec3 mapped_reflected(
    vec3 base, vec2 surface, vec2 uv, vec3 normal, vec4 tangent, vec3 position, vec3 eye, vec3 flat_colour)
{
    vec3 n = normalize(normal);
    vec3 t = normalize(tangent.xyz - n * dot(n, tangent.xyz));
    vec3 b = tangent.w * cross(n, t);
    vec3 towards_eye = normalize(eye - position);
    if (dot(n, towards_eye) < 0.0) { n = -n; }
    Seen seen;
    seen.axes = mat3(t, b, n);
    seen.view = towards_eye * seen.axes;
    seen.alpha = max(surface.y * surface.y, 0.002);
    seen.ggx = normals_ggx_of(seen.alpha);
    seen.f0 = mix(vec3(0.04), base, surface.x);
    seen.diffuse = (1.0 - surface.x) * base;
    vec2 across = dFdx(uv);
    vec2 along = dFdy(uv);
    bool lit = lights.count.x > 0u;
    vec3 sum = vec3(0.0);
#if MAPPED_PARTS == 4
    // What reflects lights is sharp, and taken of each quarter; what follows is smooth, and taken of all that the pixel sees.
    Mapped mapped;
    mapped.normal = vec3(0.0);
    for (int i = 0; i < MAPPED_LAYERS; ++i) { mapped.kept[i] = vec4(0.0); }
    int part = 0;
    do {
        vec2 side = 0.5 * vec2(ivec2(part & 1, part >> 1)) - 0.25;
        Mapped quarter = mapped_at(uv + side.x * across + side.y * along, 0.5 * across, 0.5 * along);
        if (lit) { sum += 0.25 * mapped_lit(quarter, seen, position); }
        mapped.share = quarter.share;
        mapped.normal += quarter.normal;
        for (int i = 0; i < MAPPED_LAYERS; ++i) { mapped.kept[i] += 0.25 * quarter.kept[i]; }
        ++part;
    } while (part < 4);
    mapped.normal = normalize(mapped.normal + vec3(0.0, 0.0, 1e-6));
#else
    Mapped mapped = mapped_at(uv, across, along);
    if (lit) { sum += mapped_lit(mapped, seen, position); }
#endif
#if AIRGLOW_FOG
    if (lit) { sum += mapped_glow(mapped, seen, base, surface, position); }
#endif
#if HOST_INCIDENT
    Gathered gathered = gathered_none();
    if (mapped.share > 0.0) { gather_normal(gathered, mapped.share, mapped.normal, seen.alpha, seen.view); }
    if (mapped.share < 1.0) { kept_gathered(gathered, 1.0 - mapped.share, mapped, seen.alpha, seen.view); }
    bool matt = (material.flags & 4u) != 0u;
    return sum + gathered_radiance(gathered, flat_colour, base, seen.f0, seen.diffuse, seen.axes, matt);
#else
    return sum + base * flat_colour;
#endif
}
