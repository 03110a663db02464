//! The environment that a host gives as texels: an image of the library's own, uploaded by the first frame that is
//! recorded with it.

use std::sync::{Mutex, PoisonError};

use airglow_gpu::ash::vk;
use airglow_gpu::{Context, Image, ImageView, Label, Recorder};
use airglow_graph::{Access, ImageDesc, State};
use airglow_relight::check_environment;

use crate::status::Failure;

/// Three floats a texel are no format that every device samples.
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// An environment on the device.
pub(super) struct Sky {
    image: Image,
    /// Counts up with each environment of a pass.
    pub revision: u64,
    /// Texels that wait to be uploaded.
    waiting: Mutex<Option<Vec<[f32; 4]>>>,
}

impl Sky {
    /// Checks the texels and makes the image.
    pub(super) fn new(
        context: &Context,
        width: u32,
        height: u32,
        texels: &[[f32; 3]],
        revision: u64,
    ) -> Result<Self, Failure> {
        check_environment("environment", width, height, texels)?;
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(width, height, FORMAT) };
        let image = context.create_image(Label::new("relight", "relight environment"), &desc)?;
        let texels = texels.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
        Ok(Self { image, revision, waiting: Mutex::new(Some(texels)) })
    }

    /// Texels of a row, and rows.
    pub(super) fn size(&self) -> [u32; 2] {
        let [width, height, _] = self.image.desc().extent;
        [width, height]
    }

    /// The image, ready to be sampled by compute; what waits is uploaded first.
    pub(super) fn bind(&self, recorder: &mut Recorder<'_>) -> Result<ImageView, Failure> {
        let view = self.image.full_view()?;
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(texels) = waiting.as_ref() {
            let source = recorder.upload(texels)?;
            recorder.transition(&self.image, State::UNDEFINED, Access::TransferDestination)?;
            recorder.copy_buffer_to_image(&source, &view)?;
            recorder.transition(&self.image, Access::TransferDestination, Access::ComputeSampled)?;
            *waiting = None;
        }
        Ok(view)
    }
}
