//! Errors of the single-precision evaluators of airlight against adaptive quadrature, over random configurations.
//!
//! ```text
//! cargo run --release -p airglow-fog --example evaluators -- 1000000
//! ```
//!
//! Optical distance log-uniform in 1e-4 to 100, the stretch over the light's distance log-uniform in 1e-4 to 1e4 or
//! endless, the angle uniform. Relative errors where the truth is at least 1e-30, absolute ones below; the table of the
//! thesis and uniform marching beside them.

use std::error::Error;
use std::f64::consts::PI;

use airglow_fog::Phase;
use airglow_fog::evaluator::{INFINITE, Light, Segment, poles, taps, transmittance};
use airglow_fog::reference::airlight::{Sight, airlight};
use airglow_fog::reference::table::{Filter, Table};
use airglow_math::statistics::percentile;

/// Where the truth is below this, the error is absolute.
const SMALLEST: f64 = 1e-30;

/// A light of distance 1, so that the extinction is its optical distance.
struct Configuration {
    extinction: f32,
    gamma: f64,
    /// Length of the ray, [`f32::INFINITY`] for an endless one.
    far: f32,
    truth: f64,
}

impl Configuration {
    /// As a shader has it: rounded cosine and sine.
    fn segment(&self) -> Segment {
        let (sine, cosine) = self.gamma.sin_cos();
        let light = Light { distance: 1.0, along: cosine as f32, offset: sine as f32, radius: 0.0 };
        Segment::new(light, 0.0, self.far.min(INFINITE))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let count = std::env::args().nth(1).map_or(Ok(20_000), |text| text.parse())?;
    let configurations = configurations(count)?;
    println!("{count} configurations; relative error, and absolute where the truth is below {SMALLEST:e}");
    println!(
        "{:24} {:>9} {:>9} {:>9} {:>9} {:>9} bad",
        "evaluator", "median", "p99", "p99.9", "max", "below"
    );
    let report =
        |name: &str, evaluate: &dyn Fn(&Configuration) -> f32| report(name, &configurations, evaluate);
    for (name, precision) in [("poles, default", poles::DEFAULT), ("poles, reference", poles::REFERENCE)] {
        report(name, &|c| {
            let segment = c.segment();
            transmittance(c.extinction, segment.path) * poles::kernel(segment, c.extinction, precision)
        });
    }
    for (name, rule) in [("taps, default", taps::DEFAULT), ("taps, reference", taps::REFERENCE)] {
        report(name, &|c| {
            let segment = c.segment();
            transmittance(c.extinction, segment.path)
                * taps::kernel(segment, c.extinction, rule, 0.0, |_| 1.0)
        });
    }
    for size in [16, 64, 256] {
        let table = Table::new(size, 0)?;
        for (name, filter) in [("nearest", Filter::Nearest), ("bilinear", Filter::Bilinear)] {
            let name = format!("table {size}², {name}");
            report(&name, &|c| table.airlight(c.extinction, 1.0, c.gamma as f32, c.far, filter));
        }
    }
    for steps in [64, 1024] {
        report(&format!("march, {steps} steps"), &|c| march(c, steps));
    }
    Ok(())
}

/// The configurations with their truths, deterministic.
fn configurations(count: usize) -> Result<Vec<Configuration>, Box<dyn Error>> {
    let mut state = 88_172_645_463_325_252_u64;
    let mut uniform = || {
        // Xorshift (Marsaglia 2003).
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut configurations = Vec::with_capacity(count);
    for _ in 0..count {
        let extinction = 10_f64.powf(-4.0 + 6.0 * uniform()) as f32;
        let length = 1.1 * uniform();
        let far = if length < 1.0 { 10_f64.powf(-4.0 + 8.0 * length) as f32 } else { f32::INFINITY };
        let gamma = PI * uniform();
        let sight = Sight::new(1.0, gamma);
        let radiance = airlight(f64::from(extinction), sight, 0.0, f64::from(far), Phase::Isotropic)?;
        configurations.push(Configuration { extinction, gamma, far, truth: 4.0 * PI * radiance });
    }
    Ok(configurations)
}

/// The midpoint rule with equal steps along the ray, cut where e^-20 is left.
fn march(c: &Configuration, steps: u32) -> f32 {
    let (sine, cosine) = (c.gamma.sin() as f32, c.gamma.cos() as f32);
    let length = c.far.min(1.0 + 20.0 / c.extinction);
    let step = length / steps as f32;
    let sum: f32 = (0..steps)
        .map(|i| {
            let x = (i as f32 + 0.5) * step;
            let square = sine * sine + (x - cosine) * (x - cosine);
            (-c.extinction * (x + square.sqrt())).exp() / square
        })
        .sum();
    step * sum
}

fn report(name: &str, configurations: &[Configuration], evaluate: &dyn Fn(&Configuration) -> f32) {
    let (mut relative, mut below, mut bad) = (Vec::new(), 0.0_f64, 0_u32);
    for configuration in configurations {
        let value = f64::from(evaluate(configuration));
        let error = (value - configuration.truth).abs();
        if !value.is_finite() || value < 0.0 {
            bad += 1;
        } else if configuration.truth < SMALLEST {
            below = below.max(error);
        } else {
            relative.push(error / configuration.truth);
        }
    }
    let at = |percent| percentile(&relative, percent).unwrap_or(f64::NAN);
    let [median, p99, p999, largest] = [50.0, 99.0, 99.9, 100.0].map(at);
    println!("{name:24} {median:9.1e} {p99:9.1e} {p999:9.1e} {largest:9.1e} {below:9.1e} {bad}");
}
