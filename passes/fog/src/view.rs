//! The view of a frame.

use airglow_math::World;

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
