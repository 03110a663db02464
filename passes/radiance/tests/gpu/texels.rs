//! The kernel of texels against cube maps and closed forms in f64.

use airglow_math::statistics::relative_l2;
use airglow_radiance::gpu::kernels::{TEXEL_BINDINGS, TexelConstants};
use airglow_radiance::gpu::{Batch, DeviceSurface, EmitterTriangle, LightShape, TexelSettings, Texels};
use airglow_radiance::reference::{Cube, sphere, triangles};
use airglow_radiance::{Incident, Lights, Sphere, Triangle};
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;
use glam::{DMat3, DVec3};

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
pub fn check(what: &str, found: &[Incident], truth: &[Incident], bound: f64) {
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
    for (order, gradients, size, rays) in
        [(3, false, 20, 1), (4, true, 16, 2), (5, false, 8, 4), (6, false, 32, 2)]
    {
        let shape = LightShape { order, gradients };
        let cube = Cube::new(order, size as usize).unwrap().with_rays(rays as usize).unwrap();
        let cube = if gradients { cube.with_gradients() } else { cube };
        let truth: Vec<_> = points.iter().map(|point| cube.sample(*point, &emitters).unwrap()).collect();
        let found = sampled(TexelSettings { shape, size, rays }, &emitters, &points);
        check(&format!("order {order}, {size} texels, {rays} rays"), &found, &truth, 5e-6);
    }
}

/// More rays take a coarse cube to the closed form of a square that nothing hides.
#[test]
fn rays_tend_to_the_closed_form() {
    let emitters = &block(DVec3::new(0.3, 0.2, -1.1), 0.25, DVec3::new(1.0, 2.0, 3.0))[..2];
    let shape = LightShape { order: 4, gradients: false };
    let points = points(12);
    let truth: Vec<_> = points.iter().map(|point| triangles(4, *point, emitters).unwrap()).collect();
    for (size, rays, bound) in [(8, 1, 0.6), (8, 2, 0.3), (8, 4, 0.15), (32, 4, 0.03)] {
        let found = sampled(TexelSettings { shape, size, rays }, emitters, &points);
        check(&format!("{size} texels, {rays} rays"), &found, &truth, bound);
    }
}

#[test]
fn host_structs_are_as_the_compiler_laid_them_out() {
    for (name, bindings) in [("ORDER4.RAYS4", 7), ("GRADIENTS.ORDER6.RAYS1", 8)] {
        let module = Module::load(&format!("radiance/texels.{name}.spv")).unwrap();
        module.assert_bindings(&TEXEL_BINDINGS[..bindings]);
        let constants = host_layout!(TexelConstants {
            triangle_count,
            size,
            keep_exact,
            shown_first,
            shown_count,
            red,
            green,
            blue,
            columns
        });
        module.push_constants.as_ref().unwrap().assert_matches(&constants);
        let block = |binding: usize| module.bindings[binding].block.as_ref().unwrap();
        let batch = block(0).members[0].block.as_ref().unwrap();
        batch.assert_matches(&host_layout!(Batch { count, height, depth, first }));
        let triangle = block(2).members[0].block.as_ref().unwrap();
        triangle.assert_matches(&host_layout!(EmitterTriangle { corners }));
        let surface = block(5).members[0].block.as_ref().unwrap();
        surface.assert_matches(&host_layout!(DeviceSurface { first, last, picture }));
    }
}

/// A screen before a point, another beside it, and a third that only some points see past the first.
fn screens() -> Vec<Triangle> {
    let square = |corner: DVec3, x: DVec3, y: DVec3, radiance: DVec3| {
        let corners = [corner, corner + x, corner + x + y, corner + y];
        [[0, 1, 2], [0, 2, 3]].map(|half| Triangle { corners: half.map(|i| corners[i]), radiance })
    };
    let near = square(DVec3::new(-0.25, -0.25, -1.0), 0.5 * DVec3::X, 0.5 * DVec3::Y, DVec3::ONE);
    let side = square(DVec3::new(1.5, -0.5, -0.5), DVec3::Z, DVec3::Y, DVec3::new(3.0, 2.0, 1.0));
    let far =
        square(DVec3::new(0.75, -0.25, -2.0), 0.5 * DVec3::X, 0.5 * DVec3::Y, DVec3::new(0.0, 0.5, 4.0));
    [near, side, far].concat()
}

/// Gradients of the closed form by central differences.
fn differences(order: usize, point: DVec3, emitters: &[Triangle]) -> Vec<DMat3> {
    let step = 1e-5;
    let at = |offset: DVec3| triangles(order, point + offset, emitters).unwrap().coefficients;
    let slopes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
        let (after, before) = (at(step * axis), at(-step * axis));
        let slope = |(after, before): (&DVec3, &DVec3)| (*after - *before) / (2.0 * step);
        after.iter().zip(&before).map(slope).collect::<Vec<_>>()
    });
    (0..order * order).map(|i| DMat3::from_cols(slopes[0][i], slopes[1][i], slopes[2][i])).collect()
}

/// Where nothing overlaps the device takes the closed form and says so; where something does, the cube map.
#[test]
fn closed_forms_are_taken_where_they_are_exact() {
    let (emitters, points) = (screens(), points(40));
    for (order, gradients) in [(5, false), (4, true)] {
        let shape = LightShape { order, gradients };
        let settings = TexelSettings { shape, size: 8, rays: 1 };
        let found = with_bench(&Texels::requirements(), |bench| {
            let texels =
                Texels::new(bench.context, settings).unwrap().with_closed_forms(bench.context).unwrap();
            bench.sampled(&texels, &emitters, &points).unwrap()
        });
        let cube = Cube::new(order, 8).unwrap();
        let (mut closed, mut closed_truth, mut mapped, mut mapped_truth) = (vec![], vec![], vec![], vec![]);
        for (point, sample) in points.iter().zip(found) {
            let (found, exact) = (sample.light, sample.exact);
            let truth = triangles(order, *point, &emitters);
            assert_eq!(exact, truth.is_ok(), "{point}");
            match truth {
                Ok(mut truth) => {
                    if gradients {
                        truth.gradients = differences(order, *point, &emitters);
                    }
                    closed.push(found);
                    closed_truth.push(truth);
                }
                Err(_) => {
                    mapped.push(Incident { gradients: Vec::new(), ..found });
                    mapped_truth.push(cube.sample(*point, &emitters).unwrap());
                }
            }
        }
        println!("order {order}: {} closed forms, {} cube maps", closed.len(), mapped.len());
        assert!(closed.len() > 5 && mapped.len() > 5);
        check(&format!("order {order}, closed forms"), &closed, &closed_truth, 2e-6);
        check(&format!("order {order}, cube maps"), &mapped, &mapped_truth, 2e-6);
    }
}

/// Spheres among screens: closed forms where nothing overlaps, else the triangles that stand for them.
#[test]
fn spheres_are_closed_forms_where_nothing_hides_them() {
    let lamp = |x: f64, z: f64, radius: f64, red: f64| Sphere {
        centre: DVec3::new(x, 0.3, z),
        radius,
        radiance: DVec3::new(red, 1.0, 0.5),
    };
    let spheres = [lamp(0.75, -1.6, 0.3, 2.0), lamp(0.9, 1.4, 0.02, 9.0)];
    let (emitters, points) = (screens(), points(24));
    let (order, gradients) = (4, true);
    let settings = TexelSettings { shape: LightShape { order, gradients }, size: 16, rays: 4 };
    let lights = Lights { emitters: &emitters[..4], spheres: &spheres, ..Lights::default() };
    let all = lights.triangles();
    let cube = Cube::new(order, 16).unwrap().with_rays(4).unwrap().with_gradients();
    let light = |point: DVec3| {
        let mut light = triangles(order, point, lights.emitters).ok()?;
        spheres.iter().for_each(|lamp| light.add(&sphere(order, point, lamp).unwrap()).unwrap());
        Some(light)
    };
    let found = with_bench(&Texels::requirements(), |bench| {
        let texels = Texels::new(bench.context, settings).unwrap().with_closed_forms(bench.context).unwrap();
        bench.sampled_of(&texels, &lights, &points).unwrap()
    });
    let (mut closed, mut closed_truth, mut mapped, mut mapped_truth) = (vec![], vec![], vec![], vec![]);
    for (point, sample) in points.iter().zip(found) {
        if sample.exact {
            let mut truth = light(*point).unwrap();
            let step = 1e-5;
            let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
                let [after, before] =
                    [step, -step].map(|step| light(*point + step * axis).unwrap().coefficients);
                let slope = |(after, before): (&DVec3, &DVec3)| (*after - *before) / (2.0 * step);
                after.iter().zip(&before).map(slope).collect::<Vec<_>>()
            });
            let column = |i: usize| DMat3::from_cols(columns[0][i], columns[1][i], columns[2][i]);
            truth.gradients = (0..order * order).map(column).collect();
            closed_truth.push(truth);
            closed.push(sample.light);
        } else {
            mapped.push(sample.light);
            mapped_truth.push(cube.sample(*point, &all).unwrap());
        }
    }
    println!("{} closed forms, {} cube maps", closed.len(), mapped.len());
    assert!(closed.len() > 5 && mapped.len() > 2);
    check("spheres and squares", &closed, &closed_truth, 2e-6);
    check("spheres as triangles", &mapped, &mapped_truth, 5e-6);
}
