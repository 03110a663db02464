//! This room inside a host with a device of its own, by both roads.

use airglow_gpu::ash::vk::{BufferUsageFlags, QUEUE_FAMILY_EXTERNAL};
use airglow_gpu::requirements::Limit;
use airglow_gpu::{Context, DeviceMask, Options, Permutations, Recorder, Requirements};
use airglow_graph::Access;
use airglow_shadow::{
    ACCESSES, Bindings, Blockers, Envelope, Exponential, Pipelines, PixelShadow, Receivers, Settings, Shadow,
};
use airglow_tests::compare::assert_close;
use airglow_tests::conformance::{
    Declared, Elsewhere, Given, HostResource, MakePrepared, Outputs, Refusal, Room, change, conform,
    fail_each, prepare, shuffle,
};
use airglow_tests::narrow;
use glam::DMat4;

use crate::graph::{SPHERES, ground};
use crate::wide;

/// A walking shadow on ground whose visibility the host keeps.
struct Shadowed {
    shadow: Shadow,
    receivers: Receivers,
    blockers: Blockers,
}

const SETTINGS: fn() -> Settings = || Settings { normals: true, ..Settings::default() };

impl Shadowed {
    fn new(context: &Context) -> Result<Self, Refusal> {
        Self::with(context, SETTINGS())
    }

    fn with(context: &Context, settings: Settings) -> Result<Self, Refusal> {
        Self::of(context, Shadow::new(context, settings)?)
    }

    fn of(context: &Context, shadow: Shadow) -> Result<Self, Refusal> {
        let receivers = shadow.receivers(context, "ground", &ground().0)?;
        let blockers = Blockers::default();
        blockers.set(&SPHERES, DMat4::IDENTITY)?;
        Ok(Self { shadow, receivers, blockers })
    }
}

impl Room for Shadowed {
    fn requirements(&self) -> Requirements {
        Shadow::requirements()
    }

    fn resources(&self) -> Vec<HostResource> {
        let (positions, normals) = ground();
        let given = |name, values: &[[f32; 3]]| {
            let bytes = values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
            let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::VERTEX_BUFFER;
            HostResource::buffer(name, bytes, usage, [Access::VertexBuffer; 2])
        };
        let kept = |name, size| {
            let ends = [Access::ComputeStorageWrite, Access::ComputeStorageRead];
            HostResource::results(name, size, BufferUsageFlags::STORAGE_BUFFER, ends)
        };
        let order = self.shadow.settings().order;
        vec![
            given("positions", &positions),
            given("normals", &normals),
            kept("visibility", self.receivers.visibility_bytes(order)),
            kept("records", self.receivers.record_bytes()),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let (positions, normals) = (to.buffer(0)?, to.buffer(1)?);
        let shadowed = self.shadow.add(to.graph, &self.receivers, &self.blockers, positions, Some(normals));
        to.keep(shadowed.visibility.ok_or("left out")?, 2)?;
        to.keep(shadowed.records.ok_or("left out")?, 3)
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        Ok(ACCESSES.map(|(_, access)| Some((access, access))).to_vec())
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let bindings = Bindings {
            positions: host[0].buffer()?.into(),
            normals: Some(host[1].buffer()?.into()),
            visibility: host[2].buffer()?.into(),
            records: host[3].buffer()?.into(),
        };
        Ok(self.shadow.record(recorder, &self.receivers, &self.blockers, &bindings)?)
    }
}

fn outputs(options: &Options) -> Outputs {
    conform(|context| Shadowed::new(context).unwrap(), &Shadow::requirements(), options)
}

/// The visibility, as values.
fn visibility(outputs: &Outputs) -> Vec<f32> {
    outputs[2].chunks_exact(4).map(|x| f32::from_le_bytes([x[0], x[1], x[2], x[3]])).collect()
}

#[test]
fn a_host_with_its_own_device_gets_the_same_bits_by_both_roads_and_on_a_lesser_one() {
    let whole = outputs(&Options::default());
    let values = visibility(&whole);
    assert!(values.iter().all(|value| value.is_finite()) && values.chunks_exact(16).any(|v| v[0] < 3.0));
    let limits = vec![(Limit::StorageBufferRange, 32 << 10)];
    let mask = DeviceMask { limits, without_optional_features: true };
    assert!(outputs(&Options { mask, breadcrumbs: true, ..Options::default() }) == whole);
    let elsewhere = |context: &Context| Elsewhere {
        room: Shadowed::new(context).unwrap(),
        family: QUEUE_FAMILY_EXTERNAL,
    };
    let taken = conform(elsewhere, &Shadow::requirements(), &Options::default());
    assert!(taken == whole, "buffers that another process has are taken and given back");
}

#[test]
fn narrow_vectors_stay_within_rounding() {
    let values = visibility(&outputs(&Options::default()));
    let Some(narrow) = narrow::again("conformance::narrow_vectors_stay_within_rounding", &values) else {
        return;
    };
    assert_close("subgroups of 4", &narrow, &wide(&values), 1e-5, 1e-5);
}

#[test]
fn every_call_that_fails_is_told_and_leaves_nothing() {
    // The smallest tables: they are made once for each call.
    let small = Settings { order: 3, ..SETTINGS() };
    let calls = fail_each(|context| Shadowed::with(context, small), &Shadow::requirements());
    println!("{calls} calls failed in turn");
    assert!(calls > 20, "only {calls} calls could fail");
}

#[test]
fn nothing_within_the_envelope_makes_a_pipeline() {
    let exponentials = vec![Exponential::Adaptive, Exponential::OptimalLinear];
    let envelope = || Envelope {
        orders: vec![3, 4],
        exponentials: exponentials.clone(),
        normals: vec![false, true],
        pixels: true,
    };
    let make = |settings| {
        move |context: &Context, pipelines: &Pipelines| {
            PixelShadow::with_pipelines(
                context,
                Settings { normals: true, exponential: Exponential::Adaptive, ..settings },
                pipelines,
            )?;
            Shadowed::of(context, Shadow::with_pipelines(context, settings, pipelines)?)
        }
    };
    let makes: Vec<_> = envelope().settings().into_iter().map(make).collect();
    let makes: Vec<MakePrepared<'_, _, _>> = makes.iter().map(|make| make as _).collect();
    let count = envelope().pipeline_count().unwrap();
    let requirements = Shadow::requirements().and(&PixelShadow::requirements());
    let made = prepare(&requirements, |context| Pipelines::prepare(context, envelope()), count, &makes);
    println!("{made} pipelines for {} settings", makes.len());
    // By order: a series with and without normals, squarings without, pixels.
    assert_eq!((made, makes.len()), (8, 6));
    let outside = envelope().check(&Settings { order: 5, ..SETTINGS() }).unwrap_err().to_string();
    assert!(outside.contains("order 5") && outside.contains("Envelope::orders"), "{outside}");
}

#[test]
fn quality_changes_while_frames_are_on_the_device() {
    let coarse = Settings { order: 3, ..SETTINGS() };
    change(&[&Shadowed::new, &|context| Shadowed::with(context, coarse)], &Shadow::requirements());
}

#[test]
fn every_legal_order_gives_the_same_bits() {
    let orders = shuffle(Shadowed::new, &Shadow::requirements(), 0..3);
    println!("{orders} orders gave the same bits");
    assert!(orders > 1);
}
