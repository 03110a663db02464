//! What breaks filters of normals: no map, light or material may give anything but a finite radiance that is right.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

mod common;

use std::f64::consts::{FRAC_PI_2, PI};

use airglow_normals::rivals::{self, Lean};
use airglow_normals::vmf::{Lobe, concentration, mean_length};
use airglow_normals::{
    Brdf, Directions, FitSettings, Harmonics, Mixture, NormalMap, Sample, WeightedLobe, fit, fit_from,
    reference, shade,
};
use glam::DVec3;

const BRDFS: [Brdf; 6] = [
    Brdf::Lambert,
    Brdf::BlinnPhong { exponent: 1.0 },
    Brdf::BlinnPhong { exponent: 50.0 },
    Brdf::BlinnPhong { exponent: 10_000.0 },
    Brdf::Ggx { alpha: 0.001 },
    Brdf::Ggx { alpha: 1.0 },
];

fn four() -> FitSettings {
    FitSettings::default()
}

fn of(normals: &[DVec3]) -> Vec<Sample> {
    let weight = 1.0 / normals.len() as f64;
    normals.iter().map(|n| Sample { weight, mean: n.normalize() }).collect()
}

/// Lights and views from the zenith to the horizon and behind the surface.
fn all_directions() -> Vec<Directions> {
    let places = [0.0, 0.7, 1.5, FRAC_PI_2, 2.0, PI];
    let direction = |angle: f64, around: f64| {
        DVec3::new(angle.sin() * around.cos(), angle.sin() * around.sin(), angle.cos())
    };
    let mut directions = Vec::new();
    for light in places {
        for view in places {
            for around in [0.0, 1.0, PI] {
                directions
                    .push(Directions::new(direction(light, 0.3), direction(view, 0.3 + around)).unwrap());
            }
        }
    }
    directions
}

/// Weights and moments are those of the samples, and every method is finite and not negative.
fn check(footprint: &[Sample]) -> Mixture {
    let mixture = fit(footprint, &four()).unwrap();
    let weight: f64 = mixture.lobes().iter().map(|lobe| lobe.weight).sum();
    let moment: DVec3 = mixture.lobes().iter().map(|lobe| lobe.moment).sum();
    let mean = rivals::mean(footprint);
    assert!((weight - 1.0).abs() < 1e-12, "weights sum to {weight}");
    assert!((moment - mean).length() < 1e-12, "moments sum to {moment}, not {mean}");
    let lean = Lean::new(footprint);
    let harmonics = Harmonics::new(3, footprint).unwrap();
    for brdf in BRDFS {
        for directions in all_directions() {
            let values = [
                reference::radiance(footprint, brdf, directions),
                shade::radiance(&mixture, brdf, directions),
                harmonics.radiance(brdf, directions).unwrap(),
                rivals::mip(mean, true, brdf, directions),
                rivals::mip(mean, false, brdf, directions),
                rivals::toksvig(mean, brdf, directions),
                lean.radiance(brdf, directions),
            ];
            assert!(
                values.iter().all(|value| value.is_finite() && *value >= 0.0),
                "{brdf:?} {directions:?}: {values:?}"
            );
        }
    }
    mixture
}

#[test]
fn all_normals_equal() {
    let normal = DVec3::new(0.2, 0.1, 0.9).normalize();
    let mixture = check(&of(&[normal; 64]));
    let filled: Vec<_> = mixture.lobes().iter().filter(|lobe| lobe.weight > 0.0).collect();
    assert_eq!(filled.len(), 1, "{mixture:?}");
    let directions = Directions::new(DVec3::new(0.0, 0.5, 1.0), DVec3::new(0.4, 0.0, 1.0)).unwrap();
    for brdf in [BRDFS[0], BRDFS[2], BRDFS[5]] {
        let (ours, truth) = (
            shade::radiance(&mixture, brdf, directions),
            reference::radiance(&of(&[normal]), brdf, directions),
        );
        assert!((ours / truth - 1.0).abs() < 0.005, "{brdf:?}: {ours} is not {truth}");
    }
}

#[test]
fn antipodal_clusters_stay_apart() {
    let mixture = check(&of(&[DVec3::X, DVec3::NEG_X, DVec3::X, DVec3::NEG_X]));
    let filled: Vec<_> = mixture.lobes().iter().filter(|lobe| lobe.weight > 1e-9).collect();
    assert_eq!(filled.len(), 2, "{mixture:?}");
    for lobe in filled {
        assert!((lobe.weight - 0.5).abs() < 1e-12 && lobe.mean().length() > 1.0 - 1e-12, "{lobe:?}");
    }
}

#[test]
fn below_the_horizon_and_along_it() {
    check(&of(&[DVec3::NEG_Z, DVec3::X, DVec3::new(1.0, 0.0, -1.0), DVec3::new(0.0, 1.0, 1e-9)]));
    check(&of(&[DVec3::NEG_Z]));
}

#[test]
fn texels_without_direction_become_flat() {
    let bad = [[0.0; 3], [f32::NAN; 3], [1e-40, 0.0, 0.0], [f32::INFINITY, 0.0, 0.0], [0.0, f32::NAN, 1.0]];
    let mut vectors = vec![[0.6, 0.0, 0.8]; 16];
    vectors[3..8].copy_from_slice(&bad);
    let map = NormalMap::from_vectors(4, 4, &vectors).unwrap();
    assert_eq!(map.repaired(), 5);
    assert_eq!(map.normals()[4], DVec3::Z);
    check(&map.footprint(2, 0, 0).unwrap());
    let huge = NormalMap::from_vectors(1, 1, &[[3e38, 3e38, 3e38]]).unwrap();
    assert_eq!(huge.repaired(), 0);
}

#[test]
fn maps_of_any_size_are_tiled_by_each_level() {
    for (width, height) in [(1, 1), (1, 7), (13, 1), (5, 3), (8, 8), (7, 12)] {
        let vectors = vec![[0.0, 0.0, 1.0]; width * height];
        let map = NormalMap::from_vectors(width, height, &vectors).unwrap();
        for level in 0..map.levels() {
            let [columns, rows] = map.size(level);
            let mut covered = 0.0;
            for y in 0..rows {
                for x in 0..columns {
                    let footprint = map.footprint(level, x, y).unwrap();
                    let total: f64 = footprint.iter().map(|sample| sample.weight).sum();
                    assert!((total - 1.0).abs() < 1e-12, "{width} x {height} level {level}: {total}");
                    covered += footprint.len() as f64;
                }
            }
            assert!(covered >= (width * height) as f64);
        }
        assert_eq!(map.size(map.levels() - 1), [1, 1]);
        let error = map.footprint(0, width, 0).unwrap_err().to_string();
        assert!(error.contains(&format!("{width} x {height}")), "{error}");
        assert!(map.footprint(200, 0, 0).is_err());
    }
    for (width, height, texels) in [(0, 4, 0), (2, 2, 3), (usize::MAX, 2, 1)] {
        let error = NormalMap::from_vectors(width, height, &vec![[0.0; 3]; texels]).unwrap_err();
        assert!(error.to_string().contains("give"), "{error}");
    }
}

#[test]
fn empty_lobes_and_identical_seeds() {
    let footprint = of(&[DVec3::Z, DVec3::X, DVec3::new(1.0, 1.0, 1.0)]);
    let same = WeightedLobe { weight: 0.25, moment: 0.2 * DVec3::Z };
    let seeds = Mixture::new(vec![same, same, WeightedLobe::default(), same]).unwrap();
    let mixture = fit_from(&footprint, &seeds, &four()).unwrap();
    assert_eq!(mixture.lobes()[2].weight, 0.0);
    let weight: f64 = mixture.lobes().iter().map(|lobe| lobe.weight).sum();
    assert!((weight - 1.0).abs() < 1e-12, "{mixture:?}");
    assert_eq!(mixture.lobes()[0], mixture.lobes()[1], "identical seeds share alike");
    let none = Mixture::new(vec![WeightedLobe::default(); 4]).unwrap();
    let mixture = fit_from(&footprint, &none, &four()).unwrap();
    assert!(
        mixture.lobes().iter().all(|lobe| lobe.moment.is_finite() && lobe.weight.is_finite()),
        "{mixture:?}"
    );
    let empty = fit(&[], &four()).unwrap();
    assert_eq!(shade::radiance(&empty, Brdf::Lambert, all_directions()[0]), 0.0);
}

#[test]
fn any_length_of_the_mean_gives_a_lobe() {
    let lengths = [
        -1.0,
        0.0,
        f64::MIN_POSITIVE,
        1e-12,
        0.5,
        1.0 - 1e-8,
        1.0 - 1e-16,
        1.0,
        1.5,
        f64::INFINITY,
        f64::NAN,
    ];
    for r in lengths {
        let k = concentration(r);
        assert!((1e-6..=1e8).contains(&k) && mean_length(k).is_finite(), "{r}: {k}");
    }
    for mean in [DVec3::ZERO, DVec3::NAN, DVec3::splat(1e300), DVec3::splat(1e-300)] {
        let lobe = Lobe::from_mean(mean);
        let moment = mean_length(lobe.concentration) * lobe.axis;
        let mixture = Mixture::new(vec![WeightedLobe { weight: 1.0, moment }]).unwrap();
        let towards = Directions::new(lobe.axis, lobe.axis).unwrap();
        let across = Directions::new(lobe.axis, lobe.axis.any_orthogonal_vector()).unwrap();
        for directions in [towards, across] {
            for exponent in [1.0, 50.0, 1e4, 1e8] {
                let value = shade::radiance(&mixture, Brdf::BlinnPhong { exponent }, directions);
                assert!(value.is_finite() && value >= 0.0, "{mean} {exponent}: {value}");
            }
            for alpha in [1e-4, 0.1, 1.0] {
                let value = shade::radiance(&mixture, Brdf::Ggx { alpha }, directions);
                assert!(value.is_finite() && value >= 0.0, "{mean} {alpha}: {value}");
            }
        }
    }
}

#[test]
fn settings_and_materials_out_of_range_are_refused() {
    let footprint = of(&[DVec3::Z]);
    for settings in [
        FitSettings { lobes: 0, ..four() },
        FitSettings { lobes: 7, ..four() },
        FitSettings { iterations: 1001, ..four() },
        FitSettings { sharpest: f64::NAN, ..four() },
    ] {
        let error = fit(&footprint, &settings).unwrap_err().to_string();
        assert!(error.contains("give"), "{error}");
    }
    for brdf in [Brdf::Ggx { alpha: 0.0 }, Brdf::BlinnPhong { exponent: -1.0 }, Brdf::Ggx { alpha: f64::NAN }]
    {
        assert!(brdf.check().is_err(), "{brdf:?}");
    }
    assert!(BRDFS.iter().all(|brdf| brdf.check().is_ok()));
    assert!(
        Directions::new(DVec3::ZERO, DVec3::Z).is_err() && Directions::new(DVec3::Z, DVec3::NAN).is_err()
    );
    assert!(Harmonics::new(0, &footprint).is_err() && Harmonics::new(9, &footprint).is_err());
}

#[test]
fn the_same_samples_give_the_same_bits() {
    let map = common::weave(64);
    let footprint = map.footprint(4, 1, 2).unwrap();
    assert_eq!(fit(&footprint, &four()).unwrap(), fit(&footprint, &four()).unwrap());
}

/// Four lobes that all are lobe `which` of a mixture.
fn lobes_of(mixture: &Mixture, which: usize) -> Vec<WeightedLobe> {
    let mean = mixture.lobes()[which].mean();
    vec![WeightedLobe { weight: 0.25, moment: 0.25 * mean }; 4]
}

#[test]
fn aligned_lobes_interpolate_like_with_like() {
    let map = common::weave(64);
    let [left, right] = [3, 4].map(|x| fit(&map.footprint(3, x, 2).unwrap(), &four()).unwrap());
    let lobes = right.lobes();
    let shuffled = Mixture::new(vec![lobes[2], lobes[0], lobes[3], lobes[1]]).unwrap();
    // The sharpness that interpolation leaves: the sum of the lengths of the moments.
    let sharpness =
        |a: &Mixture, b: &Mixture| a.mix(b, 0.5).lobes().iter().map(|l| l.moment.length()).sum::<f64>();
    let aligned = shuffled.aligned_to(&left);
    assert_eq!(aligned, right.aligned_to(&left), "the order they came in does not matter");
    let (before, after) = (sharpness(&left, &shuffled), sharpness(&left, &aligned));
    assert!(after > 0.98 && after > before + 0.05, "{before} before, {after} after");
    let mean = |mixture: &Mixture| mixture.lobes().iter().map(|l| l.moment).sum::<DVec3>();
    let expected = mean(&left).lerp(mean(&right), 0.5);
    assert!((mean(&left.mix(&aligned, 0.5)) - expected).length() < 1e-14);
    // Of fewer modes than places, each lies in its own, and the places of the others keep a trace.
    let first = Mixture::new(lobes_of(&right, 1)).unwrap().aligned_to(&right);
    assert!((first.lobes()[1].weight - 1.0).abs() < 1e-12, "{first:?}");
    assert!(first.lobes()[0].mean().distance(right.lobes()[0].mean()) < 1e-9, "{first:?}");
}
