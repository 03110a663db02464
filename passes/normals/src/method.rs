//! What may be kept of the normals under a texel, by the names that evaluation and reports use.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use crate::NormalsError;
use crate::brdf::{Brdf, Directions};
use crate::fit::{FitSettings, fit};
use crate::harmonics::Harmonics;
use crate::map::NormalMap;
use crate::rivals::{self, Lean};
use crate::shade;

/// A way to keep and to shade what lies under a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// `vmf:J`: a mixture of J lobes, 1, 2, 4 or 6.
    Lobes(usize),
    /// `vmf:4x4`: the same of 4 lobes at the four texels of the level below, each shaded by itself: no more memory, four
    /// times the shading.
    Taps,
    /// `sh:n`: spherical harmonics of n bands, 3 to 5.
    Harmonics(usize),
    /// `mip`: the mean normal, scaled to length 1.
    Mip,
    /// `length`: the mean normal as long as it is.
    Length,
    /// `toksvig`: the exponent falls with the length of the mean normal.
    Toksvig,
    /// `roughness`: the length of the mean normal as a variance, added to the roughness.
    Roughness,
    /// `geometric`: the change of the mean normal to the next texels, added to the roughness.
    Geometric,
    /// `lean`: mean and moments of the slope.
    Lean,
}

impl Method {
    /// Every method on the device.
    pub const ALL: [Self; 14] = [
        Self::Lobes(1),
        Self::Lobes(2),
        Self::Lobes(4),
        Self::Lobes(6),
        Self::Taps,
        Self::Harmonics(3),
        Self::Harmonics(4),
        Self::Harmonics(5),
        Self::Mip,
        Self::Length,
        Self::Toksvig,
        Self::Roughness,
        Self::Geometric,
        Self::Lean,
    ];

    /// Numbers that a texture keeps of a texel.
    #[must_use]
    pub fn numbers(self) -> usize {
        match self {
            Self::Lobes(lobes) => 4 * lobes,
            Self::Taps => 16,
            Self::Harmonics(order) => order * order,
            Self::Mip | Self::Length | Self::Toksvig | Self::Roughness | Self::Geometric => 3,
            Self::Lean => 5,
        }
    }

    /// The radiance of a texel in f64, from all normals under it.
    ///
    /// # Errors
    /// [`NormalsError::Texel`], [`NormalsError::Range`], [`NormalsError::Math`].
    pub fn radiance(
        self,
        map: &NormalMap,
        [level, x, y]: [usize; 3],
        brdf: Brdf,
        directions: Directions,
    ) -> Result<f64, NormalsError> {
        let footprint = map.footprint(level, x, y)?;
        let mean = rivals::mean(&footprint);
        Ok(match self {
            Self::Lobes(lobes) => {
                let mixture = fit(&footprint, &FitSettings { lobes, ..Default::default() })?;
                shade::radiance(&mixture, brdf, directions)
            }
            Self::Taps => {
                let four = below(map, [level, x, y]);
                let four = four.map(|texel| Self::Lobes(4).radiance(map, texel, brdf, directions));
                four.into_iter().sum::<Result<f64, _>>()? / 4.0
            }
            Self::Harmonics(order) => Harmonics::new(order, &footprint)?.radiance(brdf, directions)?,
            Self::Mip => rivals::mip(mean, true, brdf, directions),
            Self::Length => rivals::mip(mean, false, brdf, directions),
            Self::Toksvig => rivals::toksvig(mean, brdf, directions),
            Self::Roughness => rivals::roughened(mean, brdf, directions),
            Self::Geometric => {
                let [width, height] = map.size(level);
                let normal = |x: usize, y: usize| -> Result<DVec3, NormalsError> {
                    let footprint = map.footprint(level, x.min(width - 1), y.min(height - 1))?;
                    Ok(rivals::mean(&footprint).try_normalize().unwrap_or(DVec3::Z))
                };
                let own = normal(x, y)?;
                let change =
                    (normal(x + 1, y)? - own).length_squared() + (normal(x, y + 1)? - own).length_squared();
                rivals::geometric(mean, change, brdf, directions)
            }
            Self::Lean => Lean::new(&footprint).radiance(brdf, directions),
        })
    }
}

/// Level, column and row of the four texels under one; of a texel of the map, itself.
pub(crate) fn below(map: &NormalMap, [level, x, y]: [usize; 3]) -> [[usize; 3]; 4] {
    let Some(finer) = level.checked_sub(1) else { return [[level, x, y]; 4] };
    let [width, height] = map.size(finer);
    [0, 1, 2, 3].map(|i| [finer, (2 * x + i % 2).min(width - 1), (2 * y + i / 2).min(height - 1)])
}

impl fmt::Display for Method {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lobes(lobes) => write!(formatter, "vmf:{lobes}"),
            Self::Taps => formatter.write_str("vmf:4x4"),
            Self::Harmonics(order) => write!(formatter, "sh:{order}"),
            Self::Mip => formatter.write_str("mip"),
            Self::Length => formatter.write_str("length"),
            Self::Toksvig => formatter.write_str("toksvig"),
            Self::Roughness => formatter.write_str("roughness"),
            Self::Geometric => formatter.write_str("geometric"),
            Self::Lean => formatter.write_str("lean"),
        }
    }
}

impl FromStr for Method {
    type Err = NormalsError;

    /// A method by its name; `default` is `vmf:4`.
    ///
    /// # Errors
    /// [`NormalsError::Method`] with all names.
    fn from_str(name: &str) -> Result<Self, NormalsError> {
        let named = Self::ALL.into_iter().find(|method| method.to_string() == name);
        let default = (name == "default").then_some(Self::Lobes(4));
        named.or(default).ok_or_else(|| NormalsError::Method { method: name.to_owned() })
    }
}
