//! Kernels run one frame at a time, submitted and waited for by a host: what tests, evaluation and examples use.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Buffer, Context, GpuError, Label, Location, Recorder};
use airglow_graph::{Access, BufferDesc};
use bytemuck::Pod;

use crate::RadianceError;

const OWNER: &str = "radiance";

/// Records what it is given into one frame of the bench's context, submits it and waits until it is done.
pub type Run<'a> =
    dyn Fn(&mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>) -> Result<(), GpuError> + 'a;

/// A host for single frames. This crate never submits or waits; the caller does, in `run`.
#[derive(Clone, Copy)]
pub struct Bench<'a> {
    /// The context frames are recorded for.
    pub context: &'a Context,
    /// Submits one frame and waits.
    pub run: &'a Run<'a>,
}

impl Bench<'_> {
    /// A storage buffer that holds `values`; one byte at least is made for none.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device has no room.
    pub fn upload<T: Pod + Default>(&self, name: &str, values: &[T]) -> Result<Buffer, RadianceError> {
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::INDIRECT_BUFFER;
        let desc = BufferDesc { size: size_of_val(values).max(size_of::<T>()) as u64, usage };
        let buffer = self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
        match values {
            [] => buffer.write(0, &[T::default()])?,
            values => buffer.write(0, values)?,
        }
        Ok(buffer)
    }

    /// A storage buffer of the device, which may be read back, filled and dispatched from.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device has no room.
    pub fn scratch(&self, name: &str, bytes: u64) -> Result<Buffer, RadianceError> {
        let usage = BufferUsageFlags::STORAGE_BUFFER
            | BufferUsageFlags::INDIRECT_BUFFER
            | BufferUsageFlags::TRANSFER_SRC
            | BufferUsageFlags::TRANSFER_DST;
        let desc = BufferDesc { size: bytes.max(16), usage };
        Ok(self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Device)?)
    }

    /// What a buffer holds, once kernels have written it.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device fails, or the buffer is no whole number of values.
    pub fn read<T: Pod>(&self, buffer: &Buffer) -> Result<Vec<T>, RadianceError> {
        let mut copy = None;
        (self.run)(&mut |recorder| {
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_buffer(buffer)?);
            Ok(())
        })?;
        let copy = copy.ok_or_else(|| GpuError::misuse("the bench", "its host did not record the frame"))?;
        Ok(copy.read()?)
    }
}
