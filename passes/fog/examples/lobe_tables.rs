//! Errors of bilinear tables of the glow through a lobe, and of the single-precision quadrature that fills them, against
//! adaptive quadrature.
//!
//! ```text
//! cargo run --release -p airglow-fog --example lobe_tables
//! ```

use std::error::Error;
use std::f64::consts::PI;

use airglow_fog::evaluator::lobe;
use airglow_fog::reference::surface::scaled_lobe_glow;
use airglow_math::sequence::hammersley;
use airglow_math::statistics::percentiles;

fn main() -> Result<(), Box<dyn Error>> {
    println!("relative errors over optical distances from 1e-3 to 80 and all angles");
    for exponent in [1.0_f32, 10.0, 100.0, 1000.0] {
        let mut places = Vec::new();
        for i in 0..200 {
            let [u, v] = hammersley(i, 200);
            let (optical, theta) = (10_f64.powf(-3.0 + 4.9 * u), PI * v);
            let truth = scaled_lobe_glow(optical, theta, f64::from(exponent))?;
            places.push((optical as f32, (2.0 * (0.5 * theta).sin()) as f32, truth));
        }
        report(&format!("exponent {exponent}, quadrature"), &places, |optical, chord| {
            lobe::scaled_glow(optical, chord, exponent)
        })?;
        for size in [16, 32, 64, 128] {
            let table = table(size, exponent);
            report(&format!("exponent {exponent}, {size}²"), &places, |optical, chord| {
                bilinear(&table, size, lobe::coordinates(optical, chord, exponent)).exp()
            })?;
        }
    }
    Ok(())
}

/// Entries row by row of the distance.
fn table(size: usize, exponent: f32) -> Vec<f32> {
    let last = (size - 1) as f32;
    let entry = |i: usize| {
        let [chord, distance] = lobe::place([(i % size) as f32 / last, (i / size) as f32 / last], exponent);
        lobe::entry(distance, chord, exponent)
    };
    (0..size * size).map(entry).collect()
}

fn bilinear(table: &[f32], size: usize, coordinates: [f32; 2]) -> f32 {
    let [x, y] = coordinates.map(|c| c.clamp(0.0, 1.0) * (size - 1) as f32);
    let (column, row) = ((x as usize).min(size - 2), (y as usize).min(size - 2));
    let (x, y) = (x - column as f32, y - row as f32);
    let mix = |row: usize| {
        let at = row * size + column;
        table[at] + x * (table[at + 1] - table[at])
    };
    mix(row) + y * (mix(row + 1) - mix(row))
}

fn report(
    name: &str,
    places: &[(f32, f32, f64)],
    evaluate: impl Fn(f32, f32) -> f32,
) -> Result<(), Box<dyn Error>> {
    let errors: Vec<f64> = places
        .iter()
        .map(|(optical, chord, truth)| (f64::from(evaluate(*optical, *chord)) / truth - 1.0).abs())
        .collect();
    let [median, p99, largest] = percentiles(&errors, &[50.0, 99.0, 100.0])?[..] else { return Ok(()) };
    println!("{name:32} median {median:8.1e}  p99 {p99:8.1e}  max {largest:8.1e}");
    Ok(())
}
