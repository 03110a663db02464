//! The curve of each room's presets on a scene.

use std::path::Path;

use airglow::relight::{Relight, Settings};
use airglow_scene::Scene;

use crate::failure::Outcome;
use crate::global::Global;
use crate::host::device;
use crate::host::machine::Machine;
use crate::output::Output;
use crate::report::model::Curve;
use crate::report::relight::curves::Measurement;
use crate::report::relight::effort::Effort;
use crate::report::relight::workload::Workload;

/// What measuring takes, beside a scene.
#[derive(Clone, Copy)]
pub struct Bench<'a> {
    /// Fewer rays and rounds.
    pub quick: bool,
    /// Folder of bakes.
    pub cache: &'a Path,
    /// The device.
    pub global: &'a Global,
    /// Where progress goes.
    pub output: &'a Output,
}

/// A curve, and where it was measured.
pub type Measured = (Machine, Curve);

impl Bench<'_> {
    /// Presets of relighting: the largest mesh of the scene under its environment.
    pub fn relight(&self, scene: &Scene) -> Outcome<Measured> {
        let effort = Effort { rays: Vec::new(), ..Effort::new(self.quick) };
        let workload = Workload::new(scene, &effort, self.output)?;
        let requirements = Relight::requirements(&Settings { order: 6, ..Settings::default() });
        device::with(self.global, &requirements, |device| {
            let measurement =
                Measurement { device, workload: &workload, effort: &effort, output: self.output };
            let mut curve = measurement.presets()?;
            curve.timed = format!("{}. Lit: {}", curve.timed, workload.description);
            Ok((device.machine(), curve))
        })
    }

    /// Presets of fog: the scene's lamps and medium over a floor.
    #[cfg(feature = "fog")]
    pub fn fog(&self, scene: &Scene) -> Outcome<Measured> {
        use crate::report::fog::{Effort, Measurement};
        let requirements = airglow::fog::Fog::requirements(&airglow::fog::Settings::default());
        device::with(self.global, &requirements, |device| {
            let effort = Effort::new(self.quick);
            let measurement = Measurement { device, effort, output: self.output };
            Ok((device.machine(), measurement.presets(scene)?))
        })
    }

    /// Presets of near emitters: every vertex of the scene.
    #[cfg(feature = "radiance")]
    pub fn radiance(&self, scene: &Scene) -> Outcome<Measured> {
        use crate::report::radiance::{Effort, Measurement, Workload};
        device::with(self.global, &crate::host::near::measured_requirements(), |device| {
            let workload = Workload::new(device, scene, self.cache, self.output)?;
            let effort = Effort::new(self.quick);
            let measurement = Measurement { device, workload: &workload, effort, output: self.output };
            Ok((device.machine(), measurement.presets()?))
        })
    }

    /// Presets of normal maps: the last map of the scene.
    #[cfg(feature = "normals")]
    pub fn normals(&self, scene: &Scene) -> Outcome<Option<Measured>> {
        use crate::report::normals::{Effort, Map, Measurement, requirements};
        let maps = Map::of_scenes(std::slice::from_ref(scene))?;
        let Some(map) = maps.last() else { return Ok(None) };
        let of_map = device::with(self.global, &requirements(), |device| {
            let effort = Effort::new(self.quick);
            let measurement = Measurement { device, effort, output: self.output };
            Ok((device.machine(), measurement.presets(map)?))
        });
        of_map.map(Some)
    }

    /// Presets of shadows: white ground under what moves in the scene.
    #[cfg(feature = "shadow")]
    pub fn shadow(&self, scene: &Scene) -> Outcome<Measured> {
        use crate::report::shadow::{Effort, Measurement};
        device::with(self.global, &airglow::shadow::Shadow::requirements(), |device| {
            let effort = Effort::new(self.quick);
            let measurement = Measurement { device, effort, output: self.output };
            Ok((device.machine(), measurement.presets(scene)?))
        })
    }
}
