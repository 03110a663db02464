//! The host: its scene, its passes, its target, and pictures out of them.

use std::sync::Arc;

use airglow_gpu::Record;
use airglow_gpu::ash::vk;
use airglow_gpu::{
    Buffer, Calibration, Execution, FrameTimes, Imports, Label, Location, Timing, TimingSummary,
};
use airglow_graph::{BufferDesc, LeftOut, Plan};
use airglow_scene::{Camera, Exposure, FloatImage, Scene};
use glam::DQuat;

use super::counted::Counters;
use super::device::Device;
use super::draw::Pipelines;
use super::environment_samples::EnvironmentSamples;
use super::filter::Filter;
#[cfg(feature = "fog")]
use super::fog::SceneFog;
use super::frame::{self, Declared, Turning};
use super::lighting::{self, Lighting, Source};
use super::lights::LightsConstants;
#[cfg(feature = "normals")]
use super::mapped::MappedMaterials;
#[cfg(feature = "radiance")]
use super::near::Arrival;
use super::over::Over;
use super::scene::{self, DeviceScene};
pub use super::settings::{Air, Settings};
use super::skin::Skins;
use super::unread;
use super::upload;
use super::view::{self, ViewConstants};
use crate::failure::{Failure, Outcome};
#[cfg(feature = "fog")]
use crate::measure::lights::LightStat;
use crate::measure::pass::{self, PassWork};

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

/// A picture, and what it took.
pub struct Picture {
    /// Scene-linear RGB.
    pub linear: FloatImage,
    /// sRGB bytes, exposed and tone-mapped.
    pub display: Vec<[u8; 3]>,
    /// Device times of the passes; `None` with too few frames.
    pub timing: Option<TimingSummary>,
    /// CPU milliseconds of recording each frame.
    pub cpu_milliseconds: Vec<f64>,
    /// What each pass does.
    pub passes: Vec<PassWork>,
    /// The lights of the fog pass in each view of the last frame.
    #[cfg(feature = "fog")]
    pub lights: Vec<LightStat>,
    /// The frames that were timed, oldest first.
    pub frames: Vec<FrameTimes>,
    /// The clocks of device and CPU before and after the frames; `None` where the device does not tell.
    pub calibrations: Option<[Calibration; 2]>,
}

/// A frame ready to be recorded as often as its topology stays.
pub struct Compiled {
    /// The plan and its transients.
    pub execution: Execution,
    /// The host's resources.
    pub imports: Imports,
    /// The ring of queries; `None` on a queue without timestamps, which draws all the same.
    pub timing: Option<Timing>,
    /// What changes from frame to frame while the plan stays.
    pub turning: Turning,
}

/// Frames whose times are dropped.
pub const WARM_UP: usize = 2;

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
        let hdr = vk::Format::R32G32B32A32_SFLOAT;
        if !device.renders(hdr) {
            return Err(Failure::device(format!(
                "the device cannot render to {hdr:?}; choose another with --device"
            )));
        }
        let [linear, display] = targets(device, picture)?;
        #[cfg(feature = "fog")]
        let fog = SceneFog::new(device, scene, Some(&device_scene), hdr)?;
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
            Pipelines::new(context, hdr, lights, fogged.as_deref(), &mapped).map_err(Failure::work)?;
        #[cfg(feature = "fog")]
        if fog.as_ref().is_some_and(|fog| fog.sky.is_some()) {
            pipelines.sky.in_medium(context, hdr).map_err(Failure::work)?;
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
            relight_bytes: lighting::relight_bytes(scene),
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

    /// The device that draws.
    pub fn device(&self) -> &'d Device<'d> {
        self.device
    }

    /// Looks through another camera from the next turn on.
    #[cfg(any(feature = "view", feature = "shadow", feature = "normals"))]
    pub fn look(&mut self, camera: Camera) {
        self.camera = camera;
    }

    /// The exposure asked for, or as the scene file says; automatic exposure looks at one frame first.
    pub fn exposure(&mut self, asked: Option<f32>, of_scene: Exposure, settings: &Settings) -> Outcome<f32> {
        match (asked, of_scene) {
            (Some(factor), _) if factor > 0.0 && factor.is_finite() => Ok(factor),
            (Some(factor), _) => {
                Err(Failure::usage(format!("--exposure is {factor}; expected a positive factor")))
            }
            (None, Exposure::Fixed { scale }) => Ok(scale),
            (None, automatic) => Ok(automatic.scale(&self.draw(settings, 1)?.linear.pixels)),
        }
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

    /// Turns the light and the sky of a declared frame; its plan stays.
    pub fn turn(&self, turning: &Turning, settings: &Settings, turn: DQuat) -> Outcome {
        for (shared, view) in turning.views.iter().zip(self.views(settings, turn)) {
            shared.set(view);
        }
        #[cfg(feature = "fog")]
        for (control, view) in turning.fog.iter().zip(self.fog_views(settings, turn)?) {
            control.set(&view).map_err(Failure::work)?;
        }
        #[cfg(feature = "radiance")]
        if let (Some(control), Lighting::Relight(lit)) = (&turning.near, &self.lighting)
            && let Some(near) = &lit.near
        {
            let filter = frame::filter(self, settings);
            near.turn(control, Arrival { turn, filter: filter.as_deref() })?;
        }
        match (&turning.rotations, &self.environment, &self.lighting) {
            (Some(rotations), Some(map), Lighting::Relight(lit)) => {
                #[cfg(feature = "normals")]
                if let (Some(rotations), Some(incident)) = (&turning.incident, &lit.incident) {
                    incident.turn(rotations, turn * map.rotation, &lit.orientations())?;
                }
                rotations.set(turn * map.rotation, &lit.orientations()).map_err(Failure::work)
            }
            _ => Ok(()),
        }
    }

    /// The median device time of the relight pass in a frame, seconds.
    pub fn measure_relight(&mut self, settings: &Settings) -> Outcome<Option<f64>> {
        let timing = self.draw(settings, WARM_UP + 9)?.timing;
        let passes = timing.map_or(Vec::new(), |timing| timing.passes);
        let ours = || passes.iter().filter(|pass| pass.name.starts_with("relight"));
        Ok(ours().next().is_some().then(|| ours().map(|pass| pass.median).sum()))
    }

    /// What a plan says of the time that leaving the pass out saves, seconds.
    pub fn say_relight_takes(&mut self, seconds: Option<f64>) {
        self.relight_seconds = seconds;
    }

    /// The plan of a frame.
    pub fn plan(&mut self, settings: &Settings) -> Outcome<Plan<Record>> {
        let declared = frame::declare(self, settings)?;
        declared.graph.compile(&self.device.context().graph_limits()).map_err(Failure::work)
    }

    /// A frame compiled, with a ring of queries that keeps `frames` frames; with `statistics` the device counts too.
    pub fn compile(&mut self, settings: &Settings, frames: usize, statistics: bool) -> Outcome<Compiled> {
        let Declared { graph, imports, turning } = frame::declare(self, settings)?;
        let context = self.device.context();
        let plan = graph.compile(&context.graph_limits()).map_err(Failure::work)?;
        let timing = Timing::new(context, plan.steps().len() as u32, WARM_UP, frames);
        let timing = match statistics {
            true => Some(timing.and_then(Timing::with_pipeline_statistics).map_err(Failure::device)?),
            false => timing.ok(),
        };
        let prepare = if settings.share_transients { Execution::prepare_shared } else { Execution::prepare };
        let execution = prepare(context, plan).map_err(Failure::work)?;
        Ok(Compiled { execution, imports, timing, turning })
    }

    /// Draws `frames` frames and reads the last one back.
    pub fn draw(&mut self, settings: &Settings, frames: usize) -> Outcome<Picture> {
        self.draw_counted(settings, frames, false)
    }

    /// The same, with pipeline statistics if asked for.
    pub fn draw_counted(&mut self, settings: &Settings, frames: usize, statistics: bool) -> Outcome<Picture> {
        let Compiled { mut execution, imports, mut timing, turning } =
            self.compile(settings, frames, statistics)?;
        let context = self.device.context();
        let turn_light = |frame: usize| {
            // One plan for all frames: only the rotation of the light and of the views' sky changes.
            let turn = DQuat::from_rotation_y(settings.spin * frame as f64) * settings.turn;
            self.move_to(settings.time + settings.step * frame as f64)?;
            self.turn(&turning, settings, turn)
        };
        let before = context.calibrate().map_err(Failure::work)?;
        let cpu_milliseconds =
            self.device.frames(&mut execution, &imports, timing.as_mut(), frames, turn_light)?;
        let after = context.calibrate().map_err(Failure::work)?;
        let size = settings.picture_size();
        let pixels = size[0] as usize * size[1] as usize;
        let linear: Vec<f32> = self.linear.read(0, 3 * pixels).map_err(Failure::work)?;
        let display: Vec<[u8; 4]> = self.display.read(0, pixels).map_err(Failure::work)?;
        Ok(Picture {
            linear: view::picture(size, &linear),
            display: display.iter().map(|&[r, g, b, _]| [r, g, b]).collect(),
            timing: timing.as_ref().and_then(Timing::summary),
            cpu_milliseconds,
            passes: pass::work(&execution),
            #[cfg(feature = "fog")]
            lights: turning.fog.iter().map(|control| control.counts().into()).collect(),
            frames: timing.iter().flat_map(Timing::frames).cloned().collect(),
            calibrations: before.zip(after).map(|(before, after)| [before, after]),
        })
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
