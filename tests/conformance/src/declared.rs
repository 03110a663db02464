//! What a room is added to: a graph that has the host's resources in it.

use airglow_gpu::ash::vk::ImageViewType;
use airglow_gpu::{Buffer, Context, GpuError, Image, Imports, Record, Recorder, ViewDesc};
use airglow_graph::{self as graph, Access, Graph, Handle, ImageDesc, PassKind};

use crate::Refusal;

/// A host's resource in a graph.
#[derive(Clone, Copy)]
pub enum Named {
    /// A buffer.
    Buffer(Handle<graph::Buffer>),
    /// An image.
    Image(Handle<graph::Image>),
}

/// A graph, and the host's resources in it.
pub struct Declared<'a> {
    /// The context that the graph is compiled for.
    pub context: &'a Context,
    /// The graph.
    pub graph: &'a mut Graph<Record>,
    /// Where the room's own resources go.
    pub imports: &'a mut Imports,
    /// The host's resources, in the order of [`Room::resources`](crate::Room::resources).
    pub host: &'a [Named],
}

impl Declared<'_> {
    /// The host's buffer at a place.
    ///
    /// # Errors
    /// There is none.
    pub fn buffer(&self, place: usize) -> Result<Handle<graph::Buffer>, Refusal> {
        match self.host.get(place) {
            Some(Named::Buffer(handle)) => Ok(*handle),
            _ => Err(format!("resource {place} of the host is no buffer").into()),
        }
    }

    /// The host's image at a place.
    ///
    /// # Errors
    /// There is none.
    pub fn image(&self, place: usize) -> Result<Handle<graph::Image>, Refusal> {
        match self.host.get(place) {
            Some(Named::Image(handle)) => Ok(*handle),
            _ => Err(format!("resource {place} of the host is no image").into()),
        }
    }

    /// Copies a buffer that the room made into the host's at a place, of the same size.
    ///
    /// # Errors
    /// There is none.
    pub fn keep(&mut self, made: Handle<graph::Buffer>, place: usize) -> Result<(), Refusal> {
        let kept = self.buffer(place)?;
        let mut pass = self.graph.pass("copy", PassKind::Transfer);
        pass.read(&made, Access::TransferSource);
        let kept = pass.write(kept, Access::TransferDestination);
        pass.record(Box::new(move |recorder, resources| {
            recorder.copy_buffer(resources.buffer(&made)?, resources.buffer(&kept)?)
        }));
        Ok(())
    }

    /// Copies an image that the room made into the host's buffer at a place, tightly packed, mip by mip.
    ///
    /// # Errors
    /// There is none.
    pub fn keep_image(&mut self, made: Handle<graph::Image>, place: usize) -> Result<(), Refusal> {
        let kept = self.buffer(place)?;
        let mut pass = self.graph.pass("copy", PassKind::Transfer);
        pass.read(&made, Access::TransferSource);
        let kept = pass.write(kept, Access::TransferDestination);
        pass.record(Box::new(move |recorder, resources| {
            copy_mips(recorder, resources.view(&made)?.image(), resources.buffer(&kept)?)
        }));
        Ok(())
    }
}

/// Copies an image, ready to be copied from, into a buffer: mip by mip, layer by layer, tightly packed.
///
/// # Errors
/// [`GpuError::Misuse`] for a buffer that is too short.
pub fn copy_mips(recorder: &mut Recorder<'_>, image: &Image, to: &Buffer) -> Result<(), GpuError> {
    let layers = image.desc().layers;
    let dimension = if layers > 1 { ImageViewType::TYPE_2D_ARRAY } else { ImageViewType::TYPE_2D };
    let mut first = 0;
    for base_mip in 0..image.desc().mips {
        let desc = ImageDesc { extent: image.extent(base_mip), mips: 1, ..*image.desc() };
        let bytes = desc.bytes().unwrap_or(0);
        let view = image.view(ViewDesc { dimension, base_mip, mips: 1, base_layer: 0, layers })?;
        recorder.copy_image_to_buffer(&view, to.slice(first, bytes)?)?;
        first += bytes;
    }
    Ok(())
}
