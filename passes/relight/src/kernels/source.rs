//! What the kernels over vertices are lit by.

use crate::settings::{Output, Settings};

/// Which vectors of a vertex a kernel reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Source {
    /// Only the baked ones.
    Baked,
    /// Only the dynamic visibility.
    Dynamic,
    /// Both.
    Both,
    /// Transfer of the current normals.
    Normals,
    /// Transfer of the current normals, and the dynamic visibility.
    ShadowedNormals,
    /// None: nothing blocks the incident radiance.
    Open,
}

impl Source {
    /// Those that instances may have under these settings.
    pub(crate) fn all(settings: &Settings) -> Vec<Self> {
        let (colour, shadows) = (settings.output == Output::Colour, settings.visibility);
        let possible = [
            (Self::Baked, true),
            (Self::Both, shadows),
            (Self::Dynamic, !colour && shadows),
            (Self::Open, !colour),
            (Self::Normals, settings.normals),
            (Self::ShadowedNormals, settings.normals && shadows),
        ];
        possible.into_iter().filter_map(|(source, possible)| possible.then_some(source)).collect()
    }

    /// Whether transfer is made from normals.
    pub(crate) fn has_normals(self) -> bool {
        matches!(self, Self::Normals | Self::ShadowedNormals)
    }

    /// Whether there is dynamic visibility.
    pub(crate) fn is_shadowed(self) -> bool {
        matches!(self, Self::Dynamic | Self::Both | Self::ShadowedNormals)
    }

    /// The same for frames in which the dynamic visibility blocks nothing; none where there is no dynamic visibility.
    pub(crate) fn unshadowed(self) -> Option<Self> {
        match self {
            Self::Both => Some(Self::Baked),
            Self::Dynamic => Some(Self::Open),
            Self::ShadowedNormals => Some(Self::Normals),
            Self::Baked | Self::Normals | Self::Open => None,
        }
    }
}
