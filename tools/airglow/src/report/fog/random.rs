//! Random rays past a light, and the truth of their airlight by adaptive quadrature.

use std::f64::consts::PI;

use airglow::fog::Phase;
use airglow::fog::reference::airlight::{Sight, airlight};
use airglow::fog::rivals::Row;
use airglow_math::statistics::percentiles;

use crate::failure::{Failure, Outcome};
use crate::report::model::Distribution;

/// Where the truth is below this, errors are absolute.
pub const SMALLEST: f64 = 1e-30;

/// What inputs are drawn from; the light is a metre away. Logarithms are uniform, and so is the angle.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Optical distance of the light.
    pub optical: [f64; 2],
    /// Length of the ray over the light's distance.
    pub extent: [f64; 2],
    /// Share of rays without end.
    pub endless: f64,
    /// Angle between ray and light.
    pub gamma: [f64; 2],
}

impl Range {
    /// What the evaluator is held to.
    pub const WHOLE: Self =
        Self { optical: [1e-4, 100.0], extent: [1e-4, 1e4], endless: 0.09, gamma: [0.0, PI] };

    /// Where the thesis's table neither ends nor overflows.
    pub const OF_TABLE: Self =
        Self { optical: [0.01, 5.0], extent: [0.1, 10.0], endless: 0.09, gamma: [0.05, 3.0] };

    /// In words.
    pub fn words(&self) -> String {
        let Self { optical, extent, endless, gamma } = self;
        format!(
            "optical distance of the light log-uniform in {:e} to {:e}, length of the ray over the light's distance \
             log-uniform in {:e} to {:e} or, in {:.0} % of cases, without end, angle uniform in {:.2} to {:.4}",
            optical[0],
            optical[1],
            extent[0],
            extent[1],
            100.0 * endless,
            gamma[0],
            gamma[1]
        )
    }
}

/// One draw.
#[derive(Clone, Copy, Debug)]
pub struct Draw {
    /// Extinction, 1/m, as f32 has it.
    pub extinction: f64,
    /// Length of the ray, m, or infinite, as f32 has it.
    pub extent: f64,
    /// Angle at the eye.
    pub gamma: f64,
    /// Integral of exp(-extinction (x + d)) / d^2, 1/m.
    pub truth: f64,
}

/// `count` draws and their truths, always the same.
pub fn draws(range: &Range, count: usize) -> Outcome<Vec<Draw>> {
    let mut state = 88_172_645_463_325_252_u64;
    let mut uniform = || {
        // Xorshift (Marsaglia 2003).
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let between = |[low, high]: [f64; 2], at: f64| low * (high / low).powf(at);
    let mut draws: Vec<Draw> = (0..count)
        .map(|_| {
            let extinction = f64::from(between(range.optical, uniform()) as f32);
            let (kind, length) = (uniform(), uniform());
            let extent = match kind < range.endless {
                true => f64::INFINITY,
                false => f64::from(between(range.extent, length) as f32),
            };
            let gamma = range.gamma[0] + uniform() * (range.gamma[1] - range.gamma[0]);
            Draw { extinction, extent, gamma, truth: 0.0 }
        })
        .collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let results: Vec<Outcome> = std::thread::scope(|scope| {
        let chunks = draws.chunks_mut(count.div_ceil(threads).max(1));
        let workers: Vec<_> = chunks.map(|chunk| scope.spawn(|| fill(chunk))).collect();
        let panicked = |_| Err(Failure::work("a thread of the reference ended early"));
        workers.into_iter().map(|worker| worker.join().unwrap_or_else(panicked)).collect()
    });
    results.into_iter().collect::<Outcome<Vec<()>>>()?;
    Ok(draws)
}

fn fill(draws: &mut [Draw]) -> Outcome {
    for draw in draws {
        let sight = Sight::new(1.0, draw.gamma);
        let radiance = airlight(draw.extinction, sight, 0.0, draw.extent, Phase::Isotropic);
        draw.truth = 4.0 * PI * radiance.map_err(Failure::work)?;
    }
    Ok(())
}

impl Draw {
    /// As the evaluators take it.
    pub fn row(&self) -> Row {
        let (sine, cosine) = self.gamma.sin_cos();
        Row {
            extinction: [self.extinction as f32; 3],
            extent: self.extent.min(1e32) as f32,
            seen: [(-self.extinction).exp() as f32; 3],
            along: cosine as f32,
            off: sine as f32,
            weight: [1.0; 3],
        }
    }
}

/// How far `values` are from the draws' truths.
pub fn distribution(draws: &[Draw], values: impl IntoIterator<Item = f64>) -> Outcome<Distribution> {
    let (mut relative, mut below, mut bad) = (Vec::with_capacity(draws.len()), 0.0_f64, 0);
    for (draw, value) in draws.iter().zip(values) {
        let error = (value - draw.truth).abs();
        if !value.is_finite() || value < 0.0 {
            bad += 1;
        } else if draw.truth < SMALLEST {
            below = below.max(error);
        } else {
            relative.push(error / draw.truth);
        }
    }
    let at = percentiles(&relative, &[50.0, 99.0, 100.0]).map_err(Failure::work)?;
    Ok(Distribution { median: at[0], p99: at[1], largest: at[2], below, bad })
}
