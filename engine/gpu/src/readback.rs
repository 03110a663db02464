//! From the device to the CPU: a copy to mapped memory, read once the host knows the frame is done.

use crate::allocator::Location;
use crate::error::GpuError;
use crate::memory::{Buffer, BufferSlice, ImageView, Label};
use crate::recorder::Recorder;
use airglow_graph::{Access, BufferDesc, ImageDesc};
use ash::vk;
use bytemuck::Pod;
use half::f16;

/// A copy that will be readable when the frame it was recorded in is done.
pub struct Readback {
    buffer: Buffer,
    /// Format of the texels, when an image was copied.
    format: Option<vk::Format>,
}

impl Readback {
    /// The copy as values; bytes that fill no whole value are left off.
    ///
    /// The frame must be done: earlier, the values are anything.
    ///
    /// # Errors
    /// None in practice: the copy is mapped.
    pub fn read<T: Pod>(&self) -> Result<Vec<T>, GpuError> {
        let count = self.buffer.size() / (size_of::<T>() as u64).max(1);
        self.buffer.read(0, count as usize)
    }

    /// The copy of an image as RGBA, row by row, layer by layer. Channels a format lacks are 0, alpha 1.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a copy of a buffer, or a format that [`texels`] does not know.
    pub fn texels(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        let Some(format) = self.format else {
            return Err(GpuError::misuse(
                self.buffer.name(),
                "a copy of a buffer has no texels; read values",
            ));
        };
        texels(format, &self.read::<u8>()?)
    }
}

/// Packed texels as RGBA: R32G32B32A32, R16G16B16A16, R32 and D32 floats as they are, R8G8B8A8 UNORM in [0, 1] and
/// SRGB as stored, without decoding. Channels a format lacks are 0, alpha 1.
///
/// # Errors
/// [`GpuError::Misuse`] for any other format.
pub fn texels(format: vk::Format, bytes: &[u8]) -> Result<Vec<[f32; 4]>, GpuError> {
    let texels = match format {
        vk::Format::R32G32B32A32_SFLOAT => bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect(),
        vk::Format::R16G16B16A16_SFLOAT => {
            let texel = |chunk| bytemuck::pod_read_unaligned::<[f16; 4]>(chunk).map(f16::to_f32);
            bytes.chunks_exact(8).map(texel).collect()
        }
        vk::Format::R32_SFLOAT | vk::Format::D32_SFLOAT => {
            let texel = |chunk| [bytemuck::pod_read_unaligned(chunk), 0.0, 0.0, 1.0];
            bytes.chunks_exact(4).map(texel).collect()
        }
        vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB => {
            let texel = |chunk: &[u8]| std::array::from_fn(|i| f32::from(chunk[i]) / 255.0);
            bytes.chunks_exact(4).map(texel).collect()
        }
        _ => return Err(GpuError::misuse(format!("{format:?}"), "not a format that is read back as RGBA")),
    };
    Ok(texels)
}

impl Recorder<'_> {
    /// Copies a buffer for the CPU. The buffer is in use [`Access::TransferSource`].
    ///
    /// # Errors
    /// Those of making a buffer and of [`Recorder::copy_buffer`].
    pub fn read_back_buffer(&mut self, from: impl Into<BufferSlice>) -> Result<Readback, GpuError> {
        let from = from.into();
        let buffer = self.readback_buffer(from.size())?;
        self.copy_buffer(from, &buffer)?;
        self.memory_barrier(Access::TransferDestination, Access::HostRead)?;
        Ok(Readback { buffer, format: None })
    }

    /// Copies the first mip of a view for the CPU. The image is in use [`Access::TransferSource`].
    ///
    /// # Errors
    /// Those of making a buffer and of [`Recorder::copy_image_to_buffer`].
    pub fn read_back_image(&mut self, from: &ImageView) -> Result<Readback, GpuError> {
        let desc = from.image().desc();
        let [width, height, depth] = from.image().extent(from.desc().base_mip);
        let packed =
            ImageDesc { extent: [width, height, depth], mips: 1, layers: from.desc().layers, ..*desc };
        let Some(size) = packed.bytes() else {
            return Err(GpuError::misuse(
                from.image().name(),
                format!("{:?} has no known texel size", desc.format),
            ));
        };
        let buffer = self.readback_buffer(size)?;
        self.copy_image_to_buffer(from, &buffer)?;
        self.memory_barrier(Access::TransferDestination, Access::HostRead)?;
        Ok(Readback { buffer, format: Some(desc.format) })
    }

    fn readback_buffer(&self, size: u64) -> Result<Buffer, GpuError> {
        let desc = BufferDesc { size, usage: vk::BufferUsageFlags::TRANSFER_DST };
        self.context().create_buffer(Label::new("readback", "readback"), &desc, Location::Readback)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_unpack() {
        let half: Vec<u8> =
            [1.5f32, -2.0, 0.25, 1.0].iter().flat_map(|&v| f16::from_f32(v).to_le_bytes()).collect();
        assert_eq!(texels(vk::Format::R16G16B16A16_SFLOAT, &half).unwrap(), [[1.5, -2.0, 0.25, 1.0]]);
        let bytes = [0, 51, 255, 255];
        assert_eq!(texels(vk::Format::R8G8B8A8_UNORM, &bytes).unwrap(), [[0.0, 0.2, 1.0, 1.0]]);
        assert_eq!(texels(vk::Format::R32_SFLOAT, &2.5f32.to_le_bytes()).unwrap(), [[2.5, 0.0, 0.0, 1.0]]);
        assert!(texels(vk::Format::BC7_UNORM_BLOCK, &bytes).is_err());
    }
}
