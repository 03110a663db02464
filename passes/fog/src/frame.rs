//! What a host says each frame, and what it gets back.

use airglow_math::World;

use crate::control::Control;
use crate::{Camera, Environment, Light, Medium};

/// The view through a medium: everything that may change while a plan stays.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The host's conventions: axes, units, depth, jitter, pre-exposure.
    pub world: World,
    /// From where.
    pub camera: Camera,
    /// Through what.
    pub medium: Medium,
    /// Lights inside the medium, at most [`MAX_LIGHTS`](crate::MAX_LIGHTS).
    pub lights: Vec<Light>,
    /// What lies behind the scene, lit from afar; `None`: darkness. Some needs
    /// [`Settings::environment`](crate::Settings::environment).
    pub environment: Option<Environment>,
}

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

/// Lights of a view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Those whose airlight passes the bound somewhere in the picture.
    pub evaluated: u32,
    /// Those left out: dark, too weak, or out of reach of every pixel.
    pub left_out: u32,
    /// Pairs of a tile, [`TILE`](crate::TILE) pixels on a side, and a light that is evaluated in it.
    pub pairs: u32,
    /// Pairs left out: with those evaluated, as many as there are tiles times lights.
    pub pairs_left_out: u32,
}
