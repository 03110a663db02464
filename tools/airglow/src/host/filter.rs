//! What stands for the normals of a normal map under a pixel.

use clap::ValueEnum;

/// How normal maps are filtered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Filter {
    /// Mixtures of lobes, by the normals room.
    #[default]
    Lobes,
    /// The mean normal, whose length widens the reflection (Toksvig 2005).
    Toksvig,
    /// Mean and moments of the slope (Olano and Baker 2010).
    Lean,
    /// The mean normal, scaled to length 1: plain MIP-mapping.
    Mip,
    /// The map's own texels at every distance. With --samples and --passes this is the truth.
    Texels,
}
