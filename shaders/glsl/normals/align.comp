#version 460
#extension GL_GOOGLE_include_directive : require
// Sorts the lobes of a level into the places of the next coarser one, so that interpolation between texels and levels
// mixes like with like. One invocation a texel.
//
// Lobes of one place become one: where a texel has fewer modes than its surroundings, lobes that differ little share a place
// rather than take that of a mode which is not theirs. Places are chosen so that the mixture halfway between the texel
// and the coarser one stays as narrow as it can, by exchanging lobes one by one (Hartigan 1975).
//
// LOBES  2-6

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Coarse {
    vec4 values[]; // LOBES a texel, row by row, in their places
} coarse;

layout(std430, set = 0, binding = 1) buffer Lobes {
    vec4 values[]; // LOBES a texel, row by row
} lobes;

layout(push_constant) uniform Settings {
    uvec2 coarse_size; // texels of the coarser level
    uvec2 size;        // texels of this level
} settings;

const int SWEEPS = 4;
// An empty place without a trace is for what is farther than this from all others, a variance.
const float APART = 1e-4;
// What the coarser lobe of a place weighs while others are sorted into it.
const float PRESENCE = 0.1;
// The weight that an empty place keeps of the coarser lobe, so that finer texels know whose place it is.
const float TRACE = 1e-6;

vec4 own[LOBES];
vec4 traces[LOBES]; // what empty places keep
vec4 filled[LOBES]; // the coarser lobe of a place and what was put to it
int place[LOBES];   // of each lobe

// Weight times squared length of the mean: what is lost of it in a sum is spread.
float narrowness(vec4 lobe)
{
    return lobe.w > 0.0 ? dot(lobe.xyz, lobe.xyz) / lobe.w : 0.0;
}

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.size.x * settings.size.y) { return; }
    uvec2 texel = uvec2(at % settings.size.x, at / settings.size.x);
    uvec2 parent = min(texel * settings.coarse_size / settings.size, settings.coarse_size - 1u);
    uint above = (parent.y * settings.coarse_size.x + parent.x) * uint(LOBES);
    for (int j = 0; j < LOBES; ++j) {
        own[j] = lobes.values[at * uint(LOBES) + uint(j)];
        vec4 kept = coarse.values[above + uint(j)];
        vec4 unit = kept.w > 0.0 ? kept / kept.w : vec4(0.0);
        traces[j] = TRACE * unit;
        filled[j] = PRESENCE * unit;
        place[j] = -1;
    }
    for (int sweep = 0; sweep < SWEEPS; ++sweep) {
        for (int i = 0; i < LOBES; ++i) {
            if (place[i] >= 0) { filled[place[i]] -= own[i]; }
            float most = -1e30;
            for (int j = 0; j < LOBES; ++j) {
                float gain = narrowness(filled[j] + own[i]) - narrowness(filled[j]);
                if (filled[j].w <= 0.0) { gain -= APART * own[i].w; }
                if (gain > most) { most = gain; place[i] = j; }
            }
            filled[place[i]] += own[i];
        }
    }
    for (int j = 0; j < LOBES; ++j) { filled[j] = vec4(0.0); }
    for (int i = 0; i < LOBES; ++i) { filled[place[i]] += own[i]; }
    for (int j = 0; j < LOBES; ++j) {
        lobes.values[at * uint(LOBES) + uint(j)] = filled[j].w > TRACE ? filled[j] : traces[j];
    }
}
