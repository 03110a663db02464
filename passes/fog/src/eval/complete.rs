//! The complete model of a surface in fog, eq. 3.29 of Sun's thesis (2008), by the functions that a host's forward shader
//! calls.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::surface::SURFACE_ROW_BINDINGS;
use crate::bench::Bench;
use crate::lobes::{Lobe, LobeTables};
use crate::reference::airlight::{Sight, airlight};
use crate::reference::surface::{Fog, Surface, complete, reflected};
use crate::{FogError, Phase, Preset, kernels};

/// A lamp of 1 W/sr, a surface that is seen, and what lies between, relative to the eye, metres.
#[derive(Clone, Copy, Debug)]
pub struct CompleteRow {
    /// The lamp.
    pub lamp: DVec3,
    /// The place on the surface.
    pub place: DVec3,
    /// Its unit normal.
    pub normal: DVec3,
    /// How it reflects.
    pub surface: Surface,
    /// Extinction of each channel, above 0, 1/m.
    pub extinction: [f64; 3],
    /// Scattering of each channel, 1/m.
    pub scattering: [f64; 3],
}

/// `Row` of `complete_rows.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct RowConstants {
    lamp: [f32; 4],
    place: [f32; 4],
    normal_exponent: [f32; 4],
    extinction: [f32; 4],
    scattering: [f32; 4],
}

impl CompleteRow {
    /// Radiance at the eye of each channel by the reference.
    ///
    /// # Errors
    /// [`FogError::Math`] where a quadrature does not converge.
    pub fn reference(&self) -> Result<[f64; 3], FogError> {
        let (path, ray) = (self.lamp - self.place, self.place.normalize());
        let towards = path.normalize();
        let mirrored = ray - 2.0 * ray.dot(self.normal) * self.normal;
        let angles = [self.normal, mirrored].map(|axis| axis.angle_between(towards));
        let sight = Sight::new(self.lamp.length(), ray.angle_between(self.lamp));
        let mut radiance = [0.0; 3];
        for (channel, radiance) in radiance.iter_mut().enumerate() {
            let (extinction, scattering) = (self.extinction[channel], self.scattering[channel]);
            let fog = Fog { extinction, scattering };
            let far = self.place.length();
            let surface = reflected(fog, path.length(), angles, self.surface)?;
            *radiance = complete(fog, far, surface, airlight(extinction, sight, 0.0, far, Phase::Isotropic)?);
        }
        Ok(radiance)
    }

    fn constants(&self, tables: &LobeTables) -> Option<RowConstants> {
        let wide = |vector: DVec3, w: f64| vector.extend(w).as_vec4().to_array();
        let (diffuse, _) = tables.find(Lobe::Lambert)?;
        let (specular, exponent) = tables.find(Lobe::Phong(self.surface.exponent))?;
        Some(RowConstants {
            lamp: wide(self.lamp, self.surface.diffuse),
            place: wide(self.place, self.surface.specular),
            normal_exponent: wide(self.normal, f64::from(exponent)),
            extinction: wide(self.extinction.into(), f64::from(diffuse)),
            scattering: wide(self.scattering.into(), f64::from(specular)),
        })
    }
}

/// Radiance at the eye of each row and channel, with the `reference` preset's taps and tables.
///
/// # Errors
/// [`FogError::Range`] for an exponent without a table, [`FogError::Gpu`] when the device refuses.
pub fn radiance(bench: &Bench<'_>, rows: &[CompleteRow]) -> Result<Vec<[f64; 3]>, FogError> {
    let mut lobes = vec![Lobe::Lambert];
    lobes.extend(rows.iter().map(|row| Lobe::Phong(row.surface.exponent)));
    let tables = LobeTables::new(bench.context, Preset::Reference, &lobes)?;
    let constants: Vec<RowConstants> = rows.iter().filter_map(|row| row.constants(&tables)).collect();
    let Some(buffer) = tables.buffer() else { return Ok(Vec::new()) };
    let pipeline = bench.pipeline("fog complete rows", &kernels::complete_rows(), &SURFACE_ROW_BINDINGS)?;
    let input = bench.upload(&constants)?;
    let values = bench.values(&pipeline, &[&input, buffer], [constants.len(), 3], Some(&tables))?;
    Ok(values.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]].map(f64::from)).collect())
}
