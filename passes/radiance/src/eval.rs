//! The room's own GPU code on rows of parameters, beside the truth: samples of triangles at a point.

use glam::DVec3;

use crate::gpu::bench::Bench;
use crate::gpu::kernels::MOST_ANALYTIC;
use crate::gpu::{LightShape, TexelSettings, Texels};
use crate::reference::{Cube, triangles};
use crate::{Incident, PassSettings, RadianceError, Triangle, check};

/// How a row is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// By a cube map: triangles hide one another.
    Cube,
    /// In closed form: triangles that overlap are refused.
    Analytic,
}

/// A row of `radiance-cube`.
#[derive(Clone, Debug)]
pub struct CubeRow {
    /// Bands, 1 to 6.
    pub order: usize,
    /// Texels along a side of a face, 1 to 512.
    pub face: usize,
    /// Rays along a side of a texel: 1, 2 or 4.
    pub rays: u32,
    /// Where the sample is taken, metres.
    pub point: DVec3,
    /// The emitters.
    pub triangles: Vec<Triangle>,
    /// How.
    pub method: Method,
}

/// What a row gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// The device's sample.
    pub value: Incident,
    /// The same in f64: a cube map of the same rays, or the closed form.
    pub reference: Incident,
}

/// Rays along a side of a texel, unless a row says otherwise: those of the pass.
#[must_use]
pub fn default_rays() -> u32 {
    PassSettings::default().rays
}

/// Runs the rows; a refused one says why, the others still run.
///
/// # Errors
/// [`RadianceError::Gpu`] when the device fails.
pub fn cubes(
    bench: &Bench<'_>,
    rows: &[CubeRow],
) -> Result<Vec<Result<Evaluated, RadianceError>>, RadianceError> {
    let mut kernels: Vec<(TexelSettings, Texels)> = Vec::new();
    let mut results = Vec::with_capacity(rows.len());
    for row in rows {
        let reference = row.reference();
        let settings = row.settings();
        if reference.is_ok() && !kernels.iter().any(|(made, _)| *made == settings) {
            match Texels::new(bench.context, settings) {
                Ok(texels) => kernels.push((settings, texels.with_closed_forms(bench.context)?)),
                Err(RadianceError::Gpu(error)) => return Err(error.into()),
                Err(refused) => {
                    results.push(Err(refused));
                    continue;
                }
            }
        }
        let texels = kernels.iter().find(|(made, _)| *made == settings);
        results.push(match (reference, texels) {
            (Ok(reference), Some((_, texels))) => {
                row.value(bench, texels).map(|value| Evaluated { value, reference })
            }
            (Err(refused), _) => Err(refused),
            (_, None) => Err(RadianceError::setting("face size", row.face, "1 to 512 texels")),
        });
    }
    Ok(results)
}

impl CubeRow {
    fn settings(&self) -> TexelSettings {
        // The smallest kernel has three bands; fewer are the first of them.
        let shape = LightShape { order: self.order.max(3), gradients: false };
        TexelSettings { shape, size: u32::try_from(self.face).unwrap_or(u32::MAX), rays: self.rays }
    }

    /// The emitters as seen from the point, so that single precision begins at the distances between them.
    fn relative(&self) -> Vec<Triangle> {
        let moved = |triangle: &Triangle| Triangle {
            corners: triangle.corners.map(|corner| corner - self.point),
            radiance: triangle.radiance,
        };
        self.triangles.iter().map(moved).collect()
    }

    fn reference(&self) -> Result<Incident, RadianceError> {
        if !(1..=6).contains(&self.order) {
            return Err(RadianceError::setting("order", self.order, "1 to 6"));
        }
        check(&self.triangles)?;
        if !self.point.is_finite() {
            let value = self.point.to_string();
            return Err(RadianceError::Value { what: "point", index: 0, value });
        }
        match self.method {
            Method::Cube => Cube::new(self.order, self.face)?
                .with_rays(self.rays as usize)?
                .sample(self.point, &self.triangles),
            Method::Analytic => triangles(self.order, self.point, &self.triangles),
        }
    }

    fn value(&self, bench: &Bench<'_>, texels: &Texels) -> Result<Incident, RadianceError> {
        let all = self.relative();
        let mut light = Incident::dark(self.settings().shape.order)?;
        match self.method {
            Method::Cube => {
                let cube = texels.clone().without_closed_forms();
                bench.texels(&cube, &all, &[DVec3::ZERO])?.iter().try_for_each(|part| light.add(part))?;
            }
            // None overlaps another, the truth has found: parts add.
            Method::Analytic => {
                for part in all.chunks(MOST_ANALYTIC as usize) {
                    let sampled = bench.sampled(texels, part, &[DVec3::ZERO])?;
                    sampled.iter().try_for_each(|sample| match sample.exact {
                        true => light.add(&sample.light),
                        false => Err(RadianceError::Touching),
                    })?;
                }
            }
        }
        light.coefficients.truncate(self.order * self.order);
        Ok(light)
    }
}
