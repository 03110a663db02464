//! Normals and tangents for meshes that lack them, in the vertex order of the mesh; meshes with more vertices; emitters
//! as triangles.

mod emitter;
mod normals;
mod subdivide;
mod tangents;

pub use emitter::emitter;
pub use normals::{count_degenerate, generate_normals};
pub use subdivide::subdivide;
pub use tangents::generate_tangents;
