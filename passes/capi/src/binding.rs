//! Resources of the host's that a pass is recorded with.
#![allow(dead_code, reason = "helpers of passes, of which there may be none")]

use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{BufferSlice, Context, GpuError, ImageView, Label, ViewDesc};
use airglow_graph::{BufferDesc, ImageDesc};

use crate::access::{Number, Uses};
use crate::status::Failure;

/// A resource of the host's, for one recording: a buffer or an image. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct AirglowBinding {
    /// See `AirglowAccess`.
    pub resource: u32,
    /// See `AirglowAccess`.
    pub index: u32,
    /// The `VkBuffer`, or 0 for an image.
    pub buffer: u64,
    /// First byte of the resource in the buffer.
    pub offset: u64,
    /// Bytes of the whole buffer.
    pub size: u64,
    /// The `VkImage`, 2D with one sample, or 0 for a buffer.
    pub image: u64,
    /// `VkFormat` of the image.
    pub format: u32,
    /// `VkBufferUsageFlags` or `VkImageUsageFlags` that it was made with.
    pub usage: u32,
    /// Width and height of the image.
    pub extent: [u32; 2],
    /// Mips of the image; 0 is 1.
    pub mips: u32,
    /// Not used; 0.
    pub reserved: u32,
}

/// What a binding stands for, in the library's hands.
#[derive(Clone)]
pub(crate) enum Imported {
    /// The first mip of an image.
    Image(ImageView),
    /// A buffer from its offset on.
    Buffer(BufferSlice),
}

impl AirglowBinding {
    /// The resource, by its name in messages.
    ///
    /// # Safety
    /// It describes a live resource of the context's device truly.
    pub(crate) unsafe fn import(&self, context: &Context, name: &str) -> Result<Imported, Failure> {
        let label = Label::new("host", name);
        match (self.buffer, self.image) {
            (0, image) if image != 0 => {
                let [width, height] = self.extent;
                let desc = ImageDesc {
                    usage: vk::ImageUsageFlags::from_raw(self.usage),
                    mips: self.mips.max(1),
                    ..ImageDesc::new_2d(width, height, vk::Format::from_raw(self.format as i32))
                };
                // SAFETY: the caller vouches for the image.
                let image = unsafe { context.import_image(vk::Image::from_raw(image), label, &desc) };
                Ok(Imported::Image(image.view(ViewDesc::single(0, 0))?))
            }
            (buffer, 0) if buffer != 0 => {
                let usage = vk::BufferUsageFlags::from_raw(self.usage);
                let desc = BufferDesc { size: self.size, usage };
                // SAFETY: the caller vouches for the buffer.
                let buffer = unsafe { context.import_buffer(vk::Buffer::from_raw(buffer), label, &desc) };
                let rest = self.size.saturating_sub(self.offset);
                Ok(Imported::Buffer(buffer.slice(self.offset, rest)?))
            }
            _ => Err(GpuError::misuse(name, "give a buffer or an image, not both or none").into()),
        }
    }
}

/// All that is bound for a recording.
pub(crate) struct Bound<'a> {
    uses: &'a Uses,
    all: Vec<(Number, Imported)>,
}

impl<'a> Bound<'a> {
    /// The scratch that was made, and the host's resources, which count where they are the same.
    ///
    /// # Safety
    /// `given` describe live resources of the context's device truly.
    pub(crate) unsafe fn new(
        context: &Context,
        uses: &'a Uses,
        scratch: &[(Number, Imported)],
        given: &[AirglowBinding],
    ) -> Result<Self, Failure> {
        let mut all = scratch.to_vec();
        for binding in given {
            let (row, name) = uses.wanted((binding.resource, binding.index))?;
            // SAFETY: the caller vouches for what the binding says.
            let imported = unsafe { binding.import(context, name)? };
            match (&imported, row.is_image) {
                (Imported::Image(_), 0) => return Err(Failure::argument(name, "give a buffer")),
                (Imported::Buffer(_), 1) => return Err(Failure::argument(name, "give an image")),
                _ => all.push(((row.resource, row.index), imported)),
            }
        }
        Ok(Self { uses, all })
    }

    /// Each resource, later ones in the place of earlier ones of its number.
    pub(crate) fn all(&self) -> &[(Number, Imported)] {
        &self.all
    }

    /// A buffer that must be there.
    pub(crate) fn buffer(&self, number: Number) -> Result<BufferSlice, Failure> {
        match self.last(number)? {
            Imported::Buffer(slice) => Ok(slice.clone()),
            Imported::Image(_) => Err(self.missing(number)),
        }
    }

    /// An image that must be there.
    pub(crate) fn image(&self, number: Number) -> Result<ImageView, Failure> {
        match self.last(number)? {
            Imported::Image(view) => Ok(view.clone()),
            Imported::Buffer(_) => Err(self.missing(number)),
        }
    }

    fn last(&self, number: Number) -> Result<&Imported, Failure> {
        let found = self.all.iter().rfind(|(bound, _)| *bound == number);
        found.map(|(_, imported)| imported).ok_or_else(|| self.missing(number))
    }

    fn missing(&self, number: Number) -> Failure {
        let name = self.uses.find(number).map_or("a resource", |(_, name)| name);
        Failure::argument(name, "it is not bound: add it to the bindings")
    }
}

/// Sets of bindings that are kept: as many as a host has frames in flight, and some.
const MOST_KEPT: usize = 8;

/// What a frame was recorded with, the last set at the end.
pub(crate) struct Kept<B> {
    sets: Vec<(Vec<AirglowBinding>, B)>,
}

impl<B> Default for Kept<B> {
    fn default() -> Self {
        Self { sets: Vec::new() }
    }
}

impl<B> Kept<B> {
    /// The set for `given`, made by `import` where it is not here.
    pub(crate) fn set(
        &mut self,
        given: &[AirglowBinding],
        import: impl FnOnce() -> Result<B, Failure>,
    ) -> Result<&mut B, Failure> {
        match self.sets.iter().position(|(known, _)| known == given) {
            Some(place) => self.sets[place..].rotate_left(1),
            None => {
                let bound = import()?;
                if self.sets.len() == MOST_KEPT {
                    self.sets.remove(0);
                }
                self.sets.push((given.to_vec(), bound));
            }
        }
        let problem = "no set of bindings is kept";
        self.sets.last_mut().map(|(_, bound)| bound).ok_or_else(|| Failure::argument("bindings", problem))
    }

    /// Forgets all.
    pub(crate) fn forget(&mut self) {
        self.sets.clear();
    }
}
