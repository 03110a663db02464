//! The host: its scene, its passes, its target, and pictures out of them.

use std::sync::Arc;

use airglow::relight::{MeshId, Relight, Storage as RelightStorage};
use airglow_gpu::Record;
use airglow_gpu::ash::vk;
use airglow_gpu::{Buffer, Execution, Label, Location, Requirements, Timing, TimingSummary};
use airglow_graph::{Access, BufferDesc, Plan};
use airglow_scene::{Camera, FloatImage, Scene, Storage};
use glam::DQuat;

use super::device::Device;
use super::draw::Pipelines;
use super::environment_samples::EnvironmentSamples;
use super::frame;
use super::scene::{self, DeviceScene};
use super::transfer::{InstanceTransfer, SceneTransfer};
use super::view::ViewConstants;
use super::{upload, view};
use crate::failure::{Failure, Outcome};

/// Everything a frame is declared from.
pub struct Renderer<'d> {
    pub(super) device: &'d Device<'d>,
    pub(super) scene: Arc<DeviceScene>,
    pub(super) camera: Camera,
    pub(super) environment: Option<EnvironmentMap>,
    pub(super) ambient: [f32; 3],
    pub(super) relight: Relight,
    pub(super) meshes: Vec<MeshId>,
    /// Vertices of each of `meshes`.
    vertices: Vec<u64>,
    pub(super) instances: Vec<InstanceTransfer>,
    pub(super) pipelines: Pipelines,
    pub(super) vertex_colours: Option<HostColours>,
    pub(super) relight_seconds: Option<f64>,
    pub(super) linear: Buffer,
    pub(super) display: Buffer,
    size: [u32; 2],
}

/// What a frame needs to know of the environment beside its image.
pub struct EnvironmentMap {
    pub(super) width: u32,
    pub(super) height: u32,
    /// World from map.
    pub(super) rotation: DQuat,
}

/// Colours of all vertices that the host computed itself.
pub struct HostColours {
    pub(super) buffer: Buffer,
    pub(super) ranges: Vec<(u64, u64)>,
}

/// What may change from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Samples along each side of a pixel.
    pub samples: u32,
    /// Factor from scene-linear values to the display.
    pub exposure: f32,
    /// Turns the environment, on top of the scene's own rotation.
    pub turn: DQuat,
    /// Turns the environment further about the vertical axis in each frame, radians.
    pub spin: f64,
    /// Leaves the relight pass out: ambient light only.
    pub without_relight: bool,
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
}

impl Picture {
    /// Puts the left half of another picture of the same size in place of this one's.
    pub fn replace_left_half(&mut self, other: &Self) {
        let (width, half) = (self.linear.width, self.linear.width / 2);
        for row in 0..self.linear.height {
            let left = row * width..row * width + half;
            self.linear.pixels[left.clone()].copy_from_slice(&other.linear.pixels[left.clone()]);
            self.display[left.clone()].copy_from_slice(&other.display[left]);
        }
    }
}

/// Frames whose times are dropped.
pub const WARM_UP: usize = 2;

/// What the device must offer for a scene of this quality.
pub fn requirements(scene: &Scene) -> Requirements {
    Relight::requirements(&relight_settings(scene))
}

/// The pass's settings for a scene.
pub fn relight_settings(scene: &Scene) -> airglow::relight::Settings {
    airglow::relight::Settings {
        order: scene.quality.order as usize,
        storage: match scene.quality.storage {
            Storage::F32 => RelightStorage::F32,
            Storage::F16 => RelightStorage::F16,
        },
        ..airglow::relight::Settings::default()
    }
}

impl<'d> Renderer<'d> {
    /// Uploads the scene, prepares the pass with its transfer, and makes the target of `size` pixels.
    pub fn new(
        device: &'d Device<'d>,
        scene: &Scene,
        transfer: &SceneTransfer,
        size: [u32; 2],
    ) -> Outcome<Self> {
        let context = device.context();
        let device_scene = device.run(|recorder| scene::upload(recorder, scene)).map_err(Failure::work)?;
        let mut relight = Relight::new(context, relight_settings(scene)).map_err(Failure::work)?;
        let mut meshes = Vec::with_capacity(transfer.transfers.len());
        for (transfer, account) in transfer.transfers.iter().zip(&transfer.accounts) {
            let count = transfer.vertex_count as u32;
            let mesh = relight.add_mesh(context, &account.name, count, Some(&transfer.coefficients));
            meshes.push(mesh.map_err(Failure::work)?);
        }
        let ambient = match &scene.environment {
            Some(environment) => {
                EnvironmentSamples::new(environment).map_err(Failure::input)?.mean_radiance()
            }
            None => [0.0; 3],
        };
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let target = |name, bytes| {
            let desc = BufferDesc { size: bytes * pixels, usage: vk::BufferUsageFlags::STORAGE_BUFFER };
            context
                .create_buffer(Label::new(upload::OWNER, name), &desc, Location::Readback)
                .map_err(Failure::work)
        };
        let hdr = vk::Format::R32G32B32A32_SFLOAT;
        if !device.renders(hdr) {
            return Err(Failure::device(format!(
                "the device cannot render to {hdr:?}; choose another with --device"
            )));
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
            relight,
            meshes,
            vertices: transfer.transfers.iter().map(|transfer| transfer.vertex_count as u64).collect(),
            instances: transfer.instances.clone(),
            pipelines: Pipelines::new(context, hdr).map_err(Failure::work)?,
            vertex_colours: None,
            relight_seconds: None,
            linear: target("linear picture", 12)?,
            display: target("display picture", 4)?,
            size,
        })
    }

    /// Lights the vertices by these colours, one list for each instance, instead of the pass.
    pub fn light_by(&mut self, colours: &[Vec<[f32; 3]>]) -> Outcome {
        let mut all: Vec<[f32; 4]> = Vec::new();
        let mut ranges = Vec::with_capacity(colours.len());
        for colours in colours {
            ranges.push((16 * all.len() as u64, 16 * colours.len() as u64));
            all.extend(colours.iter().map(|&[r, g, b]| [r, g, b, 1.0]));
        }
        let buffer = self
            .device
            .run(|recorder| upload::buffer(recorder, "reference colours", &all, Access::VertexBuffer))
            .map_err(Failure::work)?;
        self.vertex_colours = Some(HostColours { buffer, ranges });
        Ok(())
    }

    /// The camera's view with the environment turned by `turn`.
    pub(super) fn view(&self, settings: &Settings, turn: DQuat) -> ViewConstants {
        let rotation = self.environment.as_ref().map_or(DQuat::IDENTITY, |map| turn * map.rotation);
        ViewConstants::new(&self.camera, view::aspect(settings.size), rotation.as_quat(), self.ambient)
    }

    /// Bytes that the pass holds and makes for this scene: transfer of all meshes, colours of all instances.
    pub(super) fn relight_bytes(&self) -> u64 {
        let settings = self.relight.settings();
        let vertices = |transfer: usize| self.vertices.get(transfer).copied().unwrap_or(0);
        let transfer: u64 = self.vertices.iter().map(|count| count * settings.vector_bytes()).sum();
        let instances = self.instances.iter().map(|instance| vertices(instance.transfer));
        transfer + instances.map(|count| count * settings.output_bytes()).sum::<u64>()
    }

    /// Measures what leaving the pass out saves, for the plan to say: its median device time in a frame.
    pub fn measure_relight(&mut self, settings: &Settings) -> Outcome {
        let picture = self.draw(&Settings { without_relight: false, ..*settings }, WARM_UP + 9)?;
        let passes = picture.timing.map_or(Vec::new(), |timing| timing.passes);
        let ours = passes.iter().filter(|pass| pass.name.starts_with("relight"));
        self.relight_seconds = (!passes.is_empty()).then(|| ours.map(|pass| pass.median).sum());
        Ok(())
    }

    /// The plan of a frame.
    pub fn plan(&mut self, settings: &Settings) -> Outcome<Plan<Record>> {
        let declared = frame::declare(self, settings)?;
        declared.graph.compile(&self.device.context().graph_limits()).map_err(Failure::work)
    }

    /// Draws `frames` frames and reads the last one back.
    pub fn draw(&mut self, settings: &Settings, frames: usize) -> Outcome<Picture> {
        let declared = frame::declare(self, settings)?;
        let plan = declared.graph.compile(&self.device.context().graph_limits()).map_err(Failure::work)?;
        let context = self.device.context();
        let passes = plan.steps().len() as u32;
        let mut execution = Execution::prepare(context, plan).map_err(Failure::work)?;
        // A queue without timestamps draws all the same.
        let mut timing = Timing::new(context, passes, WARM_UP, frames).ok();
        let instances: Vec<Orientation> =
            self.instances.iter().map(|instance| instance.orientation).collect();
        let turn_light = |frame: usize| {
            // One plan for all frames: only the rotation of the light and of the view's sky changes.
            let turn = DQuat::from_rotation_y(settings.spin * frame as f64) * settings.turn;
            declared.view.set(self.view(settings, turn));
            match (&declared.rotations, &self.environment) {
                (Some(rotations), Some(map)) => {
                    rotations.set(turn * map.rotation, &instances).map_err(Failure::work)
                }
                _ => Ok(()),
            }
        };
        let cpu_milliseconds =
            self.device.frames(&mut execution, &declared.imports, timing.as_mut(), frames, turn_light)?;
        let pixels = self.size[0] as usize * self.size[1] as usize;
        let linear: Vec<f32> = self.linear.read(0, 3 * pixels).map_err(Failure::work)?;
        let display: Vec<[u8; 4]> = self.display.read(0, pixels).map_err(Failure::work)?;
        Ok(Picture {
            linear: view::picture(self.size, &linear),
            display: display.iter().map(|&[r, g, b, _]| [r, g, b]).collect(),
            timing: timing.and_then(|timing| timing.summary()),
            cpu_milliseconds,
        })
    }
}
