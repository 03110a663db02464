//! What stands for the normals of a normal map under a pixel.

use airglow_gpu::{BindingDesc, BindingKind};
use clap::ValueEnum;

use super::scene::Look;

/// How normal maps are filtered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Filter {
    /// Mixtures of lobes, by the normals room.
    #[default]
    Lobes,
    /// The same in four bytes a lobe.
    Octahedral,
    /// The mean normal, whose length widens the reflection (Toksvig 2005).
    Toksvig,
    /// Nine coefficients of spherical harmonics, by the normals room: for matt surfaces.
    Harmonics,
    /// Mean and moments of the slope (Olano and Baker 2010).
    Lean,
    /// The mean normal, scaled to length 1: plain MIP-mapping.
    Mip,
    /// The map's own texels at every distance. With --samples and --passes this is the truth.
    Texels,
}

/// What surfaces with normal maps lie under.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(not(feature = "normals"), allow(dead_code, reason = "only the room of normal maps makes it"))]
pub struct Under {
    /// A medium, whose glow they reflect.
    pub fogged: bool,
    /// Light from all around, as the vertices' incident radiance tells it.
    pub incident: bool,
}

/// The fragment stages of surfaces with normal maps that are looked up in one way.
#[cfg_attr(not(feature = "normals"), allow(dead_code, reason = "only the room of normal maps makes it"))]
pub struct MappedFragments {
    /// How.
    pub look: Look,
    /// Whether in fog.
    pub fogged: bool,
    /// Under the scene's lights, what the vertices bring being reflected as by a flat map.
    pub plain: Vec<u32>,
    /// With the incident radiance of the vertices, so many bytes each; `None` where no frame has it.
    pub incident: Option<(u32, Vec<u32>)>,
}

/// For a surface with a normal map: the map, what is kept of its coarser levels, and how each is sampled; the last for the
/// tables of lobes in fog.
pub const MAPPED_BINDINGS: [BindingDesc; 9] = [
    BindingDesc::new(0, BindingKind::UniformBuffer),
    BindingDesc::new(1, BindingKind::SampledImage),
    BindingDesc::new(2, BindingKind::Sampler),
    BindingDesc::new(3, BindingKind::UniformBuffer),
    BindingDesc::new(5, BindingKind::SampledImage),
    BindingDesc::new(6, BindingKind::Sampler),
    BindingDesc::new(7, BindingKind::SampledImage),
    BindingDesc::new(8, BindingKind::Sampler),
    BindingDesc::new(4, BindingKind::StorageBuffer),
];
