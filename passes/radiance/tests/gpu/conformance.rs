//! This room inside a host with a device of its own, by both roads.

use std::sync::LazyLock;

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::requirements::Limit;
use airglow_gpu::{Context, DeviceMask, Options, Permutations, Recorder, Requirements};
use airglow_graph::Access;
use airglow_radiance::{
    Bindings, Envelope, Lights, Part, PassSettings, Pipelines, Prepared, Radiance, Receiver, Resource,
    Settings,
};
use airglow_tests::compare::assert_close;
use airglow_tests::conformance::{
    Declared, Given, HostResource, MakePrepared, Outputs, Refusal, Room, change, conform, fail_each, prepare,
    shuffle,
};
use airglow_tests::narrow;
use glam::DMat3;

use crate::receivers::Mesh;
use crate::scenes::blocks;

const SETTINGS: fn() -> PassSettings = || {
    let refinement = Settings { limit: 40, ..Settings::default() };
    PassSettings { order: 3, gradients: false, face: 8, rays: 1, refinement, ..PassSettings::default() }
};
const NAMES: [&str; 2] = ["light of the first part", "light of the second part"];

/// The light of two instances, which a host keeps.
struct Lit {
    radiance: Radiance,
    receiver: Receiver,
    sizes: Vec<u64>,
    prepared: Option<Prepared>,
}

impl Lit {
    fn new(context: &Context) -> Result<Self, Refusal> {
        Self::with(context, SETTINGS())
    }

    fn with(context: &Context, settings: PassSettings) -> Result<Self, Refusal> {
        Self::of(context, Radiance::new(context, settings)?)
    }

    fn of(context: &Context, radiance: Radiance) -> Result<Self, Refusal> {
        let settings = *radiance.settings();
        static MESH: LazyLock<Mesh> = LazyLock::new(|| Mesh::ball(12, 3, false));
        let mesh = &*MESH;
        let parts = [
            Part { vertices: 0..70, turn: None },
            Part { vertices: 70..144, turn: Some(DMat3::from_rotation_x(0.4)) },
        ];
        let receiver = Receiver::new(context, settings, &mesh.tree, &mesh.positions, &parts)?;
        let sizes = parts.iter().map(|part| settings.light_bytes() * part.vertices.len() as u64);
        Ok(Self { radiance, receiver, sizes: sizes.collect(), prepared: None })
    }
}

impl Room for Lit {
    fn requirements(&self) -> Requirements {
        Radiance::requirements(self.radiance.settings())
    }

    fn resources(&self) -> Vec<HostResource> {
        let ends = [Access::ComputeStorageWrite, Access::ComputeStorageRead];
        let results =
            |(name, size)| HostResource::results(name, size, BufferUsageFlags::STORAGE_BUFFER, ends);
        NAMES.into_iter().zip(self.sizes.iter().copied()).map(results).collect()
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let lights = Lights { emitters: &blocks(), ..Lights::default() };
        let lit = self.radiance.add(to.graph, to.imports, &self.receiver, &lights)?;
        (0..).zip(lit.light).try_for_each(|(place, light)| to.keep(light, place))
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let prepared =
            self.radiance.prepare(&self.receiver, &Lights { emitters: &blocks(), ..Lights::default() })?;
        let accesses = prepared.accesses();
        let ends = |part| {
            let (_, all) = accesses.iter().find(|(resource, _)| *resource == Resource::VertexLight(part))?;
            Some((*all.first()?, *all.last()?))
        };
        let ends = (0..2).map(ends).collect();
        self.prepared = Some(prepared);
        Ok(ends)
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let given =
            |(part, given): (u32, &Given)| -> Result<_, Refusal> { Ok((part, given.buffer()?.into())) };
        let bindings = (0..).zip(host).map(given).collect::<Result<Bindings, Refusal>>()?;
        let prepared = self.prepared.as_ref().ok_or("not prepared")?;
        Ok(prepared.record(recorder, &bindings)?)
    }
}

fn outputs(options: &Options) -> Outputs {
    conform(|context| Lit::new(context).unwrap(), &Radiance::requirements(&SETTINGS()), options)
}

/// The light, as values.
fn values(outputs: &Outputs) -> Vec<f32> {
    let value = |x: &[u8]| f32::from_le_bytes([x[0], x[1], x[2], x[3]]);
    outputs.iter().flat_map(|bytes| bytes.chunks_exact(4).map(value)).collect()
}

#[test]
fn a_host_with_its_own_device_gets_the_same_bits_by_both_roads_and_on_a_lesser_one() {
    let whole = outputs(&Options::default());
    assert!(whole.len() == 2 && whole.chunks(1).all(|part| values(&part.to_vec()).iter().any(|x| *x > 0.1)));
    // 108 bytes a vertex: parts in chunks of 64; the tree fits just so.
    let limits = vec![(Limit::StorageBufferRange, 9 << 10)];
    let mask = DeviceMask { limits, without_optional_features: true };
    assert!(outputs(&Options { mask, breadcrumbs: true, ..Options::default() }) == whole);
}

#[test]
fn narrow_vectors_stay_within_rounding() {
    let values = values(&outputs(&Options::default()));
    let Some(narrow) = narrow::again("conformance::narrow_vectors_stay_within_rounding", &values) else {
        return;
    };
    let wide: Vec<f64> = values.iter().copied().map(f64::from).collect();
    assert_close("subgroups of 4", &narrow, &wide, 1e-5, 1e-5);
}

#[test]
fn every_call_that_fails_is_told_and_leaves_nothing() {
    // The fewest kernels: they are made once for each call.
    let small = PassSettings { closed_forms: false, keep: 0.0, ..SETTINGS() };
    let calls = fail_each(|context| Lit::with(context, small), &Radiance::requirements(&small));
    println!("{calls} calls failed in turn");
    assert!(calls > 20, "only {calls} calls could fail");
}

#[test]
fn nothing_within_the_envelope_makes_a_pipeline() {
    let envelope = || Envelope {
        orders: vec![3, 4],
        gradients: vec![false, true],
        rays: vec![1, 2],
        closed_forms: true,
    };
    let make = |settings: PassSettings| {
        let settings = PassSettings { refinement: SETTINGS().refinement, ..settings };
        move |context: &Context, pipelines: &Pipelines| {
            Lit::of(context, Radiance::with_pipelines(context, settings, pipelines)?)
        }
    };
    let plain =
        |settings: PassSettings| [settings, PassSettings { closed_forms: false, face: 16, ..settings }];
    // Each of the first two with less beside it; the others are of the same kernels.
    let mut all = envelope().settings();
    all.splice(0..2, [plain(all[0]), plain(all[1])].concat());
    let makes: Vec<_> = all.into_iter().map(make).collect();
    let makes: Vec<MakePrepared<'_, _, _>> = makes.iter().map(|make| make as _).collect();
    let count = envelope().pipeline_count().unwrap();
    let requirements =
        Radiance::requirements(&PassSettings::default()).and(&Radiance::requirements(&SETTINGS()));
    let made = prepare(&requirements, |context| Pipelines::prepare(context, envelope()), count, &makes);
    println!("{made} pipelines for {} settings", makes.len());
    // Refining and keeping; by order turning; by order and gradients two of texels, one in closed form, one of vertices.
    assert_eq!((made, makes.len()), (2 + 2 + 4 * 4, 10));
    let outside = envelope().check(&PassSettings { rays: 4, ..SETTINGS() }).unwrap_err().to_string();
    assert!(outside.contains("4 rays") && outside.contains("Envelope::rays"), "{outside}");
}

#[test]
fn quality_changes_while_frames_are_on_the_device() {
    let fine = PassSettings { gradients: true, rays: 2, ..SETTINGS() };
    let requirements = Radiance::requirements(&SETTINGS()).and(&Radiance::requirements(&fine));
    change(&[&Lit::new, &|context| Lit::with(context, fine)], &requirements);
}

#[test]
fn every_legal_order_gives_the_same_bits() {
    let orders = shuffle(Lit::new, &Radiance::requirements(&SETTINGS()), 0..3);
    println!("{orders} orders gave the same bits");
    assert!(orders > 1);
}
