//! The functions that hosts include, against quadrature over the normals of a lobe in f64.

use std::f64::consts::{PI, TAU};

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Binding, ComputePipelineDesc, Label, Location};
use airglow_graph::{Access, BufferDesc};
use airglow_math::sh;
use airglow_math::statistics::relative_l2;
use airglow_normals::kernels::BINDINGS;
use airglow_normals::vmf::{Lobe, mean_length};
use airglow_normals::zonal::{self, Abc};
use airglow_normals::{Brdf, Directions, Mixture, WeightedLobe, shade};
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::common::Random;
use super::with_bench;

static FUNCTIONS: &[u8] = include_bytes!("../../../../shaders/spirv/normals/functions.spv");

/// `Row` of `functions.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct FunctionRow {
    light: [f32; 4],
    half_vector: [f32; 4],
    view: [f32; 4],
    lobe: [f32; 4],
    values: [[f32; 4]; 16],
}

/// A lobe under a light, seen from somewhere.
struct Case {
    lobe: Lobe,
    light: DVec3,
    view: DVec3,
    half: DVec3,
}

fn evaluate(rows: &[FunctionRow]) -> Vec<f64> {
    with_bench(|bench| {
        let context = bench.context;
        let pipeline = context.create_compute_pipeline(&ComputePipelineDesc {
            name: "functions",
            spirv: &bytemuck::pod_collect_to_vec(FUNCTIONS),
            bindings: &BINDINGS,
            push_constant_size: 4,
        });
        let pipeline = pipeline.unwrap();
        let buffer = |size: usize, location| {
            let usage = BufferUsageFlags::STORAGE_BUFFER;
            let desc = BufferDesc { size: size as u64, usage };
            context.create_buffer(Label::new("test", "functions"), &desc, location).unwrap()
        };
        let input = buffer(size_of_val(rows), Location::Upload);
        input.write(0, rows).unwrap();
        let output = buffer(4 * rows.len(), Location::Readback);
        (bench.run)(&mut |recorder| {
            recorder.bind_compute(&pipeline, &[Binding::storage(0, &input), Binding::storage(1, &output)])?;
            recorder.push_constants(&(rows.len() as u32))?;
            recorder.dispatch([rows.len().div_ceil(64) as u32, 1, 1])?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::HostRead)
        })
        .unwrap();
        let values: Vec<f32> = output.read(0, rows.len()).unwrap();
        values.into_iter().map(f64::from).collect()
    })
}

/// Cases of one concentration, half of them near the mirror direction.
fn cases(concentration: f64, width: f64, random: &mut Random) -> Vec<Case> {
    let mut cases = Vec::new();
    while cases.len() < 40 {
        let axis = DVec3::new(0.3 * random.bell(), 0.3 * random.bell(), 1.0).normalize();
        let light = random.hemisphere();
        let mut view = random.hemisphere();
        if cases.len() % 2 == 0 {
            let offset =
                (width + concentration.powf(-0.5)) * DVec3::new(random.bell(), random.bell(), random.bell());
            let half = (axis + offset).normalize();
            view = 2.0 * light.dot(half) * half - light;
        }
        if view.z > 0.05 && light.z > 0.05 {
            let half = (light + view).normalize();
            cases.push(Case { lobe: Lobe { axis, concentration }, light, view, half });
        }
    }
    cases
}

/// The mean of a function of the normal over a lobe, by equal shares of it.
fn mean(lobe: &Lobe, value: impl Fn(DVec3) -> f64) -> f64 {
    shares::<160>(lobe, value)
}

/// The same by so many shares to either side.
fn shares<const SIDE: usize>(lobe: &Lobe, value: impl Fn(DVec3) -> f64) -> f64 {
    let k = lobe.concentration;
    let across = lobe.axis.any_orthonormal_vector();
    let up = lobe.axis.cross(across);
    let share = |i: usize| (i as f64 + 0.5) / SIDE as f64;
    let mut sum = 0.0;
    for i in 0..SIDE {
        let u = share(i);
        let cosine = 1.0 + (u + (1.0 - u) * (-2.0 * k).exp()).ln() / k;
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        for j in 0..SIDE {
            let (y, x) = (TAU * share(j)).sin_cos();
            sum += value(sine * (x * across + y * up) + cosine * lobe.axis);
        }
    }
    sum / (SIDE * SIDE) as f64
}

fn row(kind: f32, parameter: f64, case: &Case) -> FunctionRow {
    let wide = |vector: DVec3, w: f64| vector.extend(w).as_vec4().to_array();
    FunctionRow {
        light: wide(case.light, f64::from(kind)),
        half_vector: wide(case.half, parameter),
        view: wide(case.view, 0.0),
        lobe: wide(mean_length(case.lobe.concentration) * case.lobe.axis, 1.0),
        values: [[0.0; 4]; 16],
    }
}

/// Relative L2 error of the device against the truth over cases of one concentration.
fn error(rows: &[FunctionRow], truths: &[f64]) -> f64 {
    relative_l2(&evaluate(rows), truths).unwrap()
}

#[test]
fn facets_reflect_as_their_normals_do() {
    let mut random = Random(5);
    for (alpha, concentration, bounds) in [
        (0.1, 30.0, [0.03, 0.1]),
        (0.1, 300.0, [0.01, 0.1]),
        (0.3, 30.0, [0.06, 0.1]),
        (0.3, 300.0, [0.01, 0.1]),
        (0.5, 1000.0, [0.01, 0.1]),
    ] {
        let cases = cases(concentration, alpha / 1.5, &mut random);
        let beckmann = |case: &Case| {
            let truth = |n: DVec3| {
                let t = n.dot(case.half);
                if t <= 0.0 {
                    return 0.0;
                }
                let tangent = (1.0 - t * t).max(0.0) / (t * t);
                let facets = (-tangent / (alpha * alpha)).exp() / (PI * alpha * alpha * t.powi(4));
                0.25 * facets * n.dot(case.light).max(0.0)
            };
            mean(&case.lobe, truth)
        };
        let torrance = |case: &Case| {
            let a = alpha * alpha;
            let truth = |n: DVec3| {
                let (nl, nv, t) =
                    (n.dot(case.light).max(0.0), n.dot(case.view).max(1e-4), n.dot(case.half).max(0.0));
                let bent = |x: f64| (x * x * (1.0 - a) + a).sqrt();
                let masking = 0.5 / (nl * bent(nv) + nv * bent(nl)).max(1e-6);
                a / (PI * (t * t * (a - 1.0) + 1.0).powi(2)) * masking * nl
            };
            mean(&case.lobe, truth)
        };
        for (kind, name, bound) in [(0.0, "Beckmann", bounds[0]), (1.0, "Torrance and Sparrow", bounds[1])] {
            let rows: Vec<_> = cases.iter().map(|case| row(kind, alpha, case)).collect();
            let truths: Vec<f64> =
                cases.iter().map(|case| if kind == 0.0 { beckmann(case) } else { torrance(case) }).collect();
            let found = error(&rows, &truths);
            println!("{name}, alpha {alpha}, concentration {concentration}: {:.2} %", 100.0 * found);
            assert!(found < bound, "{name}, alpha {alpha}, concentration {concentration}: {found}");
        }
    }
}

#[test]
fn fits_of_measured_materials_reflect_by_their_bands() {
    // The green channel of three materials of Dupuy's public-domain fits to the MERL data (Matusik et al. 2003).
    for (name, abc) in [
        ("blue-metallic-paint", Abc { height: 0.469_843, rise: 48.572, fall: 1.702_5 }),
        ("orange-paint", Abc { height: 0.374, rise: 11.0, fall: 1.97 }),
        ("teflon", Abc { height: 1.816, rise: 42.0, fall: 2.07 }),
    ] {
        let bands = zonal::coefficients(64, |t| abc.value(t)).unwrap();
        let mut random = Random(6);
        for concentration in [10.0, 100.0, 1000.0] {
            let cases = cases(concentration, 0.2, &mut random);
            let with_bands = |case: &Case| {
                let mut row = row(2.0, 0.0, case);
                for (value, band) in row.values.as_flattened_mut().iter_mut().zip(&bands) {
                    *value = *band as f32;
                }
                row
            };
            let rows: Vec<_> = cases.iter().map(with_bands).collect();
            let truth =
                |case: &Case| mean(&case.lobe, |n| abc.value(n.dot(case.half)) * n.dot(case.light).max(0.0));
            let truths: Vec<f64> = cases.iter().map(truth).collect();
            let found = error(&rows, &truths);
            println!("{name}, concentration {concentration}: {:.2} %", 100.0 * found);
            assert!(found < 0.03, "{name}, concentration {concentration}: {found}");
        }
    }
}

/// A row with nine coefficients.
fn with_coefficients(mut row: FunctionRow, coefficients: &[f64]) -> FunctionRow {
    row.values.iter_mut().zip(coefficients).for_each(|(to, from)| to[0] = *from as f32);
    row
}

fn basis(n: DVec3) -> [f64; 9] {
    let mut basis = [0.0; 9];
    sh::evaluate(3, n, &mut basis).unwrap();
    basis
}

/// Light that nine coefficients hold exactly, so that only the lobe's dimming of the bands can err; and normals of a lobe
/// in nine coefficients under a light.
#[test]
fn matt_lobes_under_harmonics_and_harmonics_under_a_light() {
    let mut random = Random(7);
    for (concentration, bound) in [(2.0, 0.08), (20.0, 0.02), (2000.0, 0.005)] {
        let (mut lit, mut truths, mut seen, mut cosines) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for case in cases(concentration, 0.3, &mut random) {
            let light: Vec<f64> = (0..9).map(|_| random.bell()).collect();
            let bands = [1.0, 2.0 / 3.0, 0.25];
            let irradiance = mean(&case.lobe, |n| {
                let basis = basis(n);
                (0..9).map(|i: usize| bands[i.isqrt()] * light[i] * basis[i]).sum()
            });
            lit.push(with_coefficients(row(3.0, 0.0, &case), &light));
            truths.push(irradiance);
            let normals: Vec<f64> = (0..9).map(|i| mean(&case.lobe, |n| basis(n)[i])).collect();
            seen.push(with_coefficients(row(4.0, 0.0, &case), &normals));
            cosines.push(mean(&case.lobe, |n| n.dot(case.light).max(0.0) / PI));
        }
        let [lobes, harmonics] = [error(&lit, &truths), error(&seen, &cosines)];
        println!("concentration {concentration}: {lobes:.1e} of lobes, {harmonics:.1e} of harmonics");
        assert!(lobes < 4e-3 && harmonics < bound, "{concentration}: {lobes}, {harmonics}");
    }
}

/// Glossy lobes under light all around, against the lobe's own radiance for each light on a grid.
#[test]
fn glossy_lobes_under_harmonics() {
    const SIDE: usize = 32;
    let mut random = Random(8);
    for (concentration, exponent, bound) in
        [(30.0, 50.0, 0.15), (300.0, 50.0, 0.15), (300.0, 200.0, 0.1), (30.0, 10.0, 0.6)]
    {
        let (mut rows, mut truths) = (Vec::new(), Vec::new());
        for case in cases(concentration, 0.3, &mut random).into_iter().take(12) {
            let light: Vec<f64> = (0..9).map(|i| if i == 0 { 3.0 } else { random.bell() }).collect();
            let moment = mean_length(concentration) * case.lobe.axis;
            let mixture = Mixture::new(vec![WeightedLobe { weight: 1.0, moment }]).unwrap();
            let brdf = Brdf::BlinnPhong { exponent };
            let mut sum = 0.0;
            for i in 0..SIDE * 2 * SIDE {
                let cosine = 1.0 - 2.0 * ((i / (2 * SIDE)) as f64 + 0.5) / SIDE as f64;
                let (y, x) = (PI * ((i % (2 * SIDE)) as f64 + 0.5) / SIDE as f64).sin_cos();
                let sine = (1.0 - cosine * cosine).sqrt();
                let towards = DVec3::new(sine * x, sine * y, cosine);
                let directions = Directions::new(towards, case.view).unwrap();
                let arriving: f64 = basis(towards).iter().zip(&light).map(|(a, b)| a * b).sum();
                sum += arriving * shade::radiance(&mixture, brdf, directions);
            }
            truths.push(sum * 4.0 * PI / (2 * SIDE * SIDE) as f64);
            let mut row = with_coefficients(row(5.0, exponent + 1.0, &case), &light);
            let height = (exponent + 8.0) / (8.0 * PI);
            row.values.iter_mut().for_each(|value| value[0] *= height as f32);
            rows.push(row);
        }
        let found = error(&rows, &truths);
        println!("concentration {concentration}, exponent {exponent}: {:.1} %", 100.0 * found);
        assert!(found < bound, "concentration {concentration}, exponent {exponent}: {found}");
    }
}

/// Facets of a lobe under light from all around, against every normal and every direction that it mirrors; and a matt lobe by
/// its moments about other axes.
#[test]
fn lobes_of_facets_under_harmonics() {
    const SHARES: usize = 20;
    let mut random = Random(9);
    for (alpha, concentration, bound) in
        [(0.1, 1e5, 0.04), (0.3, 1e5, 0.05), (0.6, 1e5, 0.05), (0.3, 100.0, 0.08), (0.3, 20.0, 0.15)]
    {
        let (mut rows, mut truths, mut turned, mut matt) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let seen = cases(concentration, 0.3, &mut random);
        for case in seen.into_iter().filter(|case| case.lobe.axis.dot(case.view) > 0.05).take(16) {
            let light: Vec<f64> = (0..9).map(|i| if i == 0 { 3.0 } else { random.bell() }).collect();
            let arriving = |d: DVec3| basis(d).iter().zip(&light).map(|(a, b)| a * b).sum::<f64>();
            truths.push(shares::<SHARES>(&case.lobe, |n| mirrored(n, case.view, alpha, arriving)));
            rows.push(with_coefficients(row(6.0, alpha, &case), &light));
            turned.push(with_coefficients(row(7.0, alpha, &case), &light));
            matt.push(with_coefficients(row(3.0, alpha, &case), &light));
        }
        let found = error(&rows, &truths);
        let by_moments = error(&turned, &evaluate(&matt));
        println!(
            "alpha {alpha}, concentration {concentration}: {:.1} %, turned {by_moments:.0e}",
            100.0 * found
        );
        assert!(found < bound, "alpha {alpha}, concentration {concentration}: {found}");
        assert!(by_moments < 1e-5, "{by_moments}");
    }
}

/// What facets about one normal mirror towards a view of light from all around, by equal shares of the facets.
fn mirrored(normal: DVec3, view: DVec3, alpha: f64, arriving: impl Fn(DVec3) -> f64) -> f64 {
    const SIDE: usize = 24;
    let (a, nv) = (alpha * alpha, normal.dot(view));
    if nv <= 0.0 {
        return 0.0;
    }
    let (across, bent) = (normal.any_orthonormal_vector(), |x: f64| (x * x * (1.0 - a) + a).sqrt());
    let share = |i: usize| (i as f64 + 0.5) / SIDE as f64;
    let mut sum = 0.0;
    for i in 0..SIDE * SIDE {
        let u = share(i / SIDE);
        let cosine = ((1.0 - u) / (1.0 + (a - 1.0) * u)).sqrt();
        let (y, x) = (TAU * share(i % SIDE)).sin_cos();
        let half = (1.0 - cosine * cosine).sqrt() * (x * across + y * normal.cross(across)) + cosine * normal;
        let (vh, light) = (view.dot(half), 2.0 * view.dot(half) * half - view);
        let nl = normal.dot(light);
        if vh > 0.0 && nl > 0.0 {
            sum += 2.0 * nl / (nl * bent(nv) + nv * bent(nl)) * vh / cosine * arriving(light);
        }
    }
    sum / (SIDE * SIDE) as f64
}

#[test]
fn rows_are_laid_out_as_the_shader_has_them() {
    let module = Module::load("normals/functions.spv").unwrap();
    module.assert_bindings(&BINDINGS);
    let row = module.bindings[0].block.as_ref().unwrap().members[0].block.as_ref().unwrap();
    row.assert_matches(&host_layout!(FunctionRow { light, half_vector, view, lobe, values }));
}
