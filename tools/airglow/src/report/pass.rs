//! The passes that can be measured and tried, and the scene that shows each.

use clap::ValueEnum;

/// Passes that can be measured, and tried on extreme inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Pass {
    /// Relighting by precomputed radiance transfer.
    Relight,
    /// Single scattering from lights inside a medium.
    #[cfg(feature = "fog")]
    Fog,
    /// Incident radiance of near emitters.
    #[cfg(feature = "radiance")]
    Radiance,
    /// Normal maps filtered as distributions of normals.
    #[cfg(feature = "normals")]
    Normals,
    /// Soft shadows of what moves.
    #[cfg(feature = "shadow")]
    Shadow,
}

impl Pass {
    /// The scene that shows it.
    pub fn scene(self) -> &'static str {
        match self {
            Self::Relight => "assets/scenes/spot.toml",
            #[cfg(feature = "fog")]
            Self::Fog => "assets/scenes/street.toml",
            #[cfg(feature = "radiance")]
            Self::Radiance => "assets/scenes/blocks.toml",
            #[cfg(feature = "normals")]
            Self::Normals => "assets/scenes/grooves.toml",
            #[cfg(feature = "shadow")]
            Self::Shadow => "assets/scenes/walkers.toml",
        }
    }

    /// As commands and tables have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Relight => "relight",
            #[cfg(feature = "fog")]
            Self::Fog => "fog",
            #[cfg(feature = "radiance")]
            Self::Radiance => "radiance",
            #[cfg(feature = "normals")]
            Self::Normals => "normals",
            #[cfg(feature = "shadow")]
            Self::Shadow => "shadow",
        }
    }
}
