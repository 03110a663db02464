//! The host: its scene on the device, its passes, its target.

use std::sync::Arc;

use airglow_gpu::ash::vk;
use airglow_gpu::{Buffer, Label, Location};
use airglow_graph::{BufferDesc, LeftOut};
use airglow_scene::{Camera, Scene};
use glam::DQuat;

use super::counted::Counters;
use super::device::Device;
use super::draw::Pipelines;
use super::environment_samples::EnvironmentSamples;
use super::filter::Filter;
#[cfg(feature = "fog")]
use super::fog::SceneFog;
use super::formats::HDR;
use super::lighting::Lighting;
use super::lights::LightsConstants;
#[cfg(feature = "normals")]
use super::mapped::MappedMaterials;
use super::over::Over;
use super::scene::{self, DeviceScene};
use super::settings::Settings;
use super::skin::Skins;
use super::source::Source;
use super::view::{self, ViewConstants};
use super::{relight, unread, upload};
use crate::failure::{Failure, Outcome};

/// Everything a frame is declared from.
pub struct Renderer<'d> {
    pub(super) device: &'d Device<'d>,
    pub(super) scene: Arc<DeviceScene>,
    pub(super) camera: Camera,
    pub(super) environment: Option<EnvironmentMap>,
    pub(super) ambient: [f32; 3],
    pub(super) lighting: Lighting,
    /// What poses the figures of the scene, where it has some.
    pub(super) skins: Option<Skins>,
    /// Why no shadow of what moves is drawn.
    #[cfg(feature = "shadow")]
    pub(super) unshadowed: LeftOut,
    pub(super) pipelines: Pipelines,
    /// The scene's lights, in its medium.
    pub(super) lights: Option<LightsConstants>,
    /// The fog pass, where the scene has a medium.
    #[cfg(feature = "fog")]
    pub(super) fog: Option<SceneFog>,
    /// What the scene holds and no pass of this frame uses.
    pub(super) unread: Vec<LeftOut>,
    /// What the pass takes, or would take.
    pub(super) relight_bytes: u64,
    /// What the pass takes in a frame, where that was measured.
    pub(super) relight_seconds: Option<f64>,
    /// What passes count, where they do.
    #[cfg_attr(
        not(any(feature = "radiance", feature = "shadow", feature = "normals")),
        expect(dead_code, reason = "no pass of its own counts")
    )]
    pub(super) counters: Counters,
    pub(super) linear: Buffer,
    pub(super) display: Buffer,
    /// What a window has drawn over its picture.
    pub(super) over: Option<Over>,
}

/// What a frame needs to know of the environment beside its image.
pub struct EnvironmentMap {
    pub(super) width: u32,
    pub(super) height: u32,
    /// World from map.
    pub(super) rotation: DQuat,
}

impl<'d> Renderer<'d> {
    /// Uploads the scene and what lights it, and makes a target of `picture` pixels.
    pub fn new(device: &'d Device<'d>, scene: &Scene, source: &Source, picture: [u32; 2]) -> Outcome<Self> {
        Self::with_filter(device, scene, source, picture, Filter::default(), false)
    }

    /// The same with normal maps filtered in a stated way, and with `count` what is bad about their textures counted.
    #[cfg_attr(
        not(feature = "normals"),
        expect(unused_variables, reason = "without the room no map is drawn")
    )]
    pub fn with_filter(
        device: &'d Device<'d>,
        scene: &Scene,
        source: &Source,
        picture: [u32; 2],
        filter: Filter,
        count: bool,
    ) -> Outcome<Self> {
        let context = device.context();
        let mut device_scene =
            device.run(|recorder| scene::upload(recorder, scene)).map_err(Failure::work)?;
        let ambient = match &scene.environment {
            Some(environment) => {
                EnvironmentSamples::new(environment).map_err(Failure::input)?.mean_radiance()
            }
            None => [0.0; 3],
        };
        if !device.renders(HDR) {
            return Err(Failure::device(format!(
                "the device cannot render to {HDR:?}; choose another with --device"
            )));
        }
        let [linear, display] = targets(device, picture)?;
        #[cfg(feature = "fog")]
        let fog = SceneFog::new(device, scene, Some(&device_scene), HDR)?;
        #[cfg(feature = "fog")]
        fog.iter().for_each(|fog| fog.name_tables(scene, &mut device_scene));
        #[cfg(feature = "fog")]
        let fogged = fog.as_ref().and_then(SceneFog::fragment);
        #[cfg(not(feature = "fog"))]
        let fogged: Option<Vec<u32>> = None;
        #[cfg(feature = "normals")]
        let maps = MappedMaterials::new(device, scene, source, filter, count)?;
        #[cfg(feature = "normals")]
        maps.attach(scene, source, &mut device_scene);
        #[cfg(feature = "normals")]
        let (mapped, about_maps) = (maps.fragments(scene, fogged.is_some()), maps.left_out);
        #[cfg(not(feature = "normals"))]
        let (mapped, about_maps) = (Vec::new(), Vec::new());
        #[cfg_attr(
            not(feature = "normals"),
            expect(unused_mut, reason = "without the room nothing is counted yet")
        )]
        let mut counters = Counters::default();
        #[cfg(feature = "normals")]
        {
            counters.normals = maps.counted;
        }
        let skins = Skins::new(device, scene, &mut device_scene)?;
        let lights = !scene.lights.is_empty();
        #[cfg_attr(not(feature = "fog"), expect(unused_mut, reason = "only a medium adds to the sky"))]
        let mut pipelines =
            Pipelines::new(context, HDR, lights, fogged.as_deref(), &mapped).map_err(Failure::work)?;
        #[cfg(feature = "fog")]
        if fog.as_ref().is_some_and(|fog| fog.sky.is_some()) {
            pipelines.sky.in_medium(context, HDR).map_err(Failure::work)?;
        }
        Ok(Self {
            device,
            scene: Arc::new(device_scene),
            camera: scene.camera(),
            environment: scene.environment.as_ref().map(|environment| EnvironmentMap {
                width: environment.width as u32,
                height: environment.height as u32,
                rotation: environment.rotation.as_dquat(),
            }),
            ambient,
            lighting: Lighting::new(device, scene, source)?,
            skins,
            #[cfg(feature = "shadow")]
            unshadowed: super::shadow::left_out(scene),
            pipelines,
            lights: LightsConstants::of_scene(scene),
            #[cfg(feature = "fog")]
            fog,
            unread: unread::of_frame(scene, source).into_iter().chain(about_maps).collect(),
            relight_bytes: relight::bytes(scene),
            relight_seconds: None,
            counters,
            linear,
            display,
            over: None,
        })
    }

    /// Makes a target of another size; frames declared before keep theirs.
    #[cfg(feature = "view")]
    pub fn resize(&mut self, picture: [u32; 2]) -> Outcome {
        [self.linear, self.display] = targets(self.device, picture)?;
        Ok(())
    }

    /// Has `over` drawn over the picture in frames declared from now on that have a window.
    #[cfg(feature = "view")]
    pub fn draw_over(&mut self, over: Over) {
        self.over = Some(over);
    }

    /// The device that draws.
    pub fn device(&self) -> &'d Device<'d> {
        self.device
    }

    /// Looks through another camera from the next turn on.
    #[cfg(any(feature = "view", feature = "shadow", feature = "normals"))]
    pub fn look(&mut self, camera: Camera) {
        self.camera = camera;
    }

    /// The cameras' views, from left to right, with the environment turned by `turn`.
    pub(super) fn views(&self, settings: &Settings, turn: DQuat) -> Vec<ViewConstants> {
        let rotation = self.environment.as_ref().map_or(DQuat::IDENTITY, |map| turn * map.rotation);
        let aspect = view::aspect(settings.size);
        let constants =
            |camera: &Camera| ViewConstants::new(camera, aspect, rotation.as_quat(), self.ambient);
        view::row(&self.camera, settings.views).iter().map(constants).collect()
    }

    /// What the fog pass needs of each camera, from left to right, with the environment turned by `turn`.
    #[cfg(feature = "fog")]
    pub(super) fn fog_views(&self, settings: &Settings, turn: DQuat) -> Outcome<Vec<airglow::fog::View>> {
        let aspect = view::aspect(settings.size);
        let Some(fog) = &self.fog else { return Ok(Vec::new()) };
        let rotation = self.environment.as_ref().map_or(DQuat::IDENTITY, |map| turn * map.rotation);
        let cameras = view::row(&self.camera, settings.views);
        cameras.iter().map(|camera| fog.view(camera, aspect, rotation)).collect()
    }

    /// Has plans say so of what a scene does not hold because the host took it out.
    pub fn say_left_out(&mut self, record: LeftOut) {
        self.unread.retain(|other| other.what != record.what);
        self.unread.push(record);
    }

    /// Whether plans say so of `what` already.
    #[cfg(feature = "fog")]
    pub(super) fn says_left_out(&self, what: &str) -> bool {
        self.unread.iter().any(|record| record.what == what)
    }

    /// What a plan says of the time that leaving the pass out saves, seconds.
    pub fn say_relight_takes(&mut self, seconds: Option<f64>) {
        self.relight_seconds = seconds;
    }
}

/// Buffers for a picture, scene-linear and for the display.
fn targets(device: &Device<'_>, picture: [u32; 2]) -> Outcome<[Buffer; 2]> {
    let pixels = u64::from(picture[0]) * u64::from(picture[1]);
    let target = |name, bytes, usage| {
        let desc = BufferDesc { size: bytes * pixels, usage: vk::BufferUsageFlags::STORAGE_BUFFER | usage };
        let label = Label::new(upload::OWNER, name);
        device.context().create_buffer(label, &desc, Location::Readback).map_err(Failure::work)
    };
    Ok([
        target("linear picture", 12, vk::BufferUsageFlags::empty())?,
        target("display picture", 4, vk::BufferUsageFlags::TRANSFER_SRC)?,
    ])
}
