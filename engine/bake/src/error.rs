//! What can go wrong in a bake, each with its mend.

/// Why a bake refused its input or stopped. Every message names the mesh or setting and the mend.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The progress callback asked to stop. Nothing was written.
    #[error("the bake was cancelled")]
    Cancelled,
    /// Two slices that must be equally long are not.
    #[error("mesh `{mesh}`: {positions} positions but {normals} normals; give one normal per vertex")]
    NormalCount {
        /// Name of the mesh.
        mesh: String,
        /// Number of positions.
        positions: usize,
        /// Number of normals.
        normals: usize,
    },
    /// The index count is no multiple of three.
    #[error("mesh `{mesh}`: {count} indices are no whole number of triangles; give three per triangle")]
    IndexCount {
        /// Name of the mesh.
        mesh: String,
        /// Number of indices.
        count: usize,
    },
    /// An index points past the last vertex.
    #[error(
        "mesh `{mesh}`: index {value} at place {place} is past the last of {vertices} vertices; mend the index buffer"
    )]
    IndexOutOfRange {
        /// Name of the mesh.
        mesh: String,
        /// Place in the index slice.
        place: usize,
        /// The index.
        value: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A position or normal is NaN or infinite, or a transformed position overflows f32.
    #[error("mesh `{mesh}`: {what} of vertex {vertex} is not finite; remove the vertex or mend its data")]
    NotFinite {
        /// Name of the mesh.
        mesh: String,
        /// "position", "normal" or "world position".
        what: &'static str,
        /// Index of the vertex.
        vertex: usize,
    },
    /// A transform has no inverse, is not affine, or is not finite.
    #[error("mesh `{mesh}`: its transform {why}; give a finite, affine, invertible matrix")]
    Transform {
        /// Name of the mesh.
        mesh: String,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A setting is out of its range.
    #[error("setting `{name}` is {value}, outside {range}")]
    Setting {
        /// Name of the field.
        name: &'static str,
        /// Its value.
        value: String,
        /// The range it must lie in.
        range: &'static str,
    },
    /// More triangles or vertices than the hierarchy or the result can hold.
    #[error("{what}: {count} is more than {limit}; bake in parts")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The bounding-volume hierarchy is deeper than its traversal stack.
    #[error(
        "the occluders' hierarchy is {depth} levels deep, more than {limit}; remove triangles nested at ever smaller scales"
    )]
    TooDeep {
        /// Levels found.
        depth: usize,
        /// Levels allowed.
        limit: usize,
    },
    /// The mathematics room refused a value.
    #[error(transparent)]
    Math(#[from] airglow_math::MathError),
}
