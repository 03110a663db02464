//! Normals and tangents for meshes that lack them, in the vertex order of the mesh.

mod normals;
mod tangents;

pub use normals::{count_degenerate, generate_normals};
pub use tangents::generate_tangents;
