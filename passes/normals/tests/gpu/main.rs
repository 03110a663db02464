//! The kernels on the device against the f64 reference of the same formulas, and against the truth.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

#[path = "../common/mod.rs"]
mod common;
mod conformance;
mod functions;
mod health;
mod limits;
mod textures;

use airglow_gpu::{GpuError, Recorder, Requirements};
use airglow_math::statistics::relative_l2;
use airglow_normals::bench::{Bench, LevelLobes, Row};
use airglow_normals::eval::{TexelRow, texels};
use airglow_normals::kernels::{
    AlignConstants, AverageConstants, BINDINGS, FitConstants, PackConstants, RivalConstants, RowConstants,
};
use airglow_normals::{
    Brdf, Directions, FitSettings, Method, Mixture, NormalMap, Settings, fit, reference, shade,
};
use airglow_tests::device::fixture_with;
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;
use common::{Random, directions};
use glam::DVec3;

const BRDFS: [Brdf; 8] = [
    Brdf::Lambert,
    Brdf::BlinnPhong { exponent: 1.0 },
    Brdf::BlinnPhong { exponent: 50.0 },
    Brdf::BlinnPhong { exponent: 10_000.0 },
    Brdf::Ggx { alpha: 0.02 },
    Brdf::Ggx { alpha: 0.1 },
    Brdf::Ggx { alpha: 0.3 },
    Brdf::Ggx { alpha: 1.0 },
];

fn with_bench<T>(test: impl FnOnce(&Bench<'_>) -> T) -> T {
    let fixture = fixture_with(&Requirements::engine());
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    test(&Bench { context: fixture.context(), run: &run })
}

/// These fits without a budget.
fn wide(fit: FitSettings) -> Settings {
    Settings { fit, budget: Some(u64::MAX), ..Default::default() }
}

/// The mixture of a texel as the device left it.
fn texel(level: &LevelLobes, lobes: usize, x: usize, y: usize) -> Mixture {
    let at = (y * level.size[0] + x) * lobes;
    Mixture::new(level.lobes[at..at + lobes].iter().map(|&lobe| lobe.into()).collect()).unwrap()
}

#[test]
fn shading_is_that_of_the_reference() {
    let map = common::groove(64);
    let mut random = Random(3);
    for brdf in BRDFS {
        let mut rows = Vec::new();
        for i in 0..200 {
            let level = 1 + i % 5;
            let [width, height] = map.size(level);
            let footprint = map.footprint(level, random.below(width), random.below(height)).unwrap();
            let mixture = fit(&footprint, &FitSettings { lobes: 1 + i % 6, ..Default::default() }).unwrap();
            // What f32 holds of the lobes is the input of both.
            let lobes = mixture.lobes().iter().map(|lobe| lobe.packed().into()).collect();
            rows.push(Row { lobes, brdf, directions: directions(i, &footprint, 0.1, &mut random) });
        }
        let truth =
            |row: &Row| shade::radiance(&Mixture::new(row.lobes.clone()).unwrap(), brdf, row.directions);
        let truths: Vec<f64> = rows.iter().map(truth).collect();
        let values = with_bench(|bench| bench.radiance(&rows).unwrap());
        let values: Vec<f64> = values.into_iter().map(f64::from).collect();
        let error = relative_l2(&values, &truths).unwrap();
        println!("{brdf:?}: {error:.1e}");
        assert!(error < 1e-3, "{brdf:?}: {error:e}");
    }
}

/// Every level of a chain: weights and moments kept, radiance as near to the truth as the reference's own mixtures.
/// The largest error of fits on the device beyond that of fits in f64.
const FIT_SLACK: f64 = 0.005;

/// `slack`: what putting the lobes in order may add.
fn check_chain(name: &str, map: &NormalMap, lobes: usize, slack: f64) {
    let settings = wide(FitSettings { lobes, iterations: 8, ..Default::default() });
    let (fitted, built) =
        with_bench(|bench| (bench.fitted(map, &settings).unwrap(), bench.build(map, &settings).unwrap()));
    check_levels(&format!("{name}, fitted"), map, &settings.fit, &fitted, FIT_SLACK);
    check_levels(&format!("{name}, in order"), map, &settings.fit, &built, FIT_SLACK + slack);
}

fn check_levels(name: &str, map: &NormalMap, settings: &FitSettings, levels: &[LevelLobes], slack: f64) {
    let lobes = settings.lobes;
    assert_eq!(levels.len(), map.levels() - 1);
    // A texel that two coarser ones share is cut by area, wherever its lobes lie in it.
    let kept = if map.size(0)[0].is_power_of_two() { 1e-5 } else { 5e-3 };
    let mut random = Random(9);
    let brdf = Brdf::BlinnPhong { exponent: 50.0 };
    let (mut device, mut host, mut truths) = (Vec::new(), Vec::new(), Vec::new());
    for (i, level) in levels.iter().enumerate() {
        for _ in 0..6 {
            let (x, y) = (random.below(level.size[0]), random.below(level.size[1]));
            let footprint = map.footprint(i + 1, x, y).unwrap();
            let mixture = texel(level, lobes, x, y);
            let weight: f64 = mixture.lobes().iter().map(|lobe| lobe.weight).sum();
            let moment: DVec3 = mixture.lobes().iter().map(|lobe| lobe.moment).sum();
            let mean = airglow_normals::rivals::mean(&footprint);
            assert!((weight - 1.0).abs() < 1e-5, "{name}, level {}: {mixture:?}", i + 1);
            assert!((moment - mean).length() < kept, "{name}, level {}: {moment} is not {mean}", i + 1);
            let ours = fit(&footprint, settings).unwrap();
            for row in 0..8 {
                let directions = directions(row, &footprint, 0.14, &mut random);
                truths.push(reference::radiance(&footprint, brdf, directions));
                device.push(shade::radiance(&mixture, brdf, directions));
                host.push(shade::radiance(&ours, brdf, directions));
            }
        }
    }
    let [device, host] = [device, host].map(|values| relative_l2(&values, &truths).unwrap());
    println!("{name}, {lobes} lobes: {:.2}% on the device, {:.2}% in f64", 100.0 * device, 100.0 * host);
    assert!(device < 1.3 * host + slack, "{name}, {lobes} lobes: {device} and {host}");
}

#[test]
fn chains_are_as_good_as_the_references() {
    check_chain("groove", &common::groove(128), 4, 0.005);
    check_chain("groove", &common::groove(64), 2, 0.015);
    check_chain("weave", &common::weave(128), 4, 0.0);
    check_chain("weave", &common::weave(64), 6, 0.0);
    check_chain("grain", &common::grain(128), 4, 0.005);
    check_chain("grain", &common::grain(64), 1, 0.0);
    check_chain("grain", &common::grain(95), 6, 0.005);
}

#[test]
fn maps_of_any_size_and_content_give_finite_lobes() {
    let vectors = |width: usize, height: usize| -> Vec<[f32; 3]> {
        let all =
            [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0; 3], [f32::NAN; 3], [0.0, 0.6, -0.8]];
        (0..width * height).map(|i| all[i * i % 6]).collect()
    };
    with_bench(|bench| {
        for (width, height) in [(1, 1), (1, 9), (13, 1), (5, 3), (31, 31), (100, 37)] {
            let map = NormalMap::from_vectors(width, height, &vectors(width, height)).unwrap();
            let settings = FitSettings { iterations: 32, ..Default::default() };
            let levels = bench.build(&map, &wide(settings)).unwrap();
            assert_eq!(levels, bench.build(&map, &wide(settings)).unwrap(), "the same map, the same bits");
            for level in &levels {
                for lobes in level.lobes.chunks(4) {
                    let weight: f32 = lobes.iter().map(|lobe| lobe[3]).sum();
                    assert!((weight - 1.0).abs() < 1e-5, "{width} x {height}: {lobes:?}");
                    assert!(lobes.iter().flatten().all(|value| value.is_finite()), "{lobes:?}");
                }
            }
        }
        let flat = NormalMap::from_vectors(8, 8, &[[0.6, 0.0, 0.8]; 64]).unwrap();
        for level in bench.build(&flat, &Settings::default()).unwrap() {
            let full = level.lobes[..4].iter().filter(|lobe| (lobe[3] - 1.0).abs() < 1e-6).count();
            assert_eq!(full, 1, "{:?}", &level.lobes[..4]);
        }
        assert!(bench.build(&flat, &wide(FitSettings { lobes: 3, ..Default::default() })).is_err());
        assert!(bench.build(&flat, &wide(FitSettings { iterations: 33, ..Default::default() })).is_err());
        assert!(bench.build(&flat, &Settings { budget: Some(100), ..Default::default() }).is_err());
    });
}

#[test]
fn rows_of_texels_are_near_the_truth_or_refused() {
    let map = common::weave(64);
    let row = TexelRow {
        level: 3,
        x: 2,
        y: 5,
        light: DVec3::new(0.3, 0.1, 1.0),
        view: DVec3::new(-0.1, 0.5, 1.0),
        brdf: Brdf::BlinnPhong { exponent: 50.0 },
        method: "default".parse().unwrap(),
    };
    let rows = [
        row,
        TexelRow { level: 6, x: 0, y: 0, method: Method::Lobes(6), ..row },
        TexelRow { level: 5, x: 1, y: 0, method: Method::Taps, ..row },
        TexelRow { level: 0, brdf: Brdf::Ggx { alpha: 0.5 }, ..row },
        TexelRow { level: 4, x: 1, y: 1, brdf: Brdf::Lambert, ..row },
        TexelRow { level: 7, x: 0, y: 0, ..row },
        TexelRow { x: 8, ..row },
        TexelRow { light: DVec3::ZERO, ..row },
        TexelRow { brdf: Brdf::Ggx { alpha: 0.0 }, ..row },
        TexelRow { method: Method::Lobes(3), ..row },
    ];
    let results = with_bench(|bench| texels(bench, &map, &rows).unwrap());
    for result in &results[..5] {
        let found = result.as_ref().unwrap();
        assert!((found.value / found.reference - 1.0).abs() < 0.05, "{found:?}");
    }
    for (result, word) in results[5..].iter().zip(["level 7", "(8, 5)", "light", "alpha", "vmf:3"]) {
        let error = result.as_ref().unwrap_err().to_string();
        assert!(error.contains(word), "{error} does not name {word}");
    }
    for refused in ["vmf:3", "vmf:", "leadr", "sh:6"] {
        assert!(refused.parse::<Method>().unwrap_err().to_string().contains("vmf:4"));
    }
}

#[test]
fn rivals_on_the_device_are_those_of_the_reference() {
    let maps = [common::groove(32), common::grain(25)];
    let brdfs = [Brdf::Lambert, Brdf::BlinnPhong { exponent: 50.0 }, Brdf::Ggx { alpha: 0.3 }];
    for method in Method::ALL.into_iter().filter(|method| !matches!(method, Method::Lobes(_) | Method::Taps))
    {
        let (mut values, mut expected) = (Vec::new(), Vec::new());
        for map in &maps {
            let mut random = Random(13);
            let mut rows = Vec::new();
            for i in 0..60 {
                let level = i % map.levels();
                let [width, height] = map.size(level);
                let (x, y) = (random.below(width), random.below(height));
                let (light, view) = (random.hemisphere(), random.hemisphere());
                rows.push(TexelRow { level, x, y, light, view, brdf: brdfs[i % 3], method });
            }
            for (row, found) in rows.iter().zip(with_bench(|bench| texels(bench, map, &rows).unwrap())) {
                let directions = Directions::new(row.light, row.view).unwrap();
                let of = if row.level == 0 { Method::Mip } else { method };
                values.push(found.unwrap().value);
                expected.push(of.radiance(map, [row.level, row.x, row.y], row.brdf, directions).unwrap());
            }
        }
        let error = relative_l2(&values, &expected).unwrap();
        println!("{method}: {error:.1e}");
        assert!(error < 1e-4, "{method}: {error:e}");
    }
}

#[test]
fn host_structs_are_as_the_compiler_laid_them_out() {
    for lobes in [1, 2, 4, 6] {
        let fit = Module::load(&format!("normals/fit.LOBES{lobes}.spv")).unwrap();
        fit.assert_bindings(&BINDINGS);
        let layout = host_layout!(FitConstants { fine, size, per_texel, iterations, sharpest, first });
        fit.push_constants.as_ref().unwrap().assert_matches(&layout);
    }
    for lobes in [2, 4, 6] {
        let align = Module::load(&format!("normals/align.LOBES{lobes}.spv")).unwrap();
        align.assert_bindings(&BINDINGS);
        let layout = host_layout!(AlignConstants { coarse_size, size });
        align.push_constants.as_ref().unwrap().assert_matches(&layout);
    }
    for storage in ["f16", "snorm8", "octahedral8"] {
        let pack = Module::load(&format!("normals/pack.{storage}.spv")).unwrap();
        pack.assert_bindings(&BINDINGS);
        pack.push_constants.as_ref().unwrap().assert_matches(&host_layout!(PackConstants { texels, lobes }));
    }
    let rows = Module::load("normals/rows.spv").unwrap();
    rows.assert_bindings(&BINDINGS);
    let row = rows.bindings[0].block.as_ref().unwrap().members[0].block.as_ref().unwrap();
    row.assert_matches(&host_layout!(RowConstants { light, half_vector, lobes }));
    for name in ["mean", "lean", "sh.ORDER3", "sh.ORDER4", "sh.ORDER5"] {
        let average = Module::load(&format!("normals/average.{name}.spv")).unwrap();
        average.assert_bindings(&BINDINGS);
        let layout = host_layout!(AverageConstants { fine_size, size, first, single });
        average.push_constants.as_ref().unwrap().assert_matches(&layout);
    }
    for name in ["lean", "ORDER5.sh"] {
        let rivals = Module::load(&format!("normals/rivals.{name}.spv")).unwrap();
        rivals.assert_bindings(&BINDINGS);
        let row = rivals.bindings[0].block.as_ref().unwrap().members[0].block.as_ref().unwrap();
        row.assert_matches(&host_layout!(RivalConstants { light, half_vector, factors, kept }));
    }
}
