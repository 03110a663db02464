//! What a resource is: size, format, usage, and where it comes from.

use crate::access::State;
use ash::vk;

/// A buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferDesc {
    /// Size in bytes, at least 1.
    pub size: u64,
    /// Usage. Of a buffer the graph makes, the plan adds what its passes need; an import must have it all.
    pub usage: vk::BufferUsageFlags,
}

impl BufferDesc {
    /// A buffer of `size` bytes whose usage is what its passes need.
    pub fn new(size: u64) -> Self {
        Self { size, usage: vk::BufferUsageFlags::empty() }
    }
}

/// An image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ImageDesc {
    /// Width, height and depth of mip 0 in texels, each at least 1. Depth above 1 makes a 3D image.
    pub extent: [u32; 3],
    /// Texel format.
    pub format: vk::Format,
    /// Mip levels, at least 1 and at most what the extent has.
    pub mips: u32,
    /// Array layers, at least 1; 6 per cube.
    pub layers: u32,
    /// Usage. Of an image the graph makes, the plan adds what its passes need; an import must have it all.
    pub usage: vk::ImageUsageFlags,
    /// Samples per texel.
    pub samples: vk::SampleCountFlags,
    /// Whether its layers are to be viewed as faces of cubes.
    pub cube: bool,
}

impl ImageDesc {
    /// A 2D image of one mip, one layer and one sample whose usage is what its passes need.
    pub fn new_2d(width: u32, height: u32, format: vk::Format) -> Self {
        Self {
            extent: [width, height, 1],
            format,
            mips: 1,
            layers: 1,
            usage: vk::ImageUsageFlags::empty(),
            samples: vk::SampleCountFlags::TYPE_1,
            cube: false,
        }
    }

    /// The texels' bytes over all mips, layers and samples; `None` for a format whose size this crate does
    /// not know, or a total past 64 bits. A device may need more (alignment, compression metadata).
    pub fn bytes(&self) -> Option<u64> {
        let texel = u64::from(texel_bytes(self.format)?);
        let texels = (0..self.mips.min(32)).try_fold(0u64, |sum, mip| {
            let [x, y, z] = self.extent.map(|e| u64::from((e >> mip).max(1)));
            sum.checked_add(x.checked_mul(y)?.checked_mul(z)?)
        })?;
        texels
            .checked_mul(texel)?
            .checked_mul(u64::from(self.layers))?
            .checked_mul(u64::from(self.samples.as_raw().max(1)))
    }

    /// The aspects of the format: depth, stencil, both, or colour.
    pub fn aspects(&self) -> vk::ImageAspectFlags {
        use vk::Format as F;
        match self.format {
            F::D16_UNORM | F::X8_D24_UNORM_PACK32 | F::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
            F::S8_UINT => vk::ImageAspectFlags::STENCIL,
            F::D16_UNORM_S8_UINT | F::D24_UNORM_S8_UINT | F::D32_SFLOAT_S8_UINT => {
                vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
            }
            _ => vk::ImageAspectFlags::COLOR,
        }
    }
}

/// Bytes of one texel of the uncompressed formats that lighting passes use.
fn texel_bytes(format: vk::Format) -> Option<u32> {
    use vk::Format as F;
    Some(match format {
        F::R8_UNORM | F::R8_UINT | F::S8_UINT => 1,
        F::R8G8_UNORM | F::R16_SFLOAT | F::R16_UNORM | F::R16_UINT | F::D16_UNORM => 2,
        F::R8G8B8A8_UNORM
        | F::R8G8B8A8_SNORM
        | F::R8G8B8A8_SRGB
        | F::R8G8B8A8_UINT
        | F::B8G8R8A8_UNORM
        | F::B8G8R8A8_SRGB
        | F::A2B10G10R10_UNORM_PACK32
        | F::B10G11R11_UFLOAT_PACK32
        | F::E5B9G9R9_UFLOAT_PACK32
        | F::R16G16_SFLOAT
        | F::R16G16_UNORM
        | F::R32_SFLOAT
        | F::R32_UINT
        | F::R32_SINT
        | F::X8_D24_UNORM_PACK32
        | F::D24_UNORM_S8_UINT
        | F::D32_SFLOAT => 4,
        F::R16G16B16A16_SFLOAT
        | F::R16G16B16A16_UNORM
        | F::R16G16B16A16_UINT
        | F::R32G32_SFLOAT
        | F::R32G32_UINT => 8,
        F::R32G32B32A32_SFLOAT | F::R32G32B32A32_UINT => 16,
        _ => return None,
    })
}

/// A buffer's or an image's description.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ResourceDesc {
    /// A buffer.
    Buffer(BufferDesc),
    /// An image.
    Image(ImageDesc),
}

impl ResourceDesc {
    /// Bytes, where known before allocation (see [`ImageDesc::bytes`]).
    pub fn bytes(&self) -> Option<u64> {
        match self {
            Self::Buffer(buffer) => Some(buffer.size),
            Self::Image(image) => image.bytes(),
        }
    }

    /// Mips and layers; a buffer is one subresource.
    pub(crate) fn subresources(&self) -> (u32, u32) {
        match self {
            Self::Buffer(_) => (1, 1),
            Self::Image(image) => (image.mips, image.layers),
        }
    }

    pub(crate) fn is_image(&self) -> bool {
        matches!(self, Self::Image(_))
    }
}

/// Where a resource comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Origin {
    /// The host's: found in `entry`, left in `exit`.
    Imported {
        /// The state the host leaves it in before the plan.
        entry: State,
        /// The state the host wants it in after the plan.
        exit: State,
    },
    /// The graph's: made for the plan, without contents before it.
    Transient,
}
