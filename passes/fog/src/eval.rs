//! The pass's own GPU code on rows of parameters, many rows a dispatch, beside the f64 reference.

pub mod complete;
pub mod surface;

use std::f64::consts::PI;

use glam::DVec3;

use crate::bench::{Bench, Ray, settings};
use crate::error::check;
use crate::medium::PhaseKind;
use crate::reference::airlight::{Sight, airlight as quadrature};
use crate::{FogError, Light, Medium, Phase, Preset};

/// A row of `fog-airlight`: a light of 1 W/sr in a medium that absorbs nothing.
#[derive(Clone, Copy, Debug)]
pub struct AirlightRow {
    /// Extinction and scattering, 1/m.
    pub extinction: f64,
    /// Distance of the light from the eye, metres.
    pub light_distance: f64,
    /// Angle at the eye between the ray and the light, radians.
    pub gamma: f64,
    /// Distance of the surface from the eye, metres, or infinite.
    pub distance: f64,
    /// Radius of the light, metres.
    pub radius: f64,
    /// Phase function.
    pub phase: Phase,
    /// How exactly.
    pub preset: Preset,
}

/// What a row gave, W/sr/m2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluated {
    /// The GPU's value, exactly.
    pub value: f64,
    /// The reference's, by adaptive quadrature.
    pub reference: f64,
}

impl AirlightRow {
    /// Refuses what is out of range, and rays through a point light, whose airlight has no limit.
    ///
    /// # Errors
    /// [`FogError::Range`] with the column.
    pub fn check(&self) -> Result<(), FogError> {
        let number = |name: &str, value: f64, sound, range| check(|| name.to_owned(), value, sound, range);
        let extinction = self.extinction;
        number("beta", extinction, (0.0..=1e6).contains(&extinction), "0 to 1e6 1/m")?;
        let length = |value: f64| (0.0..=1e15).contains(&value);
        number("d_sv", self.light_distance, length(self.light_distance), "a length from 0 to 1e15")?;
        let surface = length(self.distance) || self.distance == f64::INFINITY;
        number("d_vp", self.distance, surface, "a length from 0 to 1e15, or inf")?;
        number("gamma", self.gamma, (0.0..=PI).contains(&self.gamma), "an angle from 0 to pi")?;
        let diverges = self.radius == 0.0
            && (self.light_distance == 0.0 || (self.gamma == 0.0 && self.distance >= self.light_distance));
        number(
            "light_radius",
            self.radius,
            !diverges,
            "a radius above 0: the ray meets the light, its airlight diverges",
        )?;
        self.ray().medium.check()?;
        self.ray().light.check(0)
    }

    /// As a ray along +Z.
    #[must_use]
    pub fn ray(&self) -> Ray {
        let (sine, cosine) = self.gamma.sin_cos();
        let light = Light::point(self.light_distance * DVec3::new(sine.max(0.0), 0.0, cosine), [1.0; 3]);
        let medium =
            Medium { extinction: [self.extinction; 3], albedo: [1.0; 3], phase: self.phase, thinning: None };
        let light = Light { radius: self.radius, ..light };
        Ray { eye: DVec3::ZERO, medium, light, direction: DVec3::Z, distance: self.distance }
    }

    /// The reference.
    ///
    /// # Errors
    /// [`FogError::Math`] where the quadrature does not converge.
    pub fn reference(&self) -> Result<f64, FogError> {
        if self.extinction == 0.0 {
            return Ok(0.0);
        }
        let sight = Sight::new(self.light_distance, self.gamma).with_radius(self.radius);
        Ok(self.extinction * quadrature(self.extinction, sight, 0.0, self.distance, self.phase)?)
    }
}

/// Runs the rows; a refused one says why, the others still run.
///
/// # Errors
/// [`FogError::Gpu`] when the device refuses.
pub fn airlight(
    bench: &Bench<'_>,
    rows: &[AirlightRow],
) -> Result<Vec<Result<Evaluated, FogError>>, FogError> {
    let references: Vec<Result<f64, FogError>> =
        rows.iter().map(|row| row.check().and_then(|()| row.reference())).collect();
    let mut values = vec![f64::NAN; rows.len()];
    for preset in [Preset::Default, Preset::Reference] {
        for kind in
            [PhaseKind::Isotropic, PhaseKind::Polynomial, PhaseKind::HenyeyGreenstein, PhaseKind::Draine]
        {
            let ours = |row: &AirlightRow| row.preset == preset && row.phase.kind() == kind;
            let places: Vec<usize> =
                (0..rows.len()).filter(|&place| references[place].is_ok() && ours(&rows[place])).collect();
            let Some(&first) = places.first() else { continue };
            let settings = settings(&rows[first].ray().medium, preset);
            let rays: Vec<Ray> = places.iter().map(|&place| rows[place].ray()).collect();
            let airlight = bench.airlight(&settings, &rays)?;
            for (&place, [red, ..]) in places.iter().zip(airlight) {
                values[place] = f64::from(red);
            }
        }
    }
    let join =
        |(reference, value): (Result<f64, FogError>, f64)| Ok(Evaluated { value, reference: reference? });
    Ok(references.into_iter().zip(values).map(join).collect())
}
