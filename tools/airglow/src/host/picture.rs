//! Frames compiled and drawn, and pictures out of them.

use airglow_gpu::{Calibration, Execution, FrameTimes, Imports, Record, Timing, TimingSummary};
use airglow_graph::Plan;
use airglow_scene::{Exposure, FloatImage};
use glam::DQuat;

use super::frame::{self, Declared, Turning};
use super::lighting::Lighting;
#[cfg(feature = "radiance")]
use super::near::Arrival;
use super::renderer::Renderer;
use super::settings::Settings;
use super::view;
use super::work::{self, PassWork};
use crate::failure::{Failure, Outcome};

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
    pub lights: Vec<airglow::fog::Counts>,
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

impl Renderer<'_> {
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
            let extinction = frame::extinction(self, settings);
            near.turn(control, Arrival { turn, filter: filter.as_deref(), extinction })?;
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
            passes: work::of_frame(&execution),
            #[cfg(feature = "fog")]
            lights: turning.fog.iter().map(|control| control.counts()).collect(),
            frames: timing.iter().flat_map(Timing::frames).cloned().collect(),
            calibrations: before.zip(after).map(|(before, after)| [before, after]),
        })
    }

    /// The median device time of the relight pass in a frame, seconds.
    pub fn measure_relight(&mut self, settings: &Settings) -> Outcome<Option<f64>> {
        let timing = self.draw(settings, WARM_UP + 9)?.timing;
        let passes = timing.map_or(Vec::new(), |timing| timing.passes);
        let ours = || passes.iter().filter(|pass| pass.name.starts_with("relight"));
        Ok(ours().next().is_some().then(|| ours().map(|pass| pass.median).sum()))
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
}
