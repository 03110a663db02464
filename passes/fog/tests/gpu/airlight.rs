//! The pass's functions on the device against quadrature in f64, over the whole domain.

use std::f64::consts::PI;

use airglow_fog::eval::{AirlightRow, airlight};
use airglow_fog::{Bench, Fog, MAX_G, Phase, Preset, Settings};
use airglow_gpu::{GpuError, Recorder};
use airglow_tests::device::{Fixture, fixture_with};

/// Numbers from 0 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        // Steele, Lea and Flood 2014: SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.next())
    }
}

/// Optical distances of the light from 1e-4 to 100, surfaces from 1e-4 to 1e4 times as far or none, any angle.
fn rows(count: usize, preset: Preset, phase: impl Fn(&mut Numbers) -> Phase) -> Vec<AirlightRow> {
    let mut numbers = Numbers(7);
    (0..count)
        .map(|_| {
            let light_distance = numbers.logarithmic(1e-2, 1e3);
            let extinction = numbers.logarithmic(1e-4, 100.0) / light_distance;
            let ratio = numbers.logarithmic(1e-4, 1e4);
            let distance = if numbers.next() < 0.2 { f64::INFINITY } else { ratio * light_distance };
            let gamma = PI * numbers.next();
            let phase = phase(&mut numbers);
            AirlightRow { extinction, light_distance, gamma, distance, radius: 0.0, phase, preset }
        })
        .collect()
}

/// Relative errors where the truth is at least 1e-30, ascending; absolute below.
fn errors(fixture: &Fixture, rows: &[AirlightRow]) -> Vec<f64> {
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let mut errors = Vec::new();
    for (row, result) in rows.iter().zip(airlight(&bench, rows).unwrap()) {
        let result = result.unwrap();
        assert!(result.value.is_finite() && result.value >= 0.0, "{row:?}: {result:?}");
        let difference = (result.value - result.reference).abs();
        if result.reference >= 1e-30 {
            errors.push(difference / result.reference);
        } else {
            // Lobes may err by their relative error there, too.
            let share = if row.phase == Phase::Isotropic { 0.0 } else { 1e-3 * result.reference };
            let sound = difference <= share.max(1e-36) || row.preset == Preset::Default;
            assert!(sound, "{row:?}: {result:?}");
        }
    }
    errors.sort_by(f64::total_cmp);
    errors
}

fn assert_errors(name: &str, errors: &[f64], p99: f64, most: f64) {
    let [found, worst] = [errors[errors.len() * 99 / 100], errors[errors.len() - 1]];
    println!(
        "{name}: {} rows, median {:.1e}, p99 {found:.1e}, worst {worst:.1e}",
        errors.len(),
        errors[errors.len() / 2]
    );
    assert!(found <= p99 && worst <= most, "{name}: p99 {found:e} of {p99:e}, worst {worst:e} of {most:e}");
}

#[test]
fn both_presets_keep_their_error_over_the_whole_domain() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let of = |preset| errors(&fixture, &rows(20_000, preset, |_| Phase::Isotropic));
    assert_errors("default", &of(Preset::Default), 1e-3, 2e-3);
    assert_errors("reference", &of(Preset::Reference), 1e-5, 1e-3);
}

#[test]
fn every_phase_function_keeps_the_error() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let polynomial = |numbers: &mut Numbers| {
        let [a, b, c] = [0; 3].map(|_| 0.3 * (2.0 * numbers.next() - 1.0));
        Phase::Polynomial([1.0, a, b, c].map(|weight| weight / (4.0 * PI)))
    };
    let lobe = |numbers: &mut Numbers| Phase::HenyeyGreenstein { g: 1.8 * numbers.next() - 0.9 };
    let draine =
        |numbers: &mut Numbers| Phase::Draine { g: 1.8 * numbers.next() - 0.9, alpha: 2.0 * numbers.next() };
    let reference = Preset::Reference;
    assert_errors("polynomial", &errors(&fixture, &rows(5000, reference, polynomial)), 1e-5, 1e-3);
    assert_errors("Henyey-Greenstein", &errors(&fixture, &rows(5000, reference, lobe)), 1e-4, 1e-3);
    assert_errors("Draine", &errors(&fixture, &rows(5000, reference, draine)), 1e-4, 1e-3);
    for size in [0.9, 0.99, MAX_G] {
        for g in [size, -size] {
            let peak = |_: &mut Numbers| Phase::HenyeyGreenstein { g };
            assert_errors(&format!("g {g}"), &errors(&fixture, &rows(1000, reference, peak)), 4e-4, 1e-3);
            let six = errors(&fixture, &rows(1000, Preset::Default, peak));
            assert_errors(&format!("g {g}, default"), &six, 8e-3, 2e-2);
        }
    }
}
