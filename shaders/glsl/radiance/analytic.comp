#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Incident radiance of few triangles and spheres in closed form, at samples from which none of those that emit overlaps
// another or has an edge that touches the point: a workgroup a sample. The record of a sample says in its third number
// whether it is one (1) or is left to a cube map (0).
//
// ORDER      3-6
// GRADIENTS  1: derivatives by the sample's position, too

#include "radiance/face.glsl"
#include "radiance/sample.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Samples { Batch batch; };
layout(std430, set = 0, binding = 1) readonly buffer Points { vec4 points[]; };
layout(std430, set = 0, binding = 2) readonly buffer Triangles { Triangle triangles[]; };
layout(std430, set = 0, binding = 3) buffer Lights { vec4 lights[]; };
struct Sphere {
    vec4 place; // centre, metres; radius
    vec4 radiance; // RGB
};
layout(std430, set = 0, binding = 4) readonly buffer Spheres { Sphere spheres[]; };
#if GRADIENTS
layout(std430, set = 0, binding = 5) buffer Gradients { vec4 gradients[]; };
#endif

layout(push_constant) uniform Settings {
    uint triangle_count; // with the spheres MOST or fewer
    uint sphere_count;
    uint keep; // 1: samples of earlier frames are left alone
} settings;

#define SAMPLE_LIGHT(i) lights[(batch.first + gl_WorkGroupID.x) * uint(LIGHT_STRIDE) + (i)]
#define SAMPLE_GRADIENT(i) gradients[(batch.first + gl_WorkGroupID.x) * uint(GRADIENT_STRIDE) + (i)]

#include "radiance/sums.glsl"
#include "radiance/polygon.glsl"
#include "radiance/sphere.glsl"

#define MOST 32

// Unit corners, and in the first one's fourth component whether the triangle emits.
shared vec4 unit[3 * MOST];
shared uint overlaps;

bool emits(vec3 radiance)
{
    return max(radiance.r, max(radiance.g, radiance.b)) > 0.0;
}

// Whether a sphere shares directions with another body, of which triangles come first, or holds the point.
bool sphere_overlaps(vec3 point, uint sphere, uint other, uint triangle_count)
{
    vec3 centre = spheres[sphere].place.xyz - point;
    float radius = spheres[sphere].place.w;
    bool bright = emits(spheres[sphere].radiance.rgb);
    Cap cap = cap_of(centre, radius);
    bool inside = dot(centre, centre) <= radius * radius;
    uint i = min(other, triangle_count - 1u);
    vec3 corners[3] = vec3[3](unit[3u * i].xyz, unit[3u * i + 1u].xyz, unit[3u * i + 2u].xyz);
    bool hides = (bright || unit[3u * i].w > 0.0) && cap_overlaps(cap, corners);
    if (other >= triangle_count) {
        Sphere second = spheres[other - triangle_count];
        bool behind = other - triangle_count <= sphere;
        hides = !behind && (bright || emits(second.radiance.rgb))
            && caps_overlap(cap, cap_of(second.place.xyz - point, second.place.w));
    }
    return hides || inside;
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    vec3 point = points[batch.first + gl_WorkGroupID.x].xyz;
    uint count = min(settings.triangle_count, uint(MOST));
    uint sphere_count = min(settings.sphere_count, uint(MOST) - count);
    vec3 corners[3] = vec3[3](vec3(0.0), vec3(0.0), vec3(0.0));
    vec3 radiance = vec3(0.0);
    if (lane < count) {
        vec4 a = triangles[lane].corners[0];
        vec4 b = triangles[lane].corners[1];
        vec4 c = triangles[lane].corners[2];
        corners = vec3[3](a.xyz - point, b.xyz - point, c.xyz - point);
        radiance = vec3(a.w, b.w, c.w);
        float bright = emits(radiance) ? 1.0 : 0.0;
        for (uint k = 0u; k < 3u; ++k) {
            unit[3u * lane + k] = vec4(corners[k] * inversesqrt(max(dot(corners[k], corners[k]), 1e-37)), bright);
        }
    }
    if (lane == 0u) { overlaps = 0u; }
    barrier();
    for (uint pair = lane; pair < count * count; pair += uint(LANES)) {
        uint i = pair / count;
        uint j = pair % count;
        if (i < j && unit[3u * i].w + unit[3u * j].w > 0.0) {
            vec3 one[3] = vec3[3](unit[3u * i].xyz, unit[3u * i + 1u].xyz, unit[3u * i + 2u].xyz);
            vec3 other[3] = vec3[3](unit[3u * j].xyz, unit[3u * j + 1u].xyz, unit[3u * j + 2u].xyz);
            if (triangles_overlap(one, other)) { atomicOr(overlaps, 1u); }
        }
    }
    uint bodies = count + sphere_count;
    for (uint pair = lane; pair < sphere_count * bodies; pair += uint(LANES)) {
        if (sphere_overlaps(point, pair / bodies, pair % bodies, count)) { atomicOr(overlaps, 1u); }
    }
    bool touches = edge_touches(corners[0], corners[1]) || edge_touches(corners[1], corners[2])
        || edge_touches(corners[2], corners[0]);
    if (touches && emits(radiance)) { atomicOr(overlaps, 1u); }
    barrier();
    bool exact = overlaps == 0u;
    vec4 sums[ELEMENTS];
    if (!exact) { radiance = vec3(0.0); }
    polygon_sums(corners[0], corners[1], corners[2], radiance, sums);
    uint sphere = lane - count;
    // A loop, not a branch: software drivers run through a branch that nobody takes.
    for (bool mine = exact && lane >= count && sphere < sphere_count; mine; mine = false) {
        vec3 glow = spheres[sphere].radiance.rgb;
        if (emits(glow)) { sphere_sums(spheres[sphere].place.xyz - point, spheres[sphere].place.w, glow, sums); }
    }
    if (lane == 0u && exact) { sums[SUMS_FOUND].w = EXACT; }
    sums_write(sums, lane, settings.keep == 0u || SAMPLE_LIGHT(uint(LIGHT_EXTENT)).z < KEPT);
}
