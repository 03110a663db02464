//! The scene's environment seen through its medium: by bands for what it lights, as a map for what is seen of it, and by
//! three bands for what the medium scatters before the surfaces.

use airglow::fog::{self, Background, Distant, ENVIRONMENT_ORDER, Seen};
use airglow::math::sh::rotation::Rotation;
use airglow::math::sphere::equirect::Projector;
use airglow_gpu::ash::vk;
use airglow_gpu::{ImageView, Label};
use airglow_graph::{Access, ImageDesc, State};
use airglow_scene::{Environment, Scene};
use glam::DQuat;

use super::device::Device;
use super::scene::DeviceScene;
use super::sky::Glow;
use super::upload;
use crate::failure::{Failure, Outcome};

/// Texels in a row of the map of the glow: as fine as its peaks need beside what arrives straight, which keeps the map's
/// own resolution.
const GLOW_WIDTH: u32 = 128;

/// An environment in fog.
pub struct FoggedSky {
    /// Factors on the bands of its light.
    pub factors: Vec<[f64; 3]>,
    /// The background.
    pub glow: Glow,
    distance: f64,
    /// Coefficients of its radiance, in the map.
    radiance: Vec<[f64; 3]>,
}

impl FoggedSky {
    /// Convolves the environment of a scene, where it has one, on the device that holds its map.
    pub fn new(
        device: &Device<'_>,
        scene: &Scene,
        uploaded: &DeviceScene,
        medium: &fog::Medium,
    ) -> Outcome<Option<Self>> {
        let (Some(environment), Some(sky)) = (&scene.environment, &uploaded.environment) else {
            return Ok(None);
        };
        let distance = distance(environment);
        let distant = Distant::new(medium, distance).map_err(Failure::input)?;
        let factors = distant.band_factors(scene.quality.order as usize).map_err(Failure::work)?;
        let projector = Projector::new(ENVIRONMENT_ORDER, environment.width, environment.height);
        let radiance =
            projector.and_then(|projector| projector.project(&environment.pixels)).map_err(Failure::work)?;
        let [red, green, blue] = distant.optical_distance.map(|optical| (-optical).exp() as f32);
        let glow = Glow { map: convolve(device, &sky.map, &distant)?, left: [red, green, blue, 0.0] };
        Ok(Some(Self { factors, glow, distance, radiance }))
    }

    /// As the pass takes it, with world from map.
    pub fn environment(&self, rotation: DQuat) -> Outcome<fog::Environment> {
        let rotation = Rotation::from_quaternion(ENVIRONMENT_ORDER, rotation).map_err(Failure::work)?;
        let turned = rotation.apply_rgb(&self.radiance).map_err(Failure::work)?;
        let mut radiance = [[0.0; 3]; ENVIRONMENT_ORDER * ENVIRONMENT_ORDER];
        radiance.iter_mut().zip(turned).for_each(|(to, from)| *to = from);
        Ok(fog::Environment { distance: self.distance, radiance })
    }
}

/// How far the light of an environment comes through a medium, metres: without a stated distance none arrives.
fn distance(environment: &Environment) -> f64 {
    environment.distance.map_or(1e30, f64::from)
}

/// The map of the glow.
fn convolve(device: &Device<'_>, map: &ImageView, distant: &Distant) -> Outcome<ImageView> {
    let context = device.context();
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let background = Background::new(context, map.extent(), format).map_err(Failure::work)?;
    let width = GLOW_WIDTH.min(map.extent()[0]);
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::COLOR_ATTACHMENT;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(width, width.div_ceil(2), format) };
    let glow = context.create_image(Label::new(upload::OWNER, "glow of the environment"), &desc);
    let glow = glow.map_err(Failure::work)?;
    let target = glow.full_view().map_err(Failure::work)?;
    let mut outcome = Ok(());
    device
        .run(|recorder| {
            recorder.memory_barrier(Access::FragmentSampled, Access::ComputeSampled)?;
            recorder.transition(&glow, State::UNDEFINED, Access::ColorAttachmentWrite)?;
            outcome = background.record(recorder, map, &target, distant, Seen::Glow);
            recorder.transition(&glow, Access::ColorAttachmentWrite, Access::FragmentSampled)
        })
        .map_err(Failure::work)?;
    outcome.map_err(Failure::work)?;
    Ok(target)
}
