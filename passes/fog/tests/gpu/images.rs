//! What the tests draw the pass over.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

use airglow_fog::{ACCESSES, Bindings, Pass};
use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageLayout, ImageUsageFlags};
use airglow_gpu::{Image, Label, Location};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use airglow_math::World;
use airglow_tests::device::Fixture;

/// Pixels of the pictures.
pub const SIZE: [u32; 2] = [48, 27];
/// All of them.
pub const PIXELS: usize = 48 * 27;

/// How far along the view's axis the surface of a pixel is, as its depth in f32 says: 0.2 m to 100 m, and none in the
/// upper third.
pub fn view_distance(pixel: usize) -> Option<f64> {
    let depth = World::default().depth;
    let share = (pixel * 7 % PIXELS) as f64 / PIXELS as f64;
    let rounded = depth.value(0.2 * 500_f64.powf(share)) as f32;
    (pixel >= PIXELS / 3).then(|| depth.view_distance(f64::from(rounded)))
}

/// A surface, its depth and the picture.
pub struct Images(pub [Image; 3]);

impl Images {
    /// All surfaces send out `radiance` in each channel.
    pub fn new(fixture: &Fixture, radiance: f32) -> Self {
        let world = World::default().depth;
        let depth =
            |pixel| view_distance(pixel).map_or(world.farthest(), |metres| world.value(metres)) as f32;
        Self::of(fixture, SIZE, |_| radiance, depth)
    }

    /// The same in a picture of any size, by radiance and depth of each pixel.
    pub fn of(
        fixture: &Fixture,
        size: [u32; 2],
        radiance: impl Fn(usize) -> f32,
        depth: impl Fn(usize) -> f32,
    ) -> Self {
        let pixels = (size[0] * size[1]) as usize;
        let context = fixture.context();
        let make = |name, format, usage| {
            let desc = ImageDesc { usage, ..ImageDesc::new_2d(size[0], size[1], format) };
            context.create_image(Label::new("test", name), &desc).unwrap()
        };
        let given = ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST;
        let hdr = Format::R32G32B32A32_SFLOAT;
        let images = [
            make("surface", hdr, given),
            make("depth", Format::D32_SFLOAT, given | ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT),
            make("picture", hdr, ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC),
        ];
        let staging = |bytes: &[f32]| {
            let desc = BufferDesc { size: size_of_val(bytes) as u64, usage: BufferUsageFlags::TRANSFER_SRC };
            let buffer =
                context.create_buffer(Label::new("test", "texels"), &desc, Location::Upload).unwrap();
            buffer.write(0, bytes).unwrap();
            buffer
        };
        let surface: Vec<f32> = (0..pixels).flat_map(|pixel| [radiance(pixel); 4]).collect();
        let depth: Vec<f32> = (0..pixels).map(depth).collect();
        let contents = [staging(&surface), staging(&depth)];
        fixture
            .device()
            .run(context, |recorder| {
                for ((image, contents), (_, access)) in images.iter().zip(&contents).zip(ACCESSES) {
                    recorder.transition(
                        image,
                        State::idle(ImageLayout::UNDEFINED),
                        Access::TransferDestination,
                    )?;
                    recorder.copy_buffer_to_image(contents, &image.full_view()?)?;
                    recorder.transition(image, Access::TransferDestination, access)?;
                }
                Ok(())
            })
            .unwrap();
        Self(images)
    }

    /// The picture that the pass makes.
    pub fn draw(&self, fixture: &Fixture, pass: &Pass) -> Vec<[f32; 4]> {
        let [surface, depth, picture] = &self.0;
        let mut copy = None;
        fixture
            .device()
            .run(fixture.context(), |recorder| {
                let views = [surface.full_view()?, depth.full_view()?, picture.full_view()?];
                let [surface, depth, target] = views.clone();
                let write = Access::ColorAttachmentWrite;
                recorder.transition(picture, State::idle(ImageLayout::UNDEFINED), write)?;
                pass.record(recorder, &Bindings { surface, depth, target })?;
                recorder.transition(picture, write, Access::TransferSource)?;
                copy = Some(recorder.read_back_image(&views[2])?);
                Ok(())
            })
            .unwrap();
        copy.unwrap().read::<[f32; 4]>().unwrap()
    }
}
