//! Error of what may be kept of a distribution, over random texels, levels, lights and views.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

mod common;

use airglow_math::statistics::relative_l2;
use airglow_normals::rivals::{self, Lean};
use airglow_normals::{Brdf, Directions, FitSettings, Harmonics, Method, Mixture, NormalMap, Sample};
use airglow_normals::{choose, fit, reference, shade};
use common::{Random, directions};

const BRDFS: [Brdf; 7] = [
    Brdf::Lambert,
    Brdf::BlinnPhong { exponent: 10.0 },
    Brdf::BlinnPhong { exponent: 50.0 },
    Brdf::BlinnPhong { exponent: 200.0 },
    Brdf::Ggx { alpha: 0.1 },
    Brdf::Ggx { alpha: 0.3 },
    Brdf::Ggx { alpha: 0.5 },
];

/// `vmf:4 x 4` is the radiance of the four texels of the level below, averaged: what four taps of a shader see.
const METHODS: [&str; 10] =
    ["mip", "length", "toksvig", "lean", "sh:3", "sh:5", "vmf:1", "vmf:4", "vmf:6", "vmf:4 x 4"];

/// How far from the mirror direction half of the rows look: about the width of the reflection.
fn spread(brdf: Brdf) -> f64 {
    match brdf {
        Brdf::Lambert => 0.5,
        Brdf::BlinnPhong { exponent } => 1.0 / exponent.sqrt(),
        Brdf::Ggx { alpha } => alpha / 2_f64.sqrt(),
    }
}

/// A footprint and what is kept of it.
struct Kept {
    footprint: Vec<Sample>,
    lean: Lean,
    harmonics: [Harmonics; 2],
    mixtures: [Mixture; 3],
    children: Vec<Mixture>,
}

impl Kept {
    fn new(map: &NormalMap, level: usize, [x, y]: [usize; 2]) -> Self {
        let footprint = map.footprint(level, x, y).unwrap();
        let fitted = |footprint: &[Sample], lobes| {
            fit(footprint, &FitSettings { lobes, ..Default::default() }).unwrap()
        };
        let child = |i: usize| map.footprint(level - 1, 2 * x + i % 2, 2 * y + i / 2).unwrap();
        let harmonics = |order| Harmonics::new(order, &footprint).unwrap();
        Self {
            lean: Lean::new(&footprint),
            harmonics: [harmonics(3), harmonics(5)],
            mixtures: [1, 4, 6].map(|lobes| fitted(&footprint, lobes)),
            children: (0..4).map(|i| fitted(&child(i), 4)).collect(),
            footprint,
        }
    }

    fn radiances(&self, brdf: Brdf, directions: Directions) -> [f64; METHODS.len()] {
        let mean = rivals::mean(&self.footprint);
        [
            rivals::mip(mean, true, brdf, directions),
            rivals::mip(mean, false, brdf, directions),
            rivals::toksvig(mean, brdf, directions),
            self.lean.radiance(brdf, directions),
            self.harmonics[0].radiance(brdf, directions).unwrap(),
            self.harmonics[1].radiance(brdf, directions).unwrap(),
            shade::radiance(&self.mixtures[0], brdf, directions),
            shade::radiance(&self.mixtures[1], brdf, directions),
            shade::radiance(&self.mixtures[2], brdf, directions),
            0.25 * self.children.iter().map(|child| shade::radiance(child, brdf, directions)).sum::<f64>(),
        ]
    }
}

/// Relative L2 errors of the methods, a row for each BRDF, printed under `name`.
fn errors(name: &str, map: &NormalMap, texels: usize, levels: [usize; 2]) -> Vec<[f64; METHODS.len()]> {
    let mut random = Random(11);
    let mut values = vec![[const { Vec::new() }; METHODS.len()]; BRDFS.len()];
    let mut truths = vec![Vec::new(); BRDFS.len()];
    for texel in 0..texels {
        let level = levels[0] + texel % (levels[1] - levels[0] + 1);
        let [width, height] = map.size(level);
        let kept = Kept::new(map, level, [random.below(width), random.below(height)]);
        for (i, &brdf) in BRDFS.iter().enumerate() {
            for row in 0..20 {
                let directions = directions(row, &kept.footprint, spread(brdf), &mut random);
                truths[i].push(reference::radiance(&kept.footprint, brdf, directions));
                for (values, value) in values[i].iter_mut().zip(kept.radiances(brdf, directions)) {
                    values.push(value);
                }
            }
        }
    }
    println!("{name}: {METHODS:?}");
    let row = |(i, values): (usize, &[Vec<f64>; METHODS.len()])| {
        let errors = values.each_ref().map(|values| relative_l2(values, &truths[i]).unwrap());
        println!("  {:?}: {}", BRDFS[i], errors.map(|e| format!("{:.2}%", 100.0 * e)).join("  "));
        errors
    };
    values.iter().enumerate().map(row).collect()
}

fn method(name: &str) -> usize {
    METHODS.iter().position(|method| *method == name).unwrap()
}

#[test]
fn four_lobes_on_maps_of_several_modes() {
    for (name, map) in [("groove", common::groove(256)), ("weave", common::weave(256))] {
        for (brdf, errors) in BRDFS.iter().zip(errors(name, &map, 28, [2, 6])) {
            let ours = errors[method("vmf:4")];
            let rival = errors[method("toksvig")].min(errors[method("lean")]);
            assert!(ours <= 0.05 && ours <= rival / 5.0, "{name}, {brdf:?}: {ours} against {rival}");
        }
    }
}

#[test]
fn four_lobes_on_a_map_of_one_mode() {
    for (brdf, errors) in BRDFS.iter().zip(errors("grain", &common::grain(256), 28, [2, 6])) {
        let (ours, lean) = (errors[method("vmf:4")], errors[method("lean")]);
        assert!(ours <= lean, "{brdf:?}: {ours} against {lean}");
    }
}

#[test]
fn measured_maps() {
    for name in ["rock_1024", "leather_1024", "flakes_1024", "ripples_1024"] {
        let Some(map) = common::measured(name) else { return };
        let errors = errors(name, &map, 28, [2, 7]);
        let lambert = errors[0];
        assert!(lambert[method("vmf:4")] <= 0.01, "{name}: {lambert:?}");
        let taps = errors.iter().map(|errors| errors[method("vmf:4 x 4")]);
        assert!(taps.clone().all(|error| error <= 0.08), "{name}, four taps: {:?}", taps.collect::<Vec<_>>());
    }
}

#[test]
fn a_material_gets_what_it_needs() {
    let glossy = Brdf::BlinnPhong { exponent: 50.0 };
    let flat = NormalMap::from_vectors(64, 64, &[[0.1, 0.2, 1.0]; 4096]).unwrap();
    for (name, map, brdf, expected) in [
        ("flat", &flat, glossy, Method::Lobes(1)),
        ("grain", &common::grain(64), Brdf::Lambert, Method::Lobes(1)),
        ("groove", &common::groove(64), glossy, Method::Lobes(2)),
        ("weave", &common::weave(64), glossy, Method::Lobes(4)),
    ] {
        let choice = choose(map, brdf, 0.04).unwrap();
        println!("{name}, {brdf:?}: {} with {:.2} %", choice.method, 100.0 * choice.error);
        assert!(choice.within && choice.method == expected, "{name}: {choice:?}");
        assert_eq!(choice.left_out.is_some(), expected != Method::Lobes(4), "{name}: {choice:?}");
    }
    let choice = choose(&common::grain(64), Brdf::BlinnPhong { exponent: 10_000.0 }, 0.01).unwrap();
    assert!(!choice.within && choice.error > 0.01 && choice.left_out.is_none(), "{choice:?}");
    assert!(choose(&flat, glossy, 0.0).is_err() && choose(&flat, Brdf::Ggx { alpha: 0.0 }, 0.1).is_err());
}
