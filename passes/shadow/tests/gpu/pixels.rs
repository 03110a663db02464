//! The pass per pixel: against f64, and the same bits by both roads.

use std::sync::{Arc, Mutex};

use airglow_gpu::ash::vk::{Format, ImageUsageFlags};
use airglow_gpu::{Execution, GpuError, Image, Imports, Label, Location, Readback, Recorder};
use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, PassKind, State};
use airglow_shadow::reference::{Reference, caps};
use airglow_shadow::{
    Blockers, Disc, Exponential, PixelLight, PixelShadow, PixelViews, Products, Settings, Sphere,
};
use airglow_tests::device::{Fixture, fixture_with};
use glam::{DMat4, DVec3};

const SIDE: u32 = 20;
/// All above the ground.
const SPHERES: [Sphere; 2] = [
    Sphere { center: DVec3::new(0.5, 1.0, 0.2), radius: 0.6 },
    Sphere { center: DVec3::new(-1.0, 1.4, -0.8), radius: 0.9 },
];

fn light(order: usize) -> PixelLight {
    let mut light = vec![[0.0; 3]; order * order];
    light[0] = [2.0, 1.5, 1.0];
    light[1] = [-0.5, -0.4, -0.6];
    light[6] = [0.1, -0.2, 0.3];
    let direction = DVec3::new(0.3, 0.9, 0.2).normalize();
    let disc = Disc { direction, angular_radius: 0.05, irradiance: [3.0, 2.5, 2.0] };
    PixelLight { products: Products::new(order, &light).unwrap(), disc: Some(disc) }
}

/// A square of ground without its first pixel, and its normals.
fn texels() -> [Vec<[f32; 4]>; 2] {
    let place =
        |at: u32| [(at % SIDE) as f32 * 0.2 - 2.0, 0.0, (at / SIDE) as f32 * 0.2 - 2.0, at.min(1) as f32];
    [(0..SIDE * SIDE).map(place).collect(), vec![[0.0, 2.0, 0.0, 0.0]; (SIDE * SIDE) as usize]]
}

fn image(fixture: &Fixture, texels: &[[f32; 4]]) -> Image {
    let context = fixture.context();
    let usage = ImageUsageFlags::TRANSFER_DST | ImageUsageFlags::SAMPLED;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIDE, SIDE, Format::R32G32B32A32_SFLOAT) };
    let image = context.create_image(Label::new("host", "surface"), &desc).unwrap();
    let desc = BufferDesc { size: size_of_val(texels) as u64, usage: Access::TransferSource.buffer_usage() };
    let staging = context.create_buffer(Label::new("host", "texels"), &desc, Location::Upload).unwrap();
    staging.write(0, texels).unwrap();
    let record = |recorder: &mut Recorder<'_>| {
        recorder.transition(&image, State::UNDEFINED, Access::TransferDestination)?;
        recorder.copy_buffer_to_image(&staging, &image.full_view()?)?;
        recorder.transition(&image, Access::TransferDestination, Access::ComputeSampled)
    };
    fixture.device().run(context, record).unwrap();
    image
}

fn without_graph(
    fixture: &Fixture,
    shadow: &PixelShadow,
    blockers: &Blockers,
    light: &PixelLight,
) -> Vec<[f32; 4]> {
    let context = fixture.context();
    let [positions, normals] = texels().map(|texels| image(fixture, &texels));
    let usage = ImageUsageFlags::STORAGE | ImageUsageFlags::TRANSFER_SRC;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIDE, SIDE, PixelShadow::FORMAT) };
    let picture = context.create_image(Label::new("host", "picture"), &desc).unwrap();
    let views = PixelViews {
        positions: positions.full_view().unwrap(),
        normals: normals.full_view().unwrap(),
        picture: picture.full_view().unwrap(),
    };
    let mut copy = None;
    let record = |recorder: &mut Recorder<'_>| {
        recorder.transition(&picture, State::UNDEFINED, Access::ComputeStorageWrite)?;
        shadow.record(recorder, [SIDE, SIDE], blockers, light, &views)?;
        recorder.transition(&picture, Access::ComputeStorageWrite, Access::TransferSource)?;
        copy = Some(recorder.read_back_image(&views.picture)?);
        Ok(())
    };
    fixture.device().run(context, record).unwrap();
    copy.unwrap().texels().unwrap()
}

fn with_graph(
    fixture: &Fixture,
    shadow: &PixelShadow,
    blockers: &Blockers,
    light: &PixelLight,
) -> Vec<[f32; 4]> {
    let context = fixture.context();
    let images = texels().map(|texels| image(fixture, &texels));
    let mut graph = Graph::new();
    let mut imports = Imports::new();
    let handles = [0, 1].map(|at| {
        let entry = Access::ComputeSampled;
        let handle = graph.import_image(&format!("surface {at}"), *images[at].desc(), entry, entry);
        imports.image(&handle, &images[at]);
        handle
    });
    let picture = shadow.add(&mut graph, [SIDE, SIDE], blockers, light, handles).unwrap();
    let slot: Arc<Mutex<Option<Readback>>> = Arc::default();
    let filled = Arc::clone(&slot);
    let mut read = graph.pass("read back", PassKind::Transfer);
    read.read(&picture, Access::TransferSource).side_effect();
    read.record(Box::new(move |recorder, resources| {
        *filled.lock().unwrap() = Some(recorder.read_back_image(&resources.view(&picture)?)?);
        Ok(())
    }));
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    let mut execution = Execution::prepare(context, plan).unwrap();
    let record = |recorder: &mut Recorder<'_>| -> Result<(), GpuError> {
        // SAFETY: a recording command buffer of this frame; the imports are in their entry state.
        unsafe { execution.record(context, recorder.command_buffer(), &imports, None) }.map(|_| ())
    };
    fixture.device().run(context, record).unwrap();
    slot.lock().unwrap().take().unwrap().texels().unwrap()
}

#[test]
fn pixels_agree_with_the_reference_by_both_roads() {
    let fixture = fixture_with(&PixelShadow::requirements());
    for order in [3, 6] {
        let settings = Settings { order, reach: 0.0, clamp: false, ..Default::default() };
        let shadow = PixelShadow::new(fixture.context(), settings).unwrap();
        let (blockers, light) = (Blockers::default(), light(order));
        blockers.set(&SPHERES, DMat4::IDENTITY).unwrap();
        let found = without_graph(&fixture, &shadow, &blockers, &light);
        assert_eq!(found, with_graph(&fixture, &shadow, &blockers, &light), "order {order}");
        assert_eq!(found[0], [0.0; 4], "no surface");
        let (reference, disc) = (Reference::new(order).unwrap(), light.disc.unwrap());
        for (at, (place, found)) in texels()[0].iter().zip(&found).enumerate().skip(1) {
            let caps = caps(&SPHERES, DVec3::new(place[0].into(), place[1].into(), place[2].into()));
            let visibility = reference.visibility(Exponential::Adaptive, &caps).unwrap();
            let lit = light.products.lit(DVec3::Y, &visibility).unwrap();
            let disc = disc.lit(DVec3::Y, disc.seen(&caps));
            for c in 0..3 {
                let truth = lit[c].max(0.0) + disc[c];
                let error = (f64::from(found[c]) - truth).abs();
                assert!(error < 6e-3, "order {order}, pixel {at}: {found:?} and {lit:?} + {disc:?}");
            }
        }
    }
    let other = Settings { exponential: Exponential::OptimalLinear, ..Default::default() };
    assert!(PixelShadow::new(fixture.context(), other).is_err());
}
