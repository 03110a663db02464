//! Tables of lobes and the spread function, built and read on the device, against quadrature in f64.

use std::f64::consts::PI;

use airglow_fog::eval::Evaluated;
use airglow_fog::eval::complete::{CompleteRow, radiance};
use airglow_fog::eval::surface::{SpreadRow, SurfaceRow, spread, surface};
use airglow_fog::reference::surface::Surface;
use airglow_fog::{Bench, Fog, FogError, Preset, Settings};
use airglow_gpu::{GpuError, Recorder};
use airglow_math::sequence::hammersley;
use airglow_tests::device::{Fixture, fixture_with};
use glam::DVec3;

fn with_bench<T>(evaluate: impl Fn(&Bench<'_>) -> T) -> T {
    let fixture: Fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    evaluate(&Bench { context: fixture.context(), run: &run })
}

/// Largest relative error; all results are finite and not negative.
fn worst(name: &str, results: &[Result<Evaluated, FogError>]) -> f64 {
    let mut errors: Vec<f64> = Vec::new();
    for result in results {
        let Evaluated { value, reference } = *result.as_ref().unwrap();
        assert!(value.is_finite() && value >= 0.0, "{name}: {value} for {reference}");
        if reference > 1e-30 {
            errors.push((value / reference - 1.0).abs());
        }
    }
    errors.sort_by(f64::total_cmp);
    let [median, p99, most] =
        [errors.len() / 2, errors.len() * 99 / 100, errors.len() - 1].map(|place| errors[place]);
    println!("{name}: {} rows, median {median:.1e}, p99 {p99:.1e}, worst {most:.1e}", errors.len());
    most
}

fn rows(preset: Preset, exponent: f64, count: u32) -> Vec<SurfaceRow> {
    let row = |i| {
        let [u, v] = hammersley(i, count).map(f64::from);
        let optical_distance = 10_f64.powf(-4.0 + 5.8 * u);
        SurfaceRow { optical_distance, theta: PI * v, exponent, preset }
    };
    (0..count).map(row).collect()
}

#[test]
fn the_glow_through_every_lobe_keeps_its_error_over_all_distances_and_angles() {
    with_bench(|bench| {
        for exponent in [1.0, 2.0, 10.0, 100.0, 1000.0] {
            let of = |preset| {
                let results = surface(bench, &rows(preset, exponent, 150)).unwrap();
                worst(&format!("exponent {exponent}, {preset:?}"), &results)
            };
            assert!(of(Preset::Default) < 6e-3, "exponent {exponent}");
            assert!(of(Preset::Reference) < 6e-4, "exponent {exponent}");
        }
    });
}

#[test]
fn extreme_rows_have_their_limits() {
    with_bench(|bench| {
        let mut rows = Vec::new();
        for exponent in [1.0, 1000.0] {
            for optical_distance in [1e-30, 1e-8, 1e-6, 1e-3, 90.0] {
                for theta in [0.0, 1e-6, PI / 2.0 - 1e-6, PI / 2.0, PI] {
                    rows.push(SurfaceRow { optical_distance, theta, exponent, preset: Preset::Reference });
                }
            }
        }
        assert!(worst("extreme", &surface(bench, &rows).unwrap()) < 2e-3);
        // So far away that nothing arrives.
        let far = SurfaceRow { optical_distance: 1e4, theta: 0.3, exponent: 1.0, preset: Preset::Default };
        assert_eq!(surface(bench, &[far]).unwrap()[0].as_ref().unwrap().value, 0.0);
    });
}

#[test]
fn the_spread_function_is_the_reference_in_both_forms() {
    with_bench(|bench| {
        for factored in [false, true] {
            let mut rows = Vec::new();
            for i in 0..2000 {
                let [u, v] = hammersley(i, 2000).map(f64::from);
                let optical_distance = 10_f64.powf(-6.0 + 7.8 * u);
                rows.push(SpreadRow { optical_distance, gamma: PI * v.max(1e-4), factored });
            }
            for gamma in [1e-7, 1e-4, PI - 1e-7, PI] {
                rows.push(SpreadRow { optical_distance: 1.0, gamma, factored });
            }
            assert!(worst(&format!("factored {factored}"), &spread(bench, &rows).unwrap()) < 1e-5);
        }
    });
}

#[test]
fn rows_out_of_range_are_refused_and_the_others_run() {
    with_bench(|bench| {
        let row = |optical_distance, theta, exponent| {
            let preset = Preset::Default;
            SurfaceRow { optical_distance, theta, exponent, preset }
        };
        let rows = [row(-1.0, 0.0, 1.0), row(1.0, 4.0, 1.0), row(1.0, 1.0, 0.2), row(1.0, 1.2, 1.0)];
        let results = surface(bench, &rows).unwrap();
        for (result, word) in results.iter().zip(["t_sp", "theta", "exponent"]) {
            assert!(result.as_ref().unwrap_err().to_string().contains(word));
        }
        // G_0 as published.
        let published = results[3].as_ref().unwrap().value;
        assert!((published / 0.874_888 - 1.0).abs() < 3e-3, "{published}");
        let at_the_light = SpreadRow { optical_distance: 1.0, gamma: 0.0, factored: false };
        assert!(spread(bench, &[at_the_light]).unwrap()[0].is_err());
    });
}

#[test]
fn the_complete_model_of_a_surface_is_the_reference() {
    with_bench(|bench| {
        let mut rows = Vec::new();
        for (exponent, extinction) in [(1.0, 1e-6), (12.0, 0.05), (1000.0, 0.4)] {
            for i in 0..12 {
                let [u, v] = hammersley(i, 12).map(f64::from);
                let normal = DVec3::new(u - 0.5, v - 0.3, 0.4).normalize();
                rows.push(CompleteRow {
                    lamp: DVec3::new(3.0 * v - 1.0, 1.0 + u, -2.0),
                    place: DVec3::new(2.0 * u - 1.0, 0.3 - v, -4.0),
                    normal,
                    surface: Surface { diffuse: 0.2, specular: 0.5, exponent },
                    extinction: [1.0, 1.3, 0.4].map(|factor| factor * extinction),
                    scattering: [0.9, 1.0, 0.4].map(|factor| factor * extinction),
                });
            }
        }
        let mut worst = 0.0_f64;
        for (row, values) in rows.iter().zip(radiance(bench, &rows).unwrap()) {
            for (value, truth) in values.into_iter().zip(row.reference().unwrap()) {
                let error = (value - truth).abs() / truth;
                assert!(error < 5e-4, "{row:?}: {value} and {truth}");
                worst = worst.max(error);
            }
        }
        println!("complete model: worst {worst:.1e}");
    });
}
