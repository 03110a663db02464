//! The kernel of texels against cube maps and closed forms in f64.

use airglow_math::statistics::relative_l2;
use airglow_radiance::gpu::kernels::{TEXEL_BINDINGS, TexelConstants};
use airglow_radiance::gpu::{Batch, EmitterTriangle, LightShape, TexelSettings, Texels};
use airglow_radiance::reference::{Cube, triangles};
use airglow_radiance::{Incident, Triangle};
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;
use glam::DVec3;

use crate::scenes::{block, blocks, points};
use crate::with_bench;

fn sampled(settings: TexelSettings, triangles: &[Triangle], points: &[DVec3]) -> Vec<Incident> {
    with_bench(&Texels::requirements(), |bench| {
        let texels = Texels::new(bench.context, settings).unwrap();
        bench.texels(&texels, triangles, points).unwrap()
    })
}

/// All numbers of a sample, in four groups.
fn numbers(incident: &Incident) -> [(&'static str, Vec<f64>); 4] {
    let gradients = incident.gradients.iter().flat_map(|m| m.to_cols_array());
    [
        ("light", incident.coefficients.iter().flat_map(|l| l.to_array()).collect()),
        ("extent", vec![incident.solid_angle, incident.nearness]),
        ("slope", incident.slope.to_array().to_vec()),
        ("gradients", gradients.collect()),
    ]
}

/// Prints and holds the relative errors of each group over all samples.
#[track_caller]
fn check(what: &str, found: &[Incident], truth: &[Incident], bound: f64) {
    for group in 0..4 {
        let all = |samples: &[Incident]| -> Vec<f64> {
            samples.iter().flat_map(|sample| numbers(sample)[group].1.clone()).collect()
        };
        let (found, truth) = (all(found), all(truth));
        if truth.is_empty() {
            continue;
        }
        let error = relative_l2(&found, &truth).unwrap();
        let name = numbers(&Incident::dark(1).unwrap())[group].0;
        println!("{what}, {name}: {error:.1e} (first {:.6e}, in f64 {:.6e})", found[0], truth[0]);
        assert!(error < bound, "{what}, {name}: {error:e}");
    }
}

#[test]
fn texels_are_those_of_the_reference() {
    let (emitters, points) = (blocks(), points(20));
    for (order, gradients) in [(3, false), (4, true), (5, false), (6, true)] {
        let shape = LightShape { order, gradients };
        let cube = Cube::new(order, 24).unwrap();
        let cube = if gradients { cube.with_gradients() } else { cube };
        let truth: Vec<_> = points.iter().map(|point| cube.sample(*point, &emitters).unwrap()).collect();
        let found = sampled(TexelSettings { shape, size: 24, rays: 1 }, &emitters, &points);
        check(&format!("order {order}"), &found, &truth, 2e-4);
    }
}

/// More rays take a coarse cube to the closed form of a square that nothing hides.
#[test]
fn rays_tend_to_the_closed_form() {
    let emitters = &block(DVec3::new(0.3, 0.2, -1.1), 0.25, DVec3::new(1.0, 2.0, 3.0))[..2];
    let shape = LightShape { order: 4, gradients: false };
    let points = points(12);
    let truth: Vec<_> = points.iter().map(|point| triangles(4, *point, emitters).unwrap()).collect();
    for (size, rays, bound) in [(8, 1, 0.6), (8, 2, 0.1), (8, 4, 0.05), (32, 4, 0.01)] {
        let found = sampled(TexelSettings { shape, size, rays }, emitters, &points);
        check(&format!("{size} texels, {rays} rays"), &found, &truth, bound);
    }
}

#[test]
fn host_structs_are_as_the_compiler_laid_them_out() {
    for (name, bindings) in [("ORDER4.RAYS4", 5), ("GRADIENTS.ORDER6.RAYS1", 6)] {
        let module = Module::load(&format!("radiance/texels.{name}.spv")).unwrap();
        module.assert_bindings(&TEXEL_BINDINGS[..bindings]);
        let constants = host_layout!(TexelConstants { triangle_count, size });
        module.push_constants.as_ref().unwrap().assert_matches(&constants);
        let block = |binding: usize| module.bindings[binding].block.as_ref().unwrap();
        let batch = block(0).members[0].block.as_ref().unwrap();
        batch.assert_matches(&host_layout!(Batch { count, height, depth, first }));
        let triangle = block(2).members[0].block.as_ref().unwrap();
        triangle.assert_matches(&host_layout!(EmitterTriangle { corners }));
    }
}
