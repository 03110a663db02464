//! What the light travels through.

use std::f64::consts::PI;

use crate::FogError;
use crate::error::check;

/// Contrast that is left of a black object against the sky at the visibility distance: 3.912 of optical thickness
/// (Koschmieder 1924).
pub const VISIBILITY_CONTRAST: f64 = 0.02;

/// The largest |g|: as far as the error of the taps is held to quadrature.
pub const MAX_G: f64 = 0.999;

/// A kind of phase function: which kernel there is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PhaseKind {
    /// Alike in all directions.
    Isotropic,
    /// Powers of the cosine to the third.
    Polynomial,
    /// Henyey and Greenstein's.
    HenyeyGreenstein,
    /// Draine's.
    Draine,
}

/// The share of scattered light that leaves at a cosine from the way it came, 1/sr; cosine 1 is straight on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// 1 / (4 pi).
    Isotropic,
    /// The sum of `w[k] cosine^k`: the weights hold the 1 / (4 pi) (Sun 2008, eq. 3.18). Nowhere negative.
    Polynomial([f64; 4]),
    /// Henyey and Greenstein 1941; g, the mean cosine, is at most [`MAX_G`] from 0.
    HenyeyGreenstein {
        /// Mean cosine.
        g: f64,
    },
    /// Draine 2003, eq. 4: Rayleigh's shape at g = 0, alpha = 1.
    Draine {
        /// At most [`MAX_G`] from 0.
        g: f64,
        /// From 0 on.
        alpha: f64,
    },
}

impl Phase {
    /// The kernel it needs.
    #[must_use]
    pub fn kind(&self) -> PhaseKind {
        match self {
            Self::Isotropic => PhaseKind::Isotropic,
            Self::Polynomial(_) => PhaseKind::Polynomial,
            Self::HenyeyGreenstein { .. } => PhaseKind::HenyeyGreenstein,
            Self::Draine { .. } => PhaseKind::Draine,
        }
    }

    /// As a kernel of `kind` takes it; `None` if that cannot express it.
    pub(crate) fn values(&self, kind: PhaseKind) -> Option<[f32; 4]> {
        let values = match (*self, kind) {
            (Self::Isotropic, PhaseKind::Polynomial) => [0.25 / PI, 0.0, 0.0, 0.0],
            (Self::Isotropic, _) => [0.0; 4],
            (Self::Polynomial(weights), PhaseKind::Polynomial) => weights,
            (Self::HenyeyGreenstein { g }, PhaseKind::HenyeyGreenstein | PhaseKind::Draine) => {
                [g, 0.0, 0.0, 0.0]
            }
            (Self::Draine { g, alpha }, PhaseKind::Draine) => [g, alpha, 0.0, 0.0],
            _ => return None,
        };
        Some(values.map(|value| value as f32))
    }

    /// Its value, 1/sr.
    #[must_use]
    pub fn value(&self, cosine: f64) -> f64 {
        self.at([0.5 * (1.0 + cosine), 0.5 * (1.0 - cosine)])
    }

    /// Its value, 1/sr, by the squared cosine and sine of half the angle: they tell angles within a peak from each other
    /// whose cosines are rounded to 1.
    #[must_use]
    pub fn at(&self, halves: [f64; 2]) -> f64 {
        let cosine = halves[0] - halves[1];
        match *self {
            Self::Isotropic => 0.25 / PI,
            Self::Polynomial([a, b, c, d]) => a + cosine * (b + cosine * (c + cosine * d)),
            Self::HenyeyGreenstein { g } => {
                let squared = (1.0 - g).powi(2) * halves[0] + (1.0 + g).powi(2) * halves[1];
                0.25 / PI * (1.0 - g * g) / squared.powf(1.5)
            }
            Self::Draine { g, alpha } => {
                let shape = (1.0 + alpha * cosine * cosine) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
                shape * Self::HenyeyGreenstein { g }.at(halves)
            }
        }
    }

    /// A value that it exceeds nowhere.
    pub(crate) fn most(&self) -> f64 {
        match *self {
            Self::Polynomial(weights) => weights.iter().map(|weight| weight.abs()).sum(),
            _ => self.value(1.0).max(self.value(-1.0)),
        }
    }

    fn check(&self) -> Result<(), FogError> {
        let inside = "a number from -0.999 to 0.999";
        match *self {
            Self::Isotropic => Ok(()),
            Self::Polynomial(weights) => {
                let lowest =
                    (0..=1000).map(|i| self.value(f64::from(i) / 500.0 - 1.0)).fold(f64::NAN, f64::min);
                let sound = weights.iter().all(|weight| weight.is_finite()) && lowest >= -1e-9;
                check(
                    || "medium.phase".to_owned(),
                    lowest,
                    sound,
                    "weights whose polynomial is nowhere negative",
                )
            }
            Self::HenyeyGreenstein { g } => {
                check(|| "medium.phase.g".to_owned(), g, g.abs() <= MAX_G, inside)
            }
            Self::Draine { g, alpha } => {
                check(|| "medium.phase.g".to_owned(), g, g.abs() <= MAX_G, inside)?;
                let sound = alpha >= 0.0 && alpha.is_finite();
                check(|| "medium.phase.alpha".to_owned(), alpha, sound, "a number from 0 on")
            }
        }
    }
}

/// How a medium thins with height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thinning {
    /// Where the medium is as dense as it says, metres along the world's up from its zero.
    pub level: f64,
    /// Metres up in which it thins by a factor of e.
    pub scale_height: f64,
}

/// A medium that fills the world, homogeneous or thinning with height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Extinction coefficient of red, green and blue, 1/m, from 0 on. All 0: the pass is left out.
    pub extinction: [f64; 3],
    /// Scattering albedo: what of the extinction is scattering, 0 to 1 each.
    pub albedo: [f64; 3],
    /// Phase function.
    pub phase: Phase,
    /// With [`Settings::height`](crate::Settings::height): how it thins with height.
    pub thinning: Option<Thinning>,
}

impl Medium {
    /// A grey medium that absorbs nothing, in which [`VISIBILITY_CONTRAST`] is left after `metres`.
    #[must_use]
    pub fn with_visibility(metres: f64) -> Self {
        let extinction = [-VISIBILITY_CONTRAST.ln() / metres; 3];
        Self { extinction, albedo: [1.0; 3], phase: Phase::Isotropic, thinning: None }
    }

    /// Scattering coefficient, 1/m.
    #[must_use]
    pub fn scattering(&self) -> [f64; 3] {
        [0, 1, 2].map(|channel| self.extinction[channel] * self.albedo[channel])
    }

    /// Whether there is nothing of it.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.extinction == [0.0; 3]
    }

    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`FogError::Range`] with the field.
    pub fn check(&self) -> Result<(), FogError> {
        for (channel, name) in ["red", "green", "blue"].into_iter().enumerate() {
            let (extinction, albedo) = (self.extinction[channel], self.albedo[channel]);
            let sound = (0.0..=1e6).contains(&extinction);
            check(|| format!("medium.extinction, {name},"), extinction, sound, "0 to 1e6 1/m")?;
            let sound = (0.0..=1.0).contains(&albedo);
            check(|| format!("medium.albedo, {name},"), albedo, sound, "0 to 1")?;
        }
        self.phase.check()?;
        let Some(Thinning { level, scale_height }) = self.thinning else { return Ok(()) };
        check(|| "medium.thinning.level".to_owned(), level, level.is_finite(), "a finite height")?;
        let sound = scale_height > 0.0 && scale_height.is_finite();
        check(|| "medium.thinning.scale_height".to_owned(), scale_height, sound, "a finite length above 0")
    }
}
