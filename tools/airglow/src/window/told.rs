//! What the panel tells of the frames, the scene and what goes on.

use airglow_graph::LeftOut;
use airglow_scene::{Medium, Presets};

use super::times::Times;
use super::wish::KNOBS;

/// All of it, for one frame.
pub struct Told<'a> {
    /// The device.
    pub device: &'a str,
    /// Frames in the last second.
    pub rate: f64,
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Device times.
    pub times: &'a Times,
    /// What was left out of the plan, and why.
    pub left_out: &'a [LeftOut],
    /// What the scene asks of passes.
    pub presets: &'a Presets,
    /// Of each knob, where its pass is built in.
    pub values: [Option<f64>; KNOBS.len()],
    /// Of the scene.
    pub medium: Option<Medium>,
    /// Passes that the scene has something for.
    pub present: &'a [&'static str],
    /// What is being done, and how far it is.
    pub busy: Option<(String, Option<f32>)>,
    /// What happened last, or what went wrong.
    pub status: &'a Result<String, String>,
}
