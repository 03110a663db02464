//! The knobs: range, default and its reason.

use crate::ShadowError;
use crate::exponential::Exponential;
use crate::kernels::{Kind, Program};
use crate::logarithm::CLIP;
use crate::order::check_order;

/// What the pass is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Bands, 3 to 6. Default 4, the order of the relighting it goes into.
    pub order: usize,
    /// The way to the exponential: the default, the series of degree 2 with squarings, OL or HYB.
    pub exponential: Exponential,
    /// Smallest eigenvalue over the largest before the logarithm; above 0, at most 0.5. Default 0.02, the thesis's.
    pub clip: f64,
    /// Spheres that hide less of a whole cluster's sky than this share of a half space are left out; 0 to 1. Default 1e-5:
    /// a hundred of them dim the sky by a thousandth.
    pub reach: f64,
    /// Nodes of a hierarchy of spheres that hide less of a whole cluster's sky than this share of a half space stand for
    /// what they hold; 0 to 1. Default 0.03, a cap of 14 degrees; 0: spheres of the set itself alone.
    pub cut: f64,
    /// Deringing: band l is divided by `1 + window l^2 (l + 1)^2`; 0 to 1. Default 0: off.
    pub window: f64,
    /// Results are made ones that a visibility can have. Default on, for a thousand blockers in one place.
    pub clamp: bool,
    /// Receivers bring normals: what lies below their tangent planes is left out, and what pokes through counts with its
    /// part above. Default off: a receiver in the air.
    pub normals: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            order: 4,
            exponential: Exponential::default(),
            clip: CLIP,
            reach: 1e-5,
            cut: 0.03,
            window: 0.0,
            clamp: true,
            normals: false,
        }
    }
}

impl Settings {
    /// Refuses what is out of range, and exponentials without a kernel over receivers.
    ///
    /// # Errors
    /// [`ShadowError::Order`], [`ShadowError::Range`], [`ShadowError::Method`].
    pub fn check(&self) -> Result<(), ShadowError> {
        check_order(self.order)?;
        self.exponential.check()?;
        let unit = |what, value: f64| match (0.0..=1.0).contains(&value) {
            true => Ok(()),
            false => Err(ShadowError::Range { what, value, range: "0 to 1" }),
        };
        unit("the reach", self.reach)?;
        unit("the cut", self.cut)?;
        unit("the window", self.window)?;
        let kind = Program::of(self.exponential).kind;
        let known = match self.normals {
            false => "the default, a series by Horner's rule, optimal linear or hybrid",
            true => "the default or a series by Horner's rule of another degree than 2, with normals",
        };
        let there = match kind {
            Kind::Series => true,
            Kind::Squares => !self.normals,
            _ => false,
        };
        match there {
            true => Ok(()),
            false => Err(ShadowError::Method { method: format!("{:?}", self.exponential), known }),
        }
    }
}
