//! Light of the scene's near emitters at each vertex, by the radiance pass.

use airglow::math::sh::rotation::Rotation;
use airglow::math::sphere::equirect::Projector;
use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::gpu::{Atlas, LightShape, RefineState};
use airglow::radiance::{Control, Lights, Lit, PassSettings, Radiance, Receiver, Settings, Sphere, Triangle};
use airglow_gpu::{Context, Imports, Record, Requirements};
use airglow_graph::{Graph, LeftOut};
use airglow_scene::{Emitter, Environment, Scene};
use glam::DQuat;

use super::device::Device;
use super::emitters;
use super::needed::{self, NEAR_ORDERS};
use super::placed::Placed;
use super::transfer::SceneTransfer;
use crate::failure::{Failure, Outcome};

/// Error of a vertex colour that samples aim at where no preset is asked for, W/sr/m2 before exposure.
pub const BOUND: f64 = 2e-3;

/// The pass with a scene's vertices and emitters.
pub struct NearLight {
    radiance: Radiance,
    receiver: Receiver,
    emitters: Vec<Emitter>,
    triangles: Vec<Triangle>,
    spheres: Vec<Sphere>,
    /// The environment about the world's axes where it is not turned.
    distant: Vec<[f64; 3]>,
    settings: PassSettings,
}

/// What the samples of a frame left on the device.
pub struct Sampled {
    /// How far they were refined.
    pub state: Option<RefineState>,
    /// Light and closed forms of each, as its shape says.
    pub lights: Vec<[f32; 4]>,
    /// How these lie.
    pub shape: LightShape,
    /// The error that was aimed at, W/sr/m2.
    pub bound: f64,
}

/// How the environment reaches the vertices of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Arrival<'a> {
    /// Turns it about the world's axes.
    pub turn: DQuat,
    /// What a medium before it does to its bands; `None` in clear air.
    pub filter: Option<&'a [[f64; 3]]>,
    /// By how much that medium dims what emitters send, 1/m; zero in clear air.
    pub extinction: [f32; 3],
}

/// The record of the pass being left out of a scene; what it does not know, black receivers, it says itself.
pub fn left_out(scene: &Scene, without_relight: bool) -> Option<LeftOut> {
    let (why, would_return) = match (needed::glows(scene), NEAR_ORDERS.contains(&scene.quality.order)) {
        (false, _) => ("the scene has no emitter that gives light", "an [[emitter]] in the scene file"),
        (true, false) => ("it has no kernels of so many bands", "3 to 6 bands"),
        (true, true) if without_relight => ("relight, which takes its light, is left out", "relight"),
        (true, true) => return None,
    };
    Some(LeftOut {
        what: "radiance".to_owned(),
        why: why.to_owned(),
        bytes: bytes(scene),
        time: None,
        would_return: would_return.to_owned(),
    })
}

/// Bytes of the light of all vertices of a scene.
pub fn bytes(scene: &Scene) -> u64 {
    let vertices: usize =
        scene.instances.iter().map(|instance| scene.meshes[instance.mesh].positions.len()).sum();
    vertices as u64 * settings(scene).light_bytes()
}

/// What the device must offer for a scene.
pub fn requirements(scene: &Scene) -> Requirements {
    match needed::near_light(scene) {
        true => Radiance::requirements(&settings(scene)),
        false => Requirements::engine(),
    }
}

/// What the device must offer to measure the pass at any of its orders.
pub fn measured_requirements() -> Requirements {
    let settings = PassSettings { order: *NEAR_ORDERS.end() as usize, ..PassSettings::default() };
    Radiance::requirements(&settings).and(&Atlas::requirements())
}

/// The settings of the pass for a scene.
pub fn settings(scene: &Scene) -> PassSettings {
    let unasked = || {
        let refinement = Settings { bound: BOUND, ..Settings::default() };
        PassSettings { refinement, ..PassSettings::default() }
    };
    let asked = scene.presets.of("radiance").map_or_else(unasked, PassSettings::from);
    PassSettings { order: scene.quality.order as usize, ..asked }
}

impl NearLight {
    /// The pass for a scene, where it has something to do.
    pub fn new(context: &Context, scene: &Scene, transfer: &SceneTransfer) -> Outcome<Option<Self>> {
        if !needed::near_light(scene) {
            return Ok(None);
        }
        Self::with_settings(context, scene, transfer, settings(scene)).map(Some)
    }

    /// The same with other settings than the scene asks for, where it has something to do.
    pub fn with_settings(
        context: &Context,
        scene: &Scene,
        transfer: &SceneTransfer,
        settings: PassSettings,
    ) -> Outcome<Self> {
        let placed = Placed::new(scene, transfer);
        let tree = match &transfer.tree {
            Some(tree) if tree.vertices().len() == placed.positions.len() => tree.clone(),
            _ => placed.tree()?,
        };
        let receiver = Receiver::new(context, settings, &tree, &placed.positions, &placed.parts)
            .map_err(Failure::work)?;
        let distant = match &scene.environment {
            Some(environment) => distant(environment, settings.order)?,
            None => Vec::new(),
        };
        let (triangles, spheres) = emitters::shapes(&scene.emitters, 0.0);
        Ok(Self {
            radiance: Radiance::new(context, settings).map_err(Failure::work)?,
            receiver,
            emitters: scene.emitters.clone(),
            triangles,
            spheres,
            distant,
            settings,
        })
    }

    /// Puts the emitters where they start in a scene that has moved them.
    #[cfg(feature = "view")]
    pub fn place_emitters(&mut self, emitters: &[Emitter]) {
        self.emitters = emitters.to_vec();
        self.move_emitters(0.0);
    }

    /// Where the samples of the last frame are, once it is done: metres, in the world.
    #[cfg(feature = "view")]
    pub fn sample_points(&self, device: &Device<'_>) -> Outcome<Vec<glam::Vec3>> {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        let samples = self.receiver.samples();
        let states: Vec<RefineState> = bench.read(&samples.state).map_err(Failure::work)?;
        let points: Vec<[f32; 4]> = bench.read(&samples.points).map_err(Failure::work)?;
        let taken = states.first().map_or(0, |state| state.taken as usize);
        Ok(points.iter().take(taken).map(|[x, y, z, _]| glam::Vec3::new(*x, *y, *z)).collect())
    }

    /// Moves the emitters to `part` of their ways; frames declared before keep them where they were.
    pub fn move_emitters(&mut self, part: f32) {
        (self.triangles, self.spheres) = emitters::shapes(&self.emitters, part);
    }

    /// Its samples and vertices.
    pub fn receiver(&self) -> &Receiver {
        &self.receiver
    }

    /// Adds the pass.
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        arrival: Arrival<'_>,
    ) -> Outcome<Lit> {
        let distant = self.arriving(arrival)?;
        let lights = self.lights(&distant, arrival);
        self.radiance.add(graph, imports, &self.receiver, &lights).map_err(Failure::work)
    }

    /// Turns the distant light of a declared frame.
    pub fn turn(&self, control: &Control, arrival: Arrival<'_>) -> Outcome {
        let distant = self.arriving(arrival)?;
        control.set(&self.lights(&distant, arrival)).map_err(Failure::work)
    }

    fn lights<'a>(&'a self, distant: &'a [[f32; 3]], arrival: Arrival<'_>) -> Lights<'a> {
        let (emitters, spheres) = (&self.triangles, &self.spheres);
        Lights { emitters, spheres, distant, extinction: arrival.extinction, ..Lights::NONE }
    }

    /// What the samples of the last frame left on the device, once it is done.
    pub fn sampled(&self, device: &Device<'_>) -> Outcome<Sampled> {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        let samples = self.receiver.samples();
        let states: Vec<RefineState> = bench.read(&samples.state).map_err(Failure::work)?;
        Ok(Sampled {
            state: states.first().copied(),
            lights: bench.read(&samples.lights).map_err(Failure::work)?,
            shape: self.receiver.shape(),
            bound: self.settings.refinement.bound,
        })
    }

    /// The emitters where they start.
    pub fn emitters(&self) -> &[Emitter] {
        &self.emitters
    }

    fn arriving(&self, Arrival { turn, filter, .. }: Arrival<'_>) -> Outcome<Vec<[f32; 3]>> {
        if self.distant.is_empty() {
            return Ok(Vec::new());
        }
        let rotation = Rotation::from_quaternion(self.settings.order, turn).map_err(Failure::work)?;
        let turned = rotation.apply_rgb(&self.distant).map_err(Failure::work)?;
        Ok(filtered(&turned, filter))
    }
}

/// Coefficients with each band multiplied by its factor.
fn filtered(light: &[[f64; 3]], filter: Option<&[[f64; 3]]>) -> Vec<[f32; 3]> {
    let factor = |i: usize| filter.and_then(|factors| factors.get(i.isqrt())).copied().unwrap_or([1.0; 3]);
    let scaled = |(i, l): (usize, &[f64; 3])| {
        let factor = factor(i);
        [0, 1, 2].map(|c| (factor[c] * l[c]) as f32)
    };
    light.iter().enumerate().map(scaled).collect()
}

/// The environment's coefficients about the world's axes.
fn distant(environment: &Environment, order: usize) -> Outcome<Vec<[f64; 3]>> {
    let projector = Projector::new(order, environment.width, environment.height).map_err(Failure::input)?;
    let light = projector.project(&environment.pixels).map_err(Failure::input)?;
    let rotation = Rotation::from_quaternion(order, environment.rotation.as_dquat());
    rotation.and_then(|rotation| rotation.apply_rgb(&light)).map_err(Failure::input)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_scales_bands() {
        let light = vec![[1.0; 3]; 9];
        let factors = [[1.0, 0.5, 0.0], [0.25; 3], [0.125; 3]];
        let found = filtered(&light, Some(&factors));
        assert_eq!((found[0], found[3], found[4]), ([1.0, 0.5, 0.0], [0.25; 3], [0.125; 3]));
        assert_eq!(filtered(&light, None), vec![[1.0_f32; 3]; 9]);
    }
}
