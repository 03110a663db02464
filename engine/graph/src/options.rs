//! What a declaration is compiled for, and with which choices.

/// What the device and the host's queue allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The queue family the plan will be recorded for. An imported state on another family is acquired and
    /// released; with `QUEUE_FAMILY_IGNORED` here, every named family counts as another one.
    pub queue_family: u32,
    /// Largest buffer in bytes (`maxBufferSize`).
    pub max_buffer_size: u64,
    /// Largest width or height of a 2D image in texels (`maxImageDimension2D`).
    pub max_image_dimension_2d: u32,
    /// Largest extent of a 3D image in texels (`maxImageDimension3D`).
    pub max_image_dimension_3d: u32,
    /// Most array layers (`maxImageArrayLayers`).
    pub max_image_array_layers: u32,
}

impl Default for Limits {
    /// The minima Vulkan 1.3 guarantees, on queue family 0.
    fn default() -> Self {
        Self {
            queue_family: 0,
            max_buffer_size: 1 << 30,
            max_image_dimension_2d: 4096,
            max_image_dimension_3d: 256,
            max_image_array_layers: 256,
        }
    }
}

/// Choices of compiling. The default keeps the declared order and knows no frame extent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Options {
    /// Width and height of the frame in texels, for extents relative to it
    /// ([`ExtentBase::Frame`](crate::ExtentBase::Frame)).
    pub frame_extent: Option<[u32; 2]>,
    /// Shuffles the passes within what their dependencies allow; the same seed gives the same plan. `None` keeps
    /// the declared order among passes that are ready. For tests: a result that changes with it has a bug.
    pub seed: Option<u64>,
}
