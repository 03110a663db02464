#version 460
#extension GL_GOOGLE_include_directive : require
// Mixtures of the texels of a level from the samples of a finer one: normals of level 0, or lobes. One invocation a texel.
//
// Seeds by splitting the widest cluster across its longest axis, then steps of expectation and maximisation (Banerjee,
// Dhillon, Ghosh and Sra 2005, algorithm 2). A sample is vec4(weight * mean vector, weight), as a lobe is stored.
//
// LOBES  1-6

#include "normals/lobe.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Samples {
    vec4 values[]; // texel by texel, row by row: as many as there are for a texel
} samples;

layout(std430, set = 0, binding = 1) buffer Lobes {
    vec4 values[]; // LOBES a texel, row by row
} lobes;

layout(push_constant) uniform Settings {
    uvec2 fine;      // texels of the level of the samples
    uvec2 size;      // texels of this level
    uint per_texel;  // samples of a texel
    uint iterations;
    float sharpest;  // concentration
    uint first;      // texel of the first invocation: levels are fitted in bands
} settings;

// Second moments of a cluster, about its mean, and its weighted mean.
struct Cluster {
    vec4 lobe;
    vec3 diagonal; // xx, yy, zz, weighted
    vec3 mixed;    // xy, xz, yz
};

// Samples on the far side of a plane leave `from`.
struct Cut {
    vec4 plane;
    int from;
};

Cut cuts[LOBES];
Cluster clusters[LOBES];
uvec4 window; // first and last column and row, both within

// The sample, its weight times the share of it that lies under the texel.
vec4 sample_at(uvec2 texel, uvec2 place, uint which)
{
    uvec2 begin = max(texel * settings.fine, place * settings.size);
    uvec2 end = min((texel + 1u) * settings.fine, (place + 1u) * settings.size);
    vec2 share = vec2(end - begin) / vec2(settings.fine);
    return share.x * share.y * samples.values[(place.y * settings.fine.x + place.x) * settings.per_texel + which];
}

int label(vec3 mean, int count)
{
    int found = 0;
    for (int i = 1; i < count; ++i) {
        if (found == cuts[i].from && dot(cuts[i].plane.xyz, mean) > cuts[i].plane.w) { found = i; }
    }
    return found;
}

// The clusters that the cuts so far make: means first, then moments about them.
void gather(uvec2 texel, int count)
{
    for (int i = 0; i < count; ++i) { clusters[i] = Cluster(vec4(0.0), vec3(0.0), vec3(0.0)); }
    for (int turn = 0; turn < 2; ++turn) {
        for (uint y = window.z; y <= window.w; ++y) {
            for (uint x = window.x; x <= window.y; ++x) {
                for (uint which = 0u; which < settings.per_texel; ++which) {
                    vec4 found = sample_at(texel, uvec2(x, y), which);
                    if (found.w <= 0.0) { continue; }
                    vec3 mean = found.xyz / found.w;
                    int at = label(mean, count);
                    if (turn == 0) {
                        clusters[at].lobe += found;
                    } else {
                        vec3 offset = mean - clusters[at].lobe.xyz / clusters[at].lobe.w;
                        clusters[at].diagonal += found.w * offset * offset;
                        clusters[at].mixed += found.w * offset.xxy * offset.yzz;
                    }
                }
            }
        }
    }
}

// The plane across the longest axis of a cluster, through its mean.
vec4 halving(Cluster cluster)
{
    vec3 d = cluster.diagonal;
    vec3 m = cluster.mixed;
    mat3 covariance = mat3(d.x, m.x, m.y, m.x, d.y, m.z, m.y, m.z, d.z);
    vec3 axis = covariance[0];
    if (dot(covariance[1], covariance[1]) > dot(axis, axis)) { axis = covariance[1]; }
    if (dot(covariance[2], covariance[2]) > dot(axis, axis)) { axis = covariance[2]; }
    axis = normalize(axis);
    for (int i = 0; i < 16; ++i) { axis = normalize(covariance * axis); }
    return vec4(axis, dot(axis, cluster.lobe.xyz / cluster.lobe.w));
}

void seed(uvec2 texel)
{
    gather(texel, 1);
    for (int count = 1; count < LOBES; ++count) {
        int widest = 0;
        float spread = 0.0;
        for (int i = 0; i < count; ++i) {
            float found = dot(clusters[i].diagonal, vec3(1.0));
            if (found > spread) { spread = found; widest = i; }
        }
        if (spread <= 1e-9) { // what rounding leaves of equal normals
            for (int i = count; i < LOBES; ++i) { clusters[i].lobe = vec4(0.0); }
            return;
        }
        cuts[count] = Cut(halving(clusters[widest]), widest);
        gather(texel, count + 1);
    }
}

// One step: shares of each sample by the lobes there are, then the lobes of these shares.
void improve(uvec2 texel)
{
    vec4 heights[LOBES]; // concentration times axis; logarithm of weight and height
    vec4 next[LOBES];
    for (int j = 0; j < LOBES; ++j) {
        vec4 stored = clusters[j].lobe;
        NormalsLobe lobe = normals_lobe(stored);
        float k = min(lobe.concentration, settings.sharpest);
        heights[j] = vec4(lobe.axis, k);
        clusters[j].diagonal.x = stored.w > 1e-7 ? log(stored.w / normals_opening(k)) : -1e30;
        next[j] = vec4(0.0);
    }
    for (uint y = window.z; y <= window.w; ++y) {
        for (uint x = window.x; x <= window.y; ++x) {
            for (uint which = 0u; which < settings.per_texel; ++which) {
                vec4 found = sample_at(texel, uvec2(x, y), which);
                if (found.w <= 0.0) { continue; }
                vec3 mean = found.xyz / found.w;
                float shares[LOBES];
                float largest = -1e30;
                for (int j = 0; j < LOBES; ++j) {
                    shares[j] = clusters[j].diagonal.x + heights[j].w * (dot(heights[j].xyz, mean) - 1.0);
                    largest = max(largest, shares[j]);
                }
                float total = 0.0;
                for (int j = 0; j < LOBES; ++j) {
                    shares[j] = exp(shares[j] - largest);
                    total += shares[j];
                }
                for (int j = 0; j < LOBES; ++j) { next[j] += shares[j] / total * found; }
            }
        }
    }
    for (int j = 0; j < LOBES; ++j) { clusters[j].lobe = next[j]; }
}

void main()
{
    uint at = settings.first + gl_GlobalInvocationID.x;
    if (at >= settings.size.x * settings.size.y) { return; }
    uvec2 texel = uvec2(at % settings.size.x, at / settings.size.x);
    uvec2 first = texel * settings.fine / settings.size;
    uvec2 last = ((texel + 1u) * settings.fine + settings.size - 1u) / settings.size - 1u;
    window = uvec4(first.x, last.x, first.y, last.y);
    seed(texel);
    for (uint i = 0u; i < settings.iterations; ++i) { improve(texel); }
    for (int j = 0; j < LOBES; ++j) { lobes.values[at * uint(LOBES) + uint(j)] = clusters[j].lobe; }
}
