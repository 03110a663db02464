//! Relighting by precomputed radiance transfer in spherical harmonics, rendered to a vertex array.
