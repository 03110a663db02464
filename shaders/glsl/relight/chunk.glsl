// A chunk: a range of a mesh's vertices small enough for one storage-buffer range. Every binding starts at its
// first vertex.
//
// ORDER  1-6: bands, ORDER^2 coefficients in a vector

#define COEFFICIENTS (ORDER * ORDER)

layout(push_constant) uniform Chunk {
    uint vertex_count;
    uint stride; // words between two planes of a vector stored in planes
    uint first_row; // of the packed rectangle; only the fragment method reads it
} chunk;
