//! What a context makes or takes from its host: buffers, images and samplers.

use crate::allocator::Location;
use crate::context::Context;
use crate::error::GpuError;
use crate::memory::{Buffer, Image, Label, Sampler, SamplerDesc};
use airglow_graph::{BufferDesc, ImageDesc};
use ash::vk;

impl Context {
    /// Makes a buffer of at least one byte.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] over `maxMemoryAllocationSize` or `maxBufferSize`, [`GpuError::Memory`] when there is
    /// no memory left, [`GpuError::Misuse`] for an empty buffer.
    pub fn create_buffer(
        &self,
        label: Label<'_>,
        desc: &BufferDesc,
        location: Location,
    ) -> Result<Buffer, GpuError> {
        Buffer::new(&self.shared, label, desc, location)
    }

    /// Wraps a buffer of the host's. `desc` must describe it truly.
    ///
    /// # Safety
    /// `raw` is a live buffer of this device with at least the stated size and usage, bound to memory, and stays
    /// so until every clone is dropped and the frames that used it are done. Dropping the clones does not destroy it.
    pub unsafe fn import_buffer(&self, raw: vk::Buffer, label: Label<'_>, desc: &BufferDesc) -> Buffer {
        Buffer::imported(&self.shared, raw, label, desc)
    }

    /// Makes an image with optimal tiling, in layout `UNDEFINED`.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for what the device cannot make (format with usage, size, layers), [`GpuError::Memory`]
    /// when there is no memory left.
    pub fn create_image(&self, label: Label<'_>, desc: &ImageDesc) -> Result<Image, GpuError> {
        Image::new(&self.shared, label, desc)
    }

    /// Wraps an image of the host's. `desc` must describe it truly.
    ///
    /// # Safety
    /// `raw` is a live image of this device with that format, extent, mips, layers and usage, bound to memory, and
    /// stays so until every clone is dropped and the frames that used it are done. Dropping the clones destroys only
    /// the views made here.
    pub unsafe fn import_image(&self, raw: vk::Image, label: Label<'_>, desc: &ImageDesc) -> Image {
        Image::imported(&self.shared, raw, label, desc)
    }

    /// Makes a sampler.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] if the device refuses.
    pub fn create_sampler(&self, desc: &SamplerDesc<'_>) -> Result<Sampler, GpuError> {
        Sampler::new(&self.shared, desc)
    }
}
