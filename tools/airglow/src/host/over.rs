//! What a window has drawn over its picture.

use std::sync::Arc;

use airglow_gpu::Record;
use airglow_graph::{Graph, Handle, Image};

/// Adds a pass that draws over the picture in an image of the window's.
pub type Over = Arc<dyn Fn(&mut Graph<Record>, Handle<Image>)>;
