//! What a host says each frame, and what it gets back.

use crate::control::{Control, Counts};
use crate::view::View;

/// A frame. Images are named by graph handles on the graph's road, by `()` on the road without one.
#[derive(Clone, Debug)]
pub struct Frame<I> {
    /// Pixels of the images.
    pub size: [u32; 2],
    /// Scene-linear radiance of the surfaces without the medium, any float format. Only the first mip is read, texel by
    /// texel, without a sampler.
    pub surface: I,
    /// Their depth. A pixel whose value is the farthest one shows no surface: its ray goes on without end.
    pub depth: I,
    /// The host's own image for the result, in [`Settings::format`](crate::Settings::format), or `None` for one made
    /// for the frame.
    pub target: Option<I>,
    /// The view.
    pub view: View,
}

/// What the pass hands on.
#[derive(Clone, Debug)]
pub struct Fogged<I> {
    /// The picture through the medium; the surface itself when the pass was left out.
    pub colour: I,
    /// Changes the view before a plan is recorded again; `None` when the pass was left out.
    pub control: Option<Control>,
    /// Which lights the shader is given.
    pub counts: Counts,
}
