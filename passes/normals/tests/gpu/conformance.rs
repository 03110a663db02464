//! This room inside a host with a device of its own, by both roads.

use airglow_gpu::ash::vk::{BufferUsageFlags, ImageLayout};
use airglow_gpu::requirements::Limit;
use airglow_gpu::{Context, DeviceMask, Image, Options, Recorder, Requirements};
use airglow_graph::{Access, State};
use airglow_normals::{Build, FitSettings, Normals, Resource, Settings, Storage};
use airglow_tests::compare::assert_close;
use airglow_tests::conformance::{
    Declared, Given, HostResource, Outputs, Refusal, Room, change, conform, copy_mips, fail_each, shuffle,
};
use airglow_tests::narrow;

use super::common;

/// The texture of a map, copied to a host's buffer mip by mip.
struct Built {
    settings: Settings,
    build: Build,
}

const SETTINGS: fn() -> Settings = || Settings { storage: Storage::F16, ..Settings::default() };

impl Built {
    fn new(context: &Context) -> Result<Self, Refusal> {
        Self::with(context, SETTINGS())
    }

    fn with(context: &Context, settings: Settings) -> Result<Self, Refusal> {
        let build = Normals::new(context, settings)?.build(context, &common::weave(16))?;
        Ok(Self { settings, build })
    }

    fn image(&self) -> Result<&Image, Refusal> {
        Ok(&self.build.texture().ok_or("a map of one texel")?.image)
    }
}

impl Room for Built {
    fn requirements(&self) -> Requirements {
        Normals::requirements(&self.settings)
    }

    fn resources(&self) -> Vec<HostResource> {
        let size = self.build.texture().map_or(1, |texture| texture.bytes);
        let ends = [Access::TransferDestination, Access::TransferSource];
        vec![HostResource::results("texels", size, BufferUsageFlags::empty(), ends)]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let texture = self.build.add(to.graph, to.imports, usize::MAX).ok_or("no texture")?;
        to.keep_image(texture, 0)
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        Ok(vec![Some((Access::TransferDestination, Access::TransferDestination))])
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let image = self.image()?.clone();
        for stage in self.build.take(usize::MAX) {
            let storage = Access::ComputeStorageReadWrite;
            let copies = stage.accesses().iter().any(|(resource, _)| *resource == Resource::Texture);
            recorder.memory_barrier(storage, if copies { Access::TransferSource } else { storage })?;
            if copies {
                let fresh = State::idle(ImageLayout::UNDEFINED);
                recorder.transition(&image, fresh, Access::TransferDestination)?;
            }
            recorder.labelled(stage.name(), |recorder| stage.record(recorder))?;
        }
        recorder.transition(&image, Access::TransferDestination, Access::TransferSource)?;
        Ok(copy_mips(recorder, &image, host[0].buffer()?)?)
    }
}

fn outputs(options: &Options) -> Outputs {
    conform(|context| Built::new(context).unwrap(), &Normals::requirements(&SETTINGS()), options)
}

#[test]
fn a_host_with_its_own_device_gets_the_same_bits_by_both_roads_and_on_a_lesser_one() {
    let whole = outputs(&Options::default());
    assert!(whole[0].iter().any(|byte| *byte != 0 && *byte != 0xff));
    let limits = vec![(Limit::StorageBufferRange, 16 << 10)];
    let mask = DeviceMask { limits, without_optional_features: true };
    assert!(outputs(&Options { mask, breadcrumbs: true, ..Options::default() }) == whole);
}

/// Sums that are rounded otherwise may end in another fit; half a percent of the largest lobe is what storage loses.
#[test]
fn narrow_vectors_stay_near() {
    let values: Vec<f32> = outputs(&Options::default())[0]
        .chunks_exact(2)
        .map(|bytes| half::f16::from_le_bytes([bytes[0], bytes[1]]).to_f32())
        .collect();
    let Some(narrow) = narrow::again("conformance::narrow_vectors_stay_near", &values) else { return };
    let wide: Vec<f64> = values.iter().copied().map(f64::from).collect();
    assert_close("subgroups of 4", &narrow, &wide, 5e-3, 0.0);
}

#[test]
fn every_call_that_fails_is_told_and_leaves_nothing() {
    // The smallest kernels: what is not a pipeline is made once for each call.
    let small = Settings { fit: FitSettings { lobes: 2, ..FitSettings::default() }, ..SETTINGS() };
    let calls = fail_each(|context| Built::with(context, small), &Normals::requirements(&small));
    println!("{calls} calls failed in turn");
    assert!(calls > 20, "only {calls} calls could fail");
}

#[test]
fn quality_changes_while_frames_are_on_the_device() {
    let coarse = Settings { fit: FitSettings { lobes: 2, ..FitSettings::default() }, ..SETTINGS() };
    change(&[&Built::new, &|context| Built::with(context, coarse)], &Normals::requirements(&SETTINGS()));
}

#[test]
fn every_legal_order_gives_the_same_bits() {
    let orders = shuffle(Built::new, &Normals::requirements(&SETTINGS()), 0..3);
    println!("{orders} orders gave the same bits");
    assert!(orders > 1);
}
