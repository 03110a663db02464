//! What a window has drawn over its picture.

use std::sync::Arc;

use airglow_gpu::Record;
use airglow_graph::{Graph, Handle, Image};

#[cfg(feature = "view")]
use super::renderer::Renderer;

/// Adds a pass that draws over the picture in an image of the window's.
pub type Over = Arc<dyn Fn(&mut Graph<Record>, Handle<Image>)>;

#[cfg(feature = "view")]
impl Renderer<'_> {
    /// Has `over` drawn over the picture in frames declared from now on that have a window.
    pub fn draw_over(&mut self, over: Over) {
        self.over = Some(over);
    }
}
