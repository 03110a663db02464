//! What a frame uses, by name.

use std::fmt;

/// What a stage uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Resource {
    /// The tree over the vertices.
    Tree,
    /// The vertices.
    Vertices,
    /// Balls that hold those of a workgroup.
    Groups,
    /// Rotation into the space of a part's light, by its index.
    Rotation(u32),
    /// The sample of each node.
    Slots,
    /// The node of each sample.
    Places,
    /// Where each sample is taken.
    Points,
    /// The light of each sample.
    Lights,
    /// Its gradients.
    Gradients,
    /// How far refinement went.
    State,
    /// The node of each sample of the frame before.
    OldPlaces,
    /// The light of each of these.
    OldLights,
    /// Their gradients.
    OldGradients,
    /// How far refinement went in the frame before.
    OldState,
    /// The light of the vertices of a part, by its index: the result.
    VertexLight(u32),
}

impl fmt::Display for Resource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tree => f.write_str("radiance tree"),
            Self::Vertices => f.write_str("radiance vertices"),
            Self::Groups => f.write_str("radiance groups"),
            Self::Rotation(part) => write!(f, "radiance rotation of part {part}"),
            Self::Slots => f.write_str("radiance slots"),
            Self::Places => f.write_str("radiance places"),
            Self::Points => f.write_str("radiance points"),
            Self::Lights => f.write_str("radiance lights"),
            Self::Gradients => f.write_str("radiance gradients"),
            Self::State => f.write_str("radiance state"),
            Self::OldPlaces => f.write_str("radiance places of the frame before"),
            Self::OldLights => f.write_str("radiance lights of the frame before"),
            Self::OldGradients => f.write_str("radiance gradients of the frame before"),
            Self::OldState => f.write_str("radiance state of the frame before"),
            Self::VertexLight(part) => write!(f, "radiance light of part {part}"),
        }
    }
}
