// The tree over a receiver's vertices and the samples that its nodes hold: passes/radiance/src/gpu/tree.rs.
//
// Nodes lie depth first, halves of a node of n vertices behind it, so that the 2n - 1 nodes with and below it are
// consecutive: a walk skips what lies below by adding to its index, and needs no stack and no pointer.

#ifndef RADIANCE_TREE_GLSL
#define RADIANCE_TREE_GLSL

struct Node {
    vec3 mean; // where its sample is taken, metres
    float bound; // about the mean: holds the domains of its own sample and of all below
    float reach; // about the mean: holds its vertices
    float weight; // what the oracle multiplies a sample's signal with; below 0 where no vertex reflects light
    uint count; // vertices
    float share; // colour that a change of the light of norm 1 makes, over all vertices
};

// A node that was split: its parts were sampled in its place.
const uint SPLIT = 0x80000000u;

uint nodes_with_and_below(Node node)
{
    return 2u * node.count - 1u;
}

#endif
