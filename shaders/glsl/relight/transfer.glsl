// The vectors baked for the vertices of a chunk: transfer vectors, or static visibility vectors for the incident
// kernel. They are stored alike.
//
// STORAGE_F32, STORAGE_F16 (two halves a word, low half first, in units of TRANSFER_UNIT)
// LAYOUT_PLANES          one word of every vertex after another
// LAYOUT_VERTICES        one vertex after another, no padding
// LAYOUT_VERTEX_BLOCKS   one vertex after another, blocks of four coefficients, padded with zeros
// LAYOUT_BLOCK_PLANES    one block of four coefficients of every vertex after another, padded with zeros

#include "relight/chunk.glsl"

// The finest step of a half float is 2^-24: too coarse, in units of 1, for vertices that see next to nothing.
#define TRANSFER_UNIT (1.0 / 1024.0)

#define BLOCKS ((COEFFICIENTS + 3) / 4)
#if defined(LAYOUT_VERTEX_BLOCKS) || defined(LAYOUT_BLOCK_PLANES)
#define BLOCKED
#define WORDS BLOCKS
#ifdef STORAGE_F16
#define TRANSFER_WORD uvec2
#else
#define TRANSFER_WORD vec4
#endif
#elif defined(STORAGE_F16)
#define WORDS ((COEFFICIENTS + 1) / 2)
#define TRANSFER_WORD uint
#else
#define WORDS COEFFICIENTS
#define TRANSFER_WORD float
#endif

layout(std430, set = 0, binding = 0) readonly buffer Transfer {
    TRANSFER_WORD words[];
} transfer;

#if defined(LAYOUT_VERTICES) || defined(LAYOUT_VERTEX_BLOCKS)
#define WORD_INDEX(vertex, word) ((vertex) * uint(WORDS) + (word))
#else
#define WORD_INDEX(vertex, word) ((word) * chunk.stride + (vertex))
#endif

// Nothing to make: the vectors are read where they are used.
void load_transfer(uint vertex) {}

// Coefficients 4 block .. 4 block + 3 of a vertex; those past the last are zero or are not read.
vec4 transfer_block(uint vertex, uint block)
{
#ifdef BLOCKED
    TRANSFER_WORD word = transfer.words[WORD_INDEX(vertex, block)];
#ifdef STORAGE_F16
    return TRANSFER_UNIT * vec4(unpackHalf2x16(word.x), unpackHalf2x16(word.y));
#else
    return word;
#endif
#elif defined(STORAGE_F32)
    uint first = 4u * block;
    vec4 result = vec4(transfer.words[WORD_INDEX(vertex, first)], 0.0, 0.0, 0.0);
    if (first + 1u < uint(COEFFICIENTS)) { result.y = transfer.words[WORD_INDEX(vertex, first + 1u)]; }
    if (first + 2u < uint(COEFFICIENTS)) { result.z = transfer.words[WORD_INDEX(vertex, first + 2u)]; }
    if (first + 3u < uint(COEFFICIENTS)) { result.w = transfer.words[WORD_INDEX(vertex, first + 3u)]; }
    return result;
#else
    uint first = 2u * block;
    vec4 result = vec4(unpackHalf2x16(transfer.words[WORD_INDEX(vertex, first)]), 0.0, 0.0);
    if (first + 1u < uint(WORDS)) { result.zw = unpackHalf2x16(transfer.words[WORD_INDEX(vertex, first + 1u)]); }
    return TRANSFER_UNIT * result;
#endif
}

// One coefficient of a vertex, for kernels that visit them out of order.
float transfer_coefficient(uint vertex, uint index)
{
#ifdef BLOCKED
    return transfer_block(vertex, index / 4u)[index % 4u];
#elif defined(STORAGE_F32)
    return transfer.words[WORD_INDEX(vertex, index)];
#else
    vec2 pair = unpackHalf2x16(transfer.words[WORD_INDEX(vertex, index / 2u)]);
    return TRANSFER_UNIT * ((index % 2u) == 0u ? pair.x : pair.y);
#endif
}
