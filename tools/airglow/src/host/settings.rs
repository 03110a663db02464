//! What may be asked of a frame.

use airglow_gpu::ash::vk;
use airglow_graph::ImageDesc;
use glam::DQuat;

#[cfg(feature = "fog")]
use super::complete::Road;

/// What may change from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels of each view.
    pub size: [u32; 2],
    /// Views side by side in the picture.
    pub views: u32,
    /// Samples along each side of a pixel.
    pub samples: u32,
    /// Factor from scene-linear values to the display.
    pub exposure: f32,
    /// Turns the environment, on top of the scene's own rotation.
    pub turn: DQuat,
    /// Turns the environment further about the vertical axis in each frame, radians.
    pub spin: f64,
    /// Leaves the relight pass out of the frame, though it is there: ambient light only.
    pub without_relight: bool,
    /// Leaves the shadows of what moves out of the frame, though the pass is there.
    pub without_shadow: bool,
    /// Has the shadow pass's counts read back.
    pub count_shadow: bool,
    /// When the first frame is, seconds after the scene's time 0: figures stand and walk by it.
    pub time: f64,
    /// Seconds from one frame to the next.
    pub step: f64,
    /// Has the transients of the frame share memory.
    pub share_transients: bool,
    /// How the scene's medium is drawn.
    pub air: Air,
    /// The images of a window, of the picture's size, that get a copy of it. The picture for the display then has the
    /// order of their channels.
    pub window: Option<ImageDesc>,
}

/// How the medium of a scene is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Air {
    /// By the fog pass.
    #[default]
    Fog,
    /// By the complete model of each surface in the forward draw.
    #[cfg(feature = "fog")]
    Complete(Road),
    /// Not at all: clear air.
    Clear,
    /// As exponential depth fog of this colour, W/sr/m2.
    #[cfg(feature = "fog")]
    DepthFog([f32; 3]),
}

impl Air {
    /// Whether surfaces are lit through the medium.
    pub fn is_fog(self) -> bool {
        #[cfg(feature = "fog")]
        if matches!(self, Self::Complete(_)) {
            return true;
        }
        self == Self::Fog
    }

    /// Fog, or clear air without it.
    pub fn with_fog(fog: bool) -> Self {
        if fog { Self::Fog } else { Self::Clear }
    }
}

impl Settings {
    /// A frame of that size with all passes, one view and one sample a pixel, at the scene's time 0.
    pub fn plain(size: [u32; 2]) -> Self {
        Self {
            size,
            views: 1,
            samples: 1,
            exposure: 1.0,
            turn: DQuat::IDENTITY,
            spin: 0.0,
            without_relight: false,
            without_shadow: false,
            count_shadow: false,
            time: 0.0,
            step: 0.0,
            share_transients: false,
            air: Air::Fog,
            window: None,
        }
    }

    /// Whether blue is the lowest byte of a pixel for the display.
    pub fn blue_first(&self) -> bool {
        let blue_first = [vk::Format::B8G8R8A8_SRGB, vk::Format::B8G8R8A8_UNORM];
        self.window.is_some_and(|window| blue_first.contains(&window.format))
    }

    /// Pixels of the picture.
    pub fn picture_size(&self) -> [u32; 2] {
        [self.views * self.size[0], self.size[1]]
    }
}
