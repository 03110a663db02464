//! Pictures of the window, panel and all.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use airglow_gpu::ash::vk;
use airglow_gpu::{Readback, Record};
use airglow_graph::{Access, Graph, Handle, Image, ImageDesc, PassKind};
use airglow_scene::image_io::write_png_bytes;

use crate::failure::{Failure, Outcome};

/// A pass that copies the window's image for the CPU, in frames that are declared while it is asked for.
#[derive(Clone, Default)]
pub struct Shot {
    wanted: Arc<AtomicBool>,
    copy: Arc<Mutex<Option<Readback>>>,
}

impl Shot {
    /// Whether frames declared from now on have the pass.
    pub fn ask(&self, wanted: bool) {
        self.wanted.store(wanted, Ordering::Relaxed);
    }

    /// Adds the pass where it is asked for.
    pub fn add(&self, graph: &mut Graph<Record>, window: Handle<Image>) {
        if !self.wanted.load(Ordering::Relaxed) {
            return;
        }
        let mut pass = graph.pass("picture of the window", PassKind::Transfer);
        pass.read(&window, Access::TransferSource).side_effect();
        let copy = Arc::clone(&self.copy);
        pass.record(Box::new(move |recorder, resources| {
            let read = recorder.read_back_image(&resources.view(&window)?)?;
            *copy.lock().unwrap_or_else(PoisonError::into_inner) = Some(read);
            Ok(())
        }));
    }

    /// Writes what was copied, once the frame is done, as PNG.
    pub fn write(&self, desc: &ImageDesc, path: &Path) -> Outcome {
        let copy = self.copy.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(copy) = copy else {
            return Err(Failure::work("the picture was not taken: no frame was drawn"));
        };
        let texels: Vec<[u8; 4]> = copy.read().map_err(Failure::work)?;
        let blue_first = [vk::Format::B8G8R8A8_SRGB, vk::Format::B8G8R8A8_UNORM].contains(&desc.format);
        let pixels: Vec<[u8; 3]> =
            texels.iter().map(|&[a, b, c, _]| if blue_first { [c, b, a] } else { [a, b, c] }).collect();
        let [width, height, _] = desc.extent.map(|side| side as usize);
        write_png_bytes(path, width, height, &pixels).map_err(Failure::work)
    }
}

/// Whether images of the window can be copied.
pub fn can_copy(desc: &ImageDesc) -> bool {
    desc.usage.contains(vk::ImageUsageFlags::TRANSFER_SRC)
}
