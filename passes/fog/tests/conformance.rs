//! This room inside a host with a device of its own, by both roads; and what Rust states is what the shaders have.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail the test they are called from")]

use airglow_fog::{
    ACCESSES, BINDINGS, Background, Bindings, Camera, Envelope, Fog, Frame, InputHealth, Light, Lobe,
    LobeTables, Medium, Pass, PhaseKind, Pipelines, Prepared, Preset, Settings, View,
};
use airglow_gpu::ash::vk::{Format, ImageUsageFlags, QUEUE_FAMILY_EXTERNAL};
use airglow_gpu::{
    AdoptInfo, Context, DeviceMask, Execution, GpuError, Options, Permutations, Record, Recorder,
    Requirements,
};
use airglow_graph::{Access, Graph, ImageDesc};
use airglow_math::World;
use airglow_tests::compare::assert_close;
use airglow_tests::conformance::{
    Declared, Elsewhere, Given, HostResource, MakePrepared, Refusal, Room, change, conform, fail_each,
    prepare, shuffle,
};
use airglow_tests::device::open;
use airglow_tests::narrow;
use airglow_tests::reflect::Module;
use glam::DVec3;

const SIZE: [u32; 2] = [40, 24];
const PIXELS: usize = 40 * 24;

fn view() -> View {
    let camera = Camera {
        position: DVec3::new(0.0, 1.7, 8.0),
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: [-0.8, 0.8, -0.45, 0.45],
    };
    let lamp = Light { radius: 0.1, ..Light::point(DVec3::new(1.0, 3.0, 0.0), [40.0, 30.0, 15.0]) };
    View {
        world: World::default(),
        camera,
        medium: Medium::with_visibility(60.0),
        lights: vec![lamp],
        environment: None,
    }
}

/// Fog between a host's draw and a host's picture.
struct Fogged {
    fog: Fog,
    pass: Option<Pass>,
    size: [u32; 2],
}

fn image([width, height]: [u32; 2], format: Format, usage: ImageUsageFlags) -> ImageDesc {
    ImageDesc { usage, ..ImageDesc::new_2d(width, height, format) }
}

impl Room for Fogged {
    fn requirements(&self) -> Requirements {
        Fog::requirements(self.fog.settings())
    }

    fn resources(&self) -> Vec<HostResource> {
        let hdr = Format::R32G32B32A32_SFLOAT;
        let pixels = (self.size[0] * self.size[1]) as usize;
        let surface: Vec<u8> = (0..4 * pixels).flat_map(|i| (0.01 * i as f32).to_le_bytes()).collect();
        // The upper rows show no surface.
        let depth = |pixel: usize| {
            if pixel < pixels / 3 { 1.0_f32 } else { 0.9 + 0.09 * pixel as f32 / pixels as f32 }
        };
        let depth: Vec<u8> = (0..pixels).flat_map(|pixel| depth(pixel).to_le_bytes()).collect();
        let written = ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC;
        let read = ImageUsageFlags::SAMPLED | ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        let image = |format, usage| image(self.size, format, usage);
        let format = self.fog.settings().format;
        let (surface_desc, picture) = (image(hdr, ImageUsageFlags::SAMPLED), image(format, written));
        let bytes = picture.bytes().unwrap_or_default() as usize;
        let drawn = [Access::ColorAttachmentWrite, Access::TransferSource];
        let read_depth = [Access::FragmentSampledDepth; 2];
        vec![
            HostResource::image("surface", surface_desc, surface, [Access::FragmentSampled; 2]),
            HostResource::image("depth", image(Format::D32_SFLOAT, read), depth, read_depth),
            HostResource::image("picture", picture, vec![0xff; bytes], drawn),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let (surface, depth, target) = (to.image(0)?, to.image(1)?, Some(to.image(2)?));
        self.fog.add(to.graph, &Frame { size: self.size, surface, depth, target, view: view() })?;
        Ok(())
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let frame = Frame { size: self.size, surface: (), depth: (), target: Some(()), view: view() };
        let Prepared::Pass(pass) = self.fog.prepare(&frame)? else { return Err("left out".into()) };
        self.pass = Some(pass);
        Ok(ACCESSES.map(|(_, access)| Some((access, access))).to_vec())
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let pass = self.pass.as_ref().ok_or("not prepared")?;
        let view = |place: usize| host[place].image().map(|image| image.full_view());
        let bindings = Bindings { surface: view(0)??, depth: view(1)??, target: view(2)?? };
        Ok(pass.record(recorder, &bindings)?)
    }
}

impl Fogged {
    fn new(context: &Context) -> Result<Self, Refusal> {
        Ok(Self { fog: Fog::new(context, Settings::default())?, pass: None, size: SIZE })
    }

    /// Another size and another preset.
    fn resized(context: &Context) -> Result<Self, Refusal> {
        let settings = Settings { preset: Preset::Reference, ..Settings::default() };
        Ok(Self { fog: Fog::new(context, settings)?, pass: None, size: [72, 10] })
    }
}

/// The picture by both roads, as values.
fn picture(options: &Options) -> Vec<f32> {
    let make = |context: &Context| Fogged::new(context).unwrap();
    let outputs = conform(make, &Fog::requirements(&Settings::default()), options);
    values(&outputs[0])
}

fn values(bytes: &[u8]) -> Vec<f32> {
    let value = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    bytes.chunks_exact(4).map(value).collect()
}

#[test]
fn a_host_with_its_own_device_gets_the_same_bits_by_both_roads_and_on_a_lesser_one() {
    let whole = picture(&Options::default());
    assert_eq!(whole.len(), 4 * PIXELS);
    assert!(
        whole.chunks_exact(4).all(|texel| texel[..3].iter().all(|value| value.is_finite() && *value > 0.0))
    );
    // No surface, no light of it: the airlight is warm, the surface there was not.
    assert!(whole[0] > whole[2], "{:?}", &whole[..4]);
    let mask = DeviceMask { without_optional_features: true, ..DeviceMask::default() };
    assert!(picture(&Options { mask, breadcrumbs: true, ..Options::default() }) == whole);
}

#[test]
fn images_that_another_process_has_are_taken_and_given_back() {
    let family = QUEUE_FAMILY_EXTERNAL;
    let make = |context: &Context| Elsewhere { room: Fogged::new(context).unwrap(), family };
    let outputs = conform(make, &Fog::requirements(&Settings::default()), &Options::default());
    assert!(values(&outputs[0]) == picture(&Options::default()));
}

#[test]
fn narrow_vectors_stay_within_rounding() {
    let values = picture(&Options::default());
    if let Some(narrow) = narrow::again("narrow_vectors_stay_within_rounding", &values) {
        assert_close("subgroups of 4", &narrow, &values, 1e-6, 1e-5);
    }
}

#[test]
fn every_call_that_fails_is_told_and_leaves_nothing() {
    let calls = fail_each(Fogged::new, &Fog::requirements(&Settings::default()));
    println!("{calls} calls failed in turn");
    assert!(calls > 20, "only {calls} calls could fail");
}

#[test]
fn nothing_within_the_envelope_makes_a_pipeline() {
    let half = Format::R16G16B16A16_SFLOAT;
    let envelope = || Envelope {
        formats: vec![Settings::default().format, half],
        presets: vec![Preset::Default],
        phases: vec![PhaseKind::Isotropic, PhaseKind::HenyeyGreenstein],
        height: vec![false, true],
        environment: vec![false],
        backgrounds: true,
        lobes: true,
        health: true,
    };
    let make = |settings: Settings| {
        move |context: &Context, pipelines: &Pipelines| {
            Background::with_pipelines(context, [16, 8], settings.format, pipelines)?;
            LobeTables::with_pipelines(context, settings.preset, &[Lobe::Lambert], pipelines)?;
            InputHealth::with_pipelines(context, pipelines)?;
            Ok(Fogged { fog: Fog::with_pipelines(settings, pipelines)?, pass: None, size: SIZE })
        }
    };
    let makes: Vec<_> = envelope().settings().into_iter().map(make).collect();
    let makes: Vec<MakePrepared<'_, _, _>> = makes.iter().map(|make| make as _).collect();
    let count = envelope().pipeline_count().unwrap();
    let all = envelope().settings().iter().fold(Background::requirements(half), |all, settings| {
        all.and(&Fog::requirements(settings)).and(&InputHealth::requirements())
    });
    let made = prepare(&all, |context| Pipelines::prepare(context, envelope()), count, &makes);
    println!("{made} pipelines for {} settings", makes.len());
    // By format and height: dark, and two kinds of lights by phase; two of backgrounds, their parts, tables, health.
    assert_eq!((made, makes.len()), (4 * (1 + 2 * 2) + 2 + 3, 8));
    let outside = envelope().check(&Settings { environment: true, ..Settings::default() }).unwrap_err();
    assert!(outside.to_string().contains("Envelope::environment"), "{outside}");
}

#[test]
fn every_legal_order_gives_the_same_bits() {
    let orders = shuffle(Fogged::new, &Fog::requirements(&Settings::default()), 0..3);
    println!("{orders} orders gave the same bits");
    assert!(orders <= 2, "one pass each");
}

#[test]
fn size_and_quality_change_while_frames_are_on_the_device() {
    change(&[&Fogged::new, &Fogged::resized], &Fog::requirements(&Settings::default()));
}

#[test]
fn a_refused_plan_leaves_room_for_the_next_settings() {
    let settings = Settings::default();
    let device = open(&Fog::requirements(&settings));
    let mut extensions = Vec::new();
    // The picture takes 15,360 bytes; a pixel of half floats takes half.
    let options = Options { memory_budget: Some(12_000), ..Options::default() };
    let info = AdoptInfo { options, ..device.adopt_info(&mut extensions, 1) };
    // SAFETY: nothing is submitted; everything is dropped before the device.
    let context = &unsafe { Context::adopt(info) }.unwrap();
    let prepare = |settings: Settings| {
        let mut graph = Graph::<Record>::new();
        let [read, read_depth] = [Access::FragmentSampled, Access::FragmentSampledDepth];
        let desc = |format| image(SIZE, format, ImageUsageFlags::SAMPLED);
        let surface = graph.import_image("surface", desc(Format::R32G32B32A32_SFLOAT), read, read);
        let depth = graph.import_image("depth", desc(Format::D32_SFLOAT), read_depth, read_depth);
        let frame = Frame { size: SIZE, surface, depth, target: None, view: view() };
        let fogged = Fog::new(context, settings).unwrap().add(&mut graph, &frame).unwrap();
        graph.export(fogged.colour, Access::FragmentSampled);
        Execution::prepare(context, graph.compile(&context.graph_limits()).unwrap()).map(drop)
    };
    let refused = prepare(settings).unwrap_err();
    let GpuError::Budget { size, held, budget, .. } = refused else { panic!("{refused}") };
    assert_eq!(Some(size), settings.picture_bytes(SIZE), "{refused}");
    let next = settings.next_that_fits(SIZE, budget - held).unwrap();
    assert_eq!(next.format, Format::R16G16B16A16_SFLOAT);
    prepare(next).unwrap();
    assert!(settings.next_that_fits(SIZE, 7000).is_none());
}

#[test]
fn what_rust_states_is_what_the_shaders_have() {
    for module in ["fog/airlight.FOG_TAPS6.isotropic.spv", "fog/airlight.FOG_HEIGHT.FOG_TAPS16.draine.spv"] {
        Module::load(module).unwrap().assert_bindings(&BINDINGS);
    }
    for module in
        ["fog/airlight_rows.FOG_TAPS6.isotropic.spv", "fog/airlight_rows_height.FOG_TAPS16.isotropic.spv"]
    {
        Module::load(module).unwrap().assert_bindings(&airglow_fog::bench::ROW_BINDINGS);
    }
}

#[test]
fn without_extinction_nothing_is_there() {
    let mut graph = Graph::<Record>::new();
    let desc = image(SIZE, Format::R32G32B32A32_SFLOAT, ImageUsageFlags::SAMPLED);
    let fixture = airglow_tests::device::fixture_with(&Fog::requirements(&Settings::default()));
    for phase in [PhaseKind::HenyeyGreenstein, PhaseKind::Isotropic, PhaseKind::Polynomial, PhaseKind::Draine]
    {
        for (height, preset) in [(false, Preset::Default), (true, Preset::Reference)] {
            let settings = Settings { phase, height, preset, ..Settings::default() };
            let fog = Fog::new(fixture.context(), settings).unwrap();
            let sampled = Access::FragmentSampled;
            let surface = graph.import_image("surface", desc, sampled, sampled);
            let depth = graph.import_image("depth", desc, sampled, sampled);
            let mut view = view();
            view.medium.extinction = [0.0; 3];
            let fogged =
                fog.add(&mut graph, &Frame { size: SIZE, surface, depth, target: None, view }).unwrap();
            assert_eq!(fogged.colour, surface);
            assert!(fogged.control.is_none());
        }
    }
    let plan = graph.compile(&fixture.context().graph_limits()).unwrap();
    assert!(plan.steps().is_empty() && plan.left_out()[0].why.contains("no extinction"), "{}", plan.text());
}

#[test]
fn a_light_out_of_reach_is_left_out_and_the_control_counts_it() {
    let fixture = airglow_tests::device::fixture_with(&Fog::requirements(&Settings::default()));
    let fog = Fog::new(fixture.context(), Settings::default()).unwrap();
    let mut view = view();
    let lamp = view.lights[0];
    view.lights.push(Light { position: DVec3::new(0.0, 2.0, 900.0), ..lamp });
    view.lights.push(Light { intensity: [0.0; 3], ..lamp });
    // Strong, but its range ends before the picture begins.
    view.lights.push(Light { position: DVec3::new(0.0, 2.0, 20.0), range: Some(10.0), ..lamp });
    let frame = Frame { size: SIZE, surface: (), depth: (), target: None, view: view.clone() };
    let Prepared::Pass(pass) = fog.prepare(&frame).unwrap() else { panic!("there is a medium") };
    assert_eq!((pass.control.counts().evaluated, pass.control.counts().left_out), (1, 3));
    view.lights.truncate(1);
    assert_eq!(pass.control.set(&view).unwrap().left_out, 0);
    view.medium.extinction = [0.0; 3];
    assert!(pass.control.set(&view).unwrap_err().to_string().contains("declare the frame anew"));
}
