//! Buffers of a frame that are copied to where the CPU reads them, once the frame is done.

use std::sync::{Arc, Mutex, PoisonError};

use airglow_gpu::{Readback, Record};
use airglow_graph::{self as graph, Access, Graph, Handle, PassKind};
use bytemuck::Pod;

use crate::failure::{Failure, Outcome};

/// What is read back of a buffer.
#[derive(Clone, Default)]
pub struct Kept(Arc<Mutex<Option<Readback>>>);

impl Kept {
    /// Adds a pass that copies a buffer.
    pub fn add(graph: &mut Graph<Record>, name: &str, buffer: Handle<graph::Buffer>) -> Self {
        let kept = Self::default();
        let filled = kept.clone();
        let mut pass = graph.pass(name, PassKind::Transfer);
        pass.read(&buffer, Access::TransferSource).side_effect();
        pass.record(Box::new(move |recorder, resources| {
            let copy = recorder.read_back_buffer(resources.buffer(&buffer)?)?;
            *filled.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(copy);
            Ok(())
        }));
        kept
    }

    /// What was copied, which is taken; nothing before a frame is done.
    pub fn take<T: Pod>(&self) -> Outcome<Vec<T>> {
        let copy = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        copy.map_or(Ok(Vec::new()), |copy| copy.read::<T>().map_err(Failure::work))
    }
}
