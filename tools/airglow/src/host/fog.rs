//! The scene's medium as the fog pass takes it.

use airglow::fog::{self, Fog, InputHealth, Lobe, LobeTables};
use airglow::math::World;
use airglow_gpu::Requirements;
use airglow_gpu::ash::vk;
use airglow_graph::LeftOut;
use airglow_scene::{Camera, Light, LightKind, Material, MaterialClass, Projection, Scene};
use glam::{DQuat, Vec3};
use half::f16;

use super::device::Device;
use super::fog_sky::FoggedSky;
use super::scene::DeviceScene;
use super::shaders;
use crate::failure::{Failure, Outcome};

/// Radius of a lamp, metres: a glTF light has none, and a point's glow has no end.
const LAMP_RADIUS: f64 = 0.05;

/// The pass with the medium and the lights of a scene.
pub struct SceneFog {
    pub(super) pass: Fog,
    /// Tables of the lobes that the materials reflect its lights by.
    pub(super) lobes: LobeTables,
    /// The environment through the medium.
    pub(super) sky: Option<FoggedSky>,
    /// Counters of bad pixels, where they are asked for.
    pub(super) health: Option<InputHealth>,
    pub(super) medium: fog::Medium,
    lights: Vec<fog::Light>,
}

/// What the device must offer for a scene.
pub fn requirements(scene: &Scene) -> Requirements {
    match scene.medium {
        Some(_) => Fog::requirements(&settings(scene, fog::Settings::default().format))
            .and(&InputHealth::requirements()),
        None => Requirements::engine(),
    }
}

/// The settings of the pass for a scene.
pub fn settings(scene: &Scene, format: vk::Format) -> fog::Settings {
    let asked = scene.presets.of("fog").map_or_else(fog::Settings::default, fog::Settings::from);
    fog::Settings { format, environment: scene.environment.is_some(), ..asked }
}

impl SceneFog {
    /// Makes the pass where the scene has a medium; the picture is of format `hdr`. The environment of the scene as it is
    /// `uploaded` is convolved.
    pub fn new(
        device: &Device<'_>,
        scene: &Scene,
        uploaded: Option<&DeviceScene>,
        hdr: vk::Format,
    ) -> Outcome<Option<Self>> {
        Self::with_settings(device, scene, uploaded, settings(scene, hdr))
    }

    /// The same with other settings than the scene asks for.
    pub fn with_settings(
        device: &Device<'_>,
        scene: &Scene,
        uploaded: Option<&DeviceScene>,
        settings: fog::Settings,
    ) -> Outcome<Option<Self>> {
        let Some(medium) = scene.medium else { return Ok(None) };
        let context = device.context();
        let medium = fog::Medium {
            extinction: medium.extinction.map(f64::from),
            albedo: medium.albedo.map(f64::from),
            phase: fog::Phase::HenyeyGreenstein { g: f64::from(medium.anisotropy) },
            thinning: None,
        };
        let lights = lights(scene);
        let reflecting = scene.materials.iter().filter(|_| !lights.is_empty());
        let lobes: Vec<Lobe> = reflecting.flat_map(lobes).flatten().collect();
        let lobes = LobeTables::new(context, settings.preset, &lobes).map_err(Failure::work)?;
        let pass = Fog::new(context, settings).map_err(Failure::work)?;
        let sky =
            uploaded.map(|uploaded| FoggedSky::new(device, scene, uploaded, &medium)).transpose()?.flatten();
        Ok(Some(Self { pass, lobes, sky, health: None, medium, lights }))
    }

    /// Puts the lights where they are in a scene that has moved them.
    #[cfg(feature = "view")]
    pub fn place_lights(&mut self, scene: &Scene) {
        self.lights = lights(scene);
    }

    /// The fragment stage of the forward draw, where surfaces reflect light out of the medium.
    pub fn fragment(&self) -> Option<Vec<u32>> {
        self.lobes.buffer().map(|_| shaders::scene_fragment_in_fog())
    }

    /// Tells each draw which tables its material reflects by.
    pub fn name_tables(&self, scene: &Scene, device_scene: &mut DeviceScene) {
        for (draw, instance) in device_scene.draws.iter_mut().zip(&scene.instances) {
            let table = |lobe: Option<Lobe>| Some(self.lobes.find(lobe?)?.0);
            draw.material
                .set_tables(lobes(&scene.materials[instance.material]).map(|lobe| table(lobe).unwrap_or(0)));
        }
    }

    /// The view of a camera in a picture of that aspect; `rotation` is world from environment map.
    pub fn view(&self, camera: &Camera, aspect: f32, rotation: DQuat) -> Outcome<fog::View> {
        let axis = |column: glam::Vec4| column.truncate().as_dvec3();
        let aspect = f64::from(aspect);
        let mut world = World::default();
        let [x, y] = match camera.projection {
            Projection::Perspective { vertical_angle, near, far, .. } => {
                (world.depth.near, world.depth.far) = (f64::from(near), far.map(f64::from));
                let tangent = (0.5 * f64::from(vertical_angle)).tan();
                [aspect * tangent, tangent]
            }
            Projection::Orthographic { half_height, near, far, .. } => {
                // A near plane of 0 means no less to an orthographic view, but to no other.
                (world.depth.near, world.depth.far) = (f64::from(near.max(1e-6)), Some(f64::from(far)));
                world.depth.orthographic = true;
                [aspect * f64::from(half_height), f64::from(half_height)]
            }
        };
        world.depth.reversed = false;
        let transform = camera.transform;
        let camera = fog::Camera {
            position: camera.position().as_dvec3(),
            right: axis(transform.x_axis),
            up: axis(transform.y_axis),
            forward: -axis(transform.z_axis),
            edges: [-x, x, -y, y],
        };
        let environment = self.sky.as_ref().map(|sky| sky.environment(rotation)).transpose()?;
        Ok(fog::View { world, camera, medium: self.medium, lights: self.lights.clone(), environment })
    }
}

/// The diffuse and the specular lobe of a material, as `host/lights.glsl` has them; an unlit one has none.
fn lobes(material: &Material) -> [Option<Lobe>; 2] {
    let lit = material.class != MaterialClass::Unlit;
    let roughness = f64::from(f16::from_f32(material.roughness));
    let alpha = (roughness * roughness).clamp(0.002, 1.0);
    [lit.then_some(Lobe::Lambert), lit.then_some(Lobe::Ggx(alpha))]
}

/// The lights inside the medium.
fn lights(scene: &Scene) -> Vec<fog::Light> {
    scene.lights.iter().filter_map(light).take(fog::MAX_LIGHTS).collect()
}

/// A light inside the medium; a directional one is none.
fn light(light: &Light) -> Option<fog::Light> {
    let wide = |vector: [f32; 3]| Vec3::from(vector).as_dvec3();
    let (position, intensity, range, cone) = match light.kind {
        LightKind::Point { position, intensity, range } => (position, intensity, range, None),
        LightKind::Spot { position, direction, intensity, range, inner, outer } => {
            let [inner, outer] = [inner, outer].map(f64::from);
            (position, intensity, range, Some(fog::Cone { direction: wide(direction), inner, outer }))
        }
        LightKind::Directional { .. } => return None,
    };
    let range = range.map(f64::from);
    let point = fog::Light::point(wide(position), intensity.map(f64::from));
    Some(fog::Light { radius: LAMP_RADIUS, cone, range, ..point })
}

/// The record of the pass being left out because there is nothing to see through.
pub fn no_medium() -> LeftOut {
    left_out("the scene has no medium", "a [medium] in the scene file")
}

/// The record of the pass being left out by the host.
pub fn left_out(why: &str, would_return: &str) -> LeftOut {
    let (what, why, would_return) = ("fog".to_owned(), why.to_owned(), would_return.to_owned());
    LeftOut { what, why, bytes: 0, time: None, would_return }
}
