//! Buffers, images and samplers: named, charged to an owner, destroyed when no frame can use them.

pub(crate) mod buffer;
pub(crate) mod heap;
pub(crate) mod image;
pub(crate) mod sampler;
pub(crate) mod view;

pub use buffer::{Buffer, BufferSlice};
pub use image::{Image, ViewDesc};
pub use sampler::{Sampler, SamplerDesc};
pub use view::ImageView;

/// Whose a resource is and what it is called.
#[derive(Clone, Copy, Debug)]
pub struct Label<'a> {
    /// Whom the bytes are charged to: a pass, or the host.
    pub owner: &'a str,
    /// Name, shown by captures, validation and errors.
    pub name: &'a str,
}

impl<'a> Label<'a> {
    /// The resource `name` of `owner`.
    pub fn new(owner: &'a str, name: &'a str) -> Self {
        Self { owner, name }
    }
}
