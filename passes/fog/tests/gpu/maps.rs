//! Maps of environments on the device.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageLayout, ImageUsageFlags};
use airglow_gpu::{Image, Label, Location};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use airglow_tests::device::Fixture;

/// Of all maps.
pub const FORMAT: Format = Format::R32G32B32A32_SFLOAT;

fn image(fixture: &Fixture, size: [u32; 2], usage: ImageUsageFlags) -> Image {
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(size[0], size[1], FORMAT) };
    fixture.context().create_image(Label::new("test", "map"), &desc).unwrap()
}

/// An image to be drawn to.
pub fn target(fixture: &Fixture, size: [u32; 2]) -> Image {
    let usage = ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC | ImageUsageFlags::SAMPLED;
    image(fixture, size, usage)
}

/// A map of these texels, to be sampled in any stage.
pub fn uploaded(fixture: &Fixture, size: [u32; 2], texels: &[[f32; 4]]) -> Image {
    let map = image(fixture, size, ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST);
    let desc = BufferDesc { size: size_of_val(texels) as u64, usage: BufferUsageFlags::TRANSFER_SRC };
    let label = Label::new("test", "texels");
    let staging = fixture.context().create_buffer(label, &desc, Location::Upload).unwrap();
    staging.write(0, texels).unwrap();
    fixture
        .device()
        .run(fixture.context(), |recorder| {
            recorder.transition(&map, State::idle(ImageLayout::UNDEFINED), Access::TransferDestination)?;
            recorder.copy_buffer_to_image(&staging, &map.full_view()?)?;
            recorder.transition(&map, Access::TransferDestination, Access::ComputeSampled)?;
            recorder.memory_barrier(Access::TransferDestination, Access::FragmentSampled)
        })
        .unwrap();
    map
}
