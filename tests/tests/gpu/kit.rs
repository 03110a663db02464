//! The conformance kit finds what is wrong with a room that lies.

use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageUsageFlags};
use airglow_gpu::{Context, Label, Location, Options, Recorder, Requirements};
use airglow_graph::{Access, BufferDesc, ImageDesc, PassKind};
use airglow_tests::conformance::{Declared, Given, HostResource, Refusal, Room, conform_on, fail_on};
use airglow_tests::device::{open, stated};

/// Copies a host's image to its buffer.
struct Copying(Lie);

/// What it keeps from its host.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    Nothing,
    /// In our graph it leaves the image in another layout than it declares.
    LayoutInGraph,
    /// The same on the road without a graph.
    Layout,
    /// Without a graph it writes other bytes.
    Bits,
    /// It never gives back a buffer.
    Leak,
    /// It goes on where a buffer could not be made.
    Silence,
}

impl Copying {
    fn new(context: &Context, lie: Lie) -> Result<Self, Refusal> {
        let desc = BufferDesc { size: 64, usage: BufferUsageFlags::STORAGE_BUFFER };
        let made = context.create_buffer(Label::new("room", "own"), &desc, Location::Device);
        match lie {
            Lie::Leak => std::mem::forget(made?),
            Lie::Silence => drop(made),
            _ => drop(made?),
        }
        Ok(Self(lie))
    }
}

impl Room for Copying {
    fn requirements(&self) -> Requirements {
        Requirements::engine()
    }

    fn resources(&self) -> Vec<HostResource> {
        let usage = ImageUsageFlags::TRANSFER_SRC | ImageUsageFlags::SAMPLED;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(4, 4, Format::R32_SFLOAT) };
        let texels = (0..16).flat_map(|i: u8| f32::from(i).to_le_bytes()).collect();
        let ends = [Access::TransferDestination, Access::TransferSource];
        vec![
            HostResource::image("texels", desc, texels, [Access::TransferSource; 2]),
            HostResource::results("copy", 64, BufferUsageFlags::empty(), ends),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let (image, buffer, lies) = (to.image(0)?, to.buffer(1)?, self.0 == Lie::LayoutInGraph);
        let mut pass = to.graph.pass("copy", PassKind::Transfer);
        pass.read(&image, Access::TransferSource);
        let buffer = pass.write(buffer, Access::TransferDestination);
        pass.record(Box::new(move |recorder, resources| {
            let view = resources.view(&image)?;
            recorder.copy_image_to_buffer(&view, resources.buffer(&buffer)?)?;
            match lies {
                true => recorder.transition(view.image(), Access::TransferSource, Access::ComputeSampled),
                false => Ok(()),
            }
        }));
        Ok(())
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        Ok([Access::TransferSource, Access::TransferDestination]
            .map(|access| Some((access, access)))
            .to_vec())
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let (image, buffer) = (host[0].image()?, host[1].buffer()?);
        recorder.copy_image_to_buffer(&image.full_view()?, buffer)?;
        match self.0 {
            Lie::Layout => recorder.transition(image, Access::TransferSource, Access::ComputeSampled)?,
            Lie::Bits => {
                recorder.memory_barrier(Access::TransferDestination, Access::TransferDestination)?;
                recorder.fill(buffer, 7)?;
            }
            _ => {}
        }
        Ok(())
    }
}

/// What the kit says of a room with that lie.
fn said(lie: Lie) -> Option<String> {
    let open = open(&Requirements::engine());
    let (host, asked) = (stated(&open, open.device()), Requirements::engine());
    // SAFETY: the device was just opened, as stated, and is no one else's.
    let conformed = unsafe {
        conform_on(&host, &asked, &Options::default(), |context, _| Copying::new(context, lie)).map(|_| ())
    };
    // SAFETY: as above.
    let failed = || unsafe { fail_on(&host, &asked, |context, _| Copying::new(context, lie)).map(|_| ()) };
    conformed.and_then(|()| failed()).err().map(|problem| problem.to_string())
}

#[test]
fn the_kit_says_of_each_lie_what_it_is() {
    assert_eq!(said(Lie::Nothing), None);
    for (lie, words) in [
        (Lie::LayoutInGraph, &["texels", "SHADER_READ_ONLY_OPTIMAL"][..]),
        (Lie::Layout, &["texels", "SHADER_READ_ONLY_OPTIMAL after the room", "TRANSFER_SRC_OPTIMAL said"]),
        (Lie::Bits, &["resource 1", "the roads differ from byte 0 on"]),
        (Lie::Leak, &["left alive", "Buffer"]),
        (Lie::Silence, &["nobody said so"]),
    ] {
        let found = said(lie).unwrap_or_else(|| panic!("{lie:?} goes unnoticed"));
        println!("{lie:?}: {found}");
        assert!(words.iter().all(|word| found.contains(word)), "{lie:?}: {found}");
    }
}
