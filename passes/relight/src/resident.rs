//! Buffers on the device whose contents are still to be copied there.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Buffer, Context, GpuError, Label, Location, Recorder};
use airglow_graph::BufferDesc;

/// Whom this room's memory is charged to.
pub(crate) const OWNER: &str = "relight";

/// A buffer in device memory, and the copy that is still to be recorded.
pub(crate) struct Resident {
    buffer: Buffer,
    pending: Upload,
}

/// A copy into a [`Resident`]. It is recorded once; then its staging memory is given back.
#[derive(Clone)]
pub(crate) struct Upload {
    staging: Arc<Mutex<Option<Buffer>>>,
    target: Buffer,
}

impl Resident {
    /// A storage buffer that will hold `words`.
    pub(crate) fn new(context: &Context, name: &str, words: &[u32]) -> Result<Self, GpuError> {
        Self::with_usage(context, name, words, BufferUsageFlags::STORAGE_BUFFER)
    }

    /// A buffer of this usage that will hold `words`.
    pub(crate) fn with_usage(
        context: &Context,
        name: &str,
        words: &[u32],
        usage: BufferUsageFlags,
    ) -> Result<Self, GpuError> {
        let size = 4 * words.len() as u64;
        let made = |usage, location| {
            context.create_buffer(Label::new(OWNER, name), &BufferDesc { size, usage }, location)
        };
        let target = made(usage | BufferUsageFlags::TRANSFER_DST, Location::Device)?;
        let staging = made(BufferUsageFlags::TRANSFER_SRC, Location::Upload)?;
        staging.write(0, words)?;
        let pending = Upload { staging: Arc::new(Mutex::new(Some(staging))), target: target.clone() };
        Ok(Self { buffer: target, pending })
    }

    /// The same for f32 values.
    pub(crate) fn from_values(context: &Context, name: &str, values: &[f32]) -> Result<Self, GpuError> {
        Self::new(context, name, bytemuck::cast_slice(values))
    }

    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// The copy, unless it was recorded.
    pub(crate) fn upload(&self) -> Option<Upload> {
        self.pending.staging().is_some().then(|| self.pending.clone())
    }
}

impl Upload {
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        if let Some(staging) = self.staging().take() {
            recorder.copy_buffer(&staging, &self.target)?;
        }
        Ok(())
    }

    fn staging(&self) -> MutexGuard<'_, Option<Buffer>> {
        self.staging.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
