//! This room inside a host with a device of its own, by both roads.

use airglow_gpu::ash::vk::{BufferUsageFlags, ImageLayout};
use airglow_gpu::requirements::Limit;
use airglow_gpu::{Context, DeviceMask, Image, Options, Permutations, Recorder, Requirements};
use airglow_graph::{Access, State};
use airglow_normals::{
    Build, Envelope, FitSettings, NormalMap, Normals, Pipelines, Resource, Settings, Storage,
};
use airglow_tests::compare::assert_close;
use airglow_tests::conformance::{
    Declared, Given, HostResource, MakePrepared, Outputs, Refusal, Room, change, conform, copy_mips,
    fail_each, prepare, shuffle, stage,
};
use airglow_tests::hosts::hosts;
use airglow_tests::narrow;
use glam::DVec3;

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
        Self::of(context, &Normals::new(context, settings)?)
    }

    fn of(context: &Context, normals: &Normals) -> Result<Self, Refusal> {
        Ok(Self { settings: *normals.settings(), build: normals.build(context, &common::weave(16))? })
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
    let staged = stage(Built::new, &Normals::requirements(&SETTINGS()));
    assert!(staged == whole, "a device whose memory the CPU cannot map");
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
fn three_hosts_get_the_same_map() {
    let ours = common::weave(16);
    for world in hosts() {
        let theirs = |normal: &DVec3| [normal.x, world.green_sign() * normal.y, normal.z].map(|c| c as f32);
        let vectors: Vec<_> = ours.normals().iter().map(theirs).collect();
        let map = NormalMap::from_vectors(16, 16, &vectors).unwrap().of_host(&world);
        let pairs = ours.normals().iter().zip(map.normals());
        assert!(pairs.clone().all(|(a, b)| (*a - *b).length() < 1e-6), "{world:?}");
        assert!(pairs.clone().any(|(a, _)| a.y.abs() > 0.1), "green says something");
    }
}

#[test]
fn nothing_within_the_envelope_makes_a_pipeline() {
    let envelope = || Envelope { lobes: vec![1, 2, 4], storages: vec![Storage::F16, Storage::Octahedral8] };
    let of = |lobes| envelope().storages.into_iter().map(move |storage| (lobes, storage));
    let all: Vec<_> = envelope().lobes.into_iter().flat_map(of).collect();
    let settings = |&(lobes, storage)| Settings {
        fit: FitSettings { lobes, ..FitSettings::default() },
        storage,
        ..Settings::default()
    };
    let make = |settings| {
        move |context: &Context, pipelines: &Pipelines| {
            Built::of(context, &Normals::with_pipelines(settings, pipelines)?)
        }
    };
    let makes: Vec<_> = all.iter().map(settings).map(make).collect();
    let makes: Vec<MakePrepared<'_, _, _>> = makes.iter().map(|make| make as _).collect();
    let count = envelope().pipeline_count().unwrap();
    let requirements = all
        .iter()
        .map(settings)
        .fold(Requirements::engine(), |all, settings| all.and(&Normals::requirements(&settings)));
    let made = prepare(&requirements, |context| Pipelines::prepare(context, envelope()), count, &makes);
    println!("{made} pipelines for {} settings", makes.len());
    // Fits by lobes, one lobe needs no order, packing by storage.
    assert_eq!((made, makes.len()), (3 + 2 + 2, 6));
    let six = Settings { fit: FitSettings { lobes: 6, ..FitSettings::default() }, ..SETTINGS() };
    let outside = envelope().check(&six).unwrap_err().to_string();
    assert!(outside.contains("6 lobes") && outside.contains("Envelope::lobes"), "{outside}");
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
