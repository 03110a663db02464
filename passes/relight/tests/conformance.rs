//! This room inside a host with a device of its own, by both roads; on lesser devices; with narrow vectors.

#[path = "gpu/host/mod.rs"]
mod host;

use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageUsageFlags};
use airglow_gpu::requirements::Limit;
use airglow_gpu::{Buffer, Context, DeviceMask, Label, Location, Options, Recorder, Requirements};
use airglow_graph::{Access, BufferDesc, ImageDesc, ResourceDesc};
use airglow_relight::{
    Bindings, Environment, Frame, Instance, Light, MeshId, Method, Need, Prepared, Relight, Resource,
    Settings,
};
use airglow_tests::compare::assert_close;
use airglow_tests::conformance::{
    Declared, Given, HostResource, Refusal, Room, change, conform, fail_each, shuffle, stage,
};
use airglow_tests::narrow;
use glam::DQuat;
use host::Numbers;

const WIDTH: u32 = 32;
const HEIGHT: u32 = 16;
/// Chunks of a small range do not divide it.
const VERTICES: u32 = 1500;

/// Relighting between a host's sky and a host's vertex buffer.
struct Relit {
    relight: Relight,
    mesh: MeshId,
    prepared: Option<(Prepared, Bindings, Vec<Buffer>)>,
}

impl Relit {
    fn new(context: &Context, settings: Settings) -> Result<Self, Refusal> {
        let mut relight = Relight::new(context, settings)?;
        let vectors = Numbers::new(3).values(VERTICES as usize * settings.coefficients());
        let mesh = relight.add_mesh(context, "mesh", VERTICES, Some(&vectors))?;
        Ok(Self { relight, mesh, prepared: None })
    }

    fn frame<B, I>(&self, image: I, target: B) -> Frame<B, I> {
        let rotation = DQuat::from_rotation_y(0.7);
        let environment = Environment { image, width: WIDTH, height: HEIGHT, revision: 1, rotation };
        Frame {
            light: Light::Environment(environment),
            instances: vec![Instance::new(self.mesh)],
            target: Some(target),
        }
    }
}

impl Room for Relit {
    fn requirements(&self) -> Requirements {
        Relight::requirements(self.relight.settings())
    }

    fn resources(&self) -> Vec<HostResource> {
        let usage = ImageUsageFlags::SAMPLED;
        let sky = ImageDesc { usage, ..ImageDesc::new_2d(WIDTH, HEIGHT, Format::R32G32B32A32_SFLOAT) };
        let texels = Numbers::new(4).rgb((WIDTH * HEIGHT) as usize);
        let texels = texels.into_iter().flat_map(|[r, g, b]| [r + 1.0, g + 1.0, b + 1.0, 1.0]);
        let texels = texels.flat_map(f32::to_le_bytes).collect();
        let (usage, bytes) =
            (BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::VERTEX_BUFFER, 16 * u64::from(VERTICES));
        let colours = [Access::ComputeStorageReadWrite, Access::VertexBuffer];
        vec![
            HostResource::image("sky", sky, texels, [Access::FragmentSampled; 2]),
            HostResource::results("vertex colours", bytes, usage, colours),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let frame = self.frame(to.image(0)?, to.buffer(1)?);
        self.relight.add(to.context, to.graph, to.imports, &frame)?;
        Ok(())
    }

    fn accesses(&mut self, context: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let frame = self.frame((), ());
        let prepared = self.relight.prepare(context, &frame)?;
        let (mut bindings, mut scratch) = (Bindings::default(), Vec::new());
        for (resource, need) in &prepared.needs {
            let label = Label::new("host", "scratch");
            match need {
                Need::Scratch(ResourceDesc::Buffer(desc)) => {
                    let usage =
                        desc.usage | BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::UNIFORM_BUFFER;
                    let desc = BufferDesc { usage, ..*desc };
                    let buffer = context.create_buffer(label, &desc, Location::Device)?;
                    bindings.buffers.insert(*resource, (&buffer).into());
                    scratch.push(buffer);
                }
                Need::Scratch(ResourceDesc::Image(desc)) => {
                    let usage = ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC;
                    let image = context.create_image(label, &ImageDesc { usage, ..*desc })?;
                    bindings.images.insert(*resource, image.full_view()?);
                }
                Need::Ours { .. } | Need::Host => {}
            }
        }
        let accesses = prepared.accesses();
        let ends = |wanted| {
            let (_, all) = accesses.iter().find(|(resource, _)| *resource == wanted)?;
            Some((*all.first()?, *all.last()?))
        };
        let ends = vec![ends(Resource::Environment), ends(Resource::Results)];
        self.prepared = Some((prepared, bindings, scratch));
        Ok(ends)
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let (prepared, bindings, _) = self.prepared.as_mut().ok_or("not prepared")?;
        bindings.images.insert(Resource::Environment, host[0].image()?.full_view()?);
        bindings.buffers.insert(Resource::Results, host[1].buffer()?.into());
        Ok(prepared.record(recorder, bindings)?)
    }
}

/// The colours by both roads, as values.
fn colours(settings: Settings, options: &Options) -> Vec<f32> {
    let make = |context: &Context| Relit::new(context, settings).expect("the settings are sound");
    let outputs = conform(make, &Relight::requirements(&settings), options);
    values(&outputs[0])
}

fn values(bytes: &[u8]) -> Vec<f32> {
    let value = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    bytes.chunks_exact(4).map(value).collect()
}

#[test]
fn a_host_with_its_own_device_gets_the_same_bits_by_both_roads() {
    let [by_compute, by_fragment] = [Method::Compute, Method::Fragment]
        .map(|method| colours(Settings { method, ..Settings::default() }, &Options::default()));
    assert!(by_compute.chunks_exact(4).all(|colour| colour[3] == 1.0), "every vertex was written");
    assert_eq!(by_compute, by_fragment);
}

#[test]
fn a_lesser_device_gets_the_same_bits() {
    let settings = Settings::default();
    let whole = colours(settings, &Options::default());
    // 64 bytes a vertex: three chunks, each within the range, which the recorder checks at every binding.
    let limits = vec![(Limit::StorageBufferRange, 32 << 10)];
    let mask = DeviceMask { limits, without_optional_features: true };
    assert_eq!(colours(settings, &Options { mask, ..Options::default() }), whole);
}

#[test]
fn a_device_whose_memory_the_cpu_cannot_map_gets_the_same_bits() {
    let settings = Settings::default();
    let staged = stage(|context| Relit::new(context, settings), &Relight::requirements(&settings));
    assert_eq!(values(&staged[0]), colours(settings, &Options::default()));
}

#[test]
fn narrow_vectors_stay_within_rounding() {
    let values = colours(Settings::default(), &Options::default());
    if let Some(narrow) = narrow::again("narrow_vectors_stay_within_rounding", &values) {
        assert_close("subgroups of 4", &narrow, &values, 1e-5, 1e-5);
    }
}

#[test]
fn every_call_that_fails_is_told_and_leaves_nothing() {
    for method in [Method::Compute, Method::Fragment] {
        // The smallest kernels: what is not a pipeline is made once for each call.
        let settings = Settings { method, order: 2, ..Settings::default() };
        let calls = fail_each(|context| Relit::new(context, settings), &Relight::requirements(&settings));
        println!("{method:?}: {calls} calls failed in turn");
        assert!(calls > 20, "only {calls} calls could fail");
    }
}

#[test]
fn quality_changes_while_frames_are_on_the_device() {
    let (fine, coarse) =
        (Settings::default(), Settings { order: 3, method: Method::Fragment, ..Settings::default() });
    let requirements = Relight::requirements(&fine).and(&Relight::requirements(&coarse));
    change(&[&|context| Relit::new(context, fine), &|context| Relit::new(context, coarse)], &requirements);
}

#[test]
fn every_legal_order_gives_the_same_bits() {
    for method in [Method::Compute, Method::Fragment] {
        let settings = Settings { method, ..Settings::default() };
        let make = |context: &Context| Relit::new(context, settings);
        let orders = shuffle(make, &Relight::requirements(&settings), 0..3);
        println!("{method:?}: {orders} orders gave the same bits");
        assert!(orders > 1);
    }
}
