//! A truth of the vertices' colours made of two independent halves, and how noisy it is itself.

use airglow_bake::Probe;
use airglow_math::statistics::{l2, percentile, relative_l2};

use crate::failure::{Failure, Outcome};
use crate::host::environment_samples::EnvironmentSamples;
use crate::host::truth;
use crate::output::Output;

/// Colours from two independent halves of the rays.
pub struct Truth {
    /// The mean of the halves.
    colours: Vec<[f32; 3]>,
    /// Relative L2 noise of the mean.
    noise: f64,
}

impl Truth {
    /// Traces `rays` for each vertex, half of them for each half.
    pub fn trace(
        name: &str,
        probe: &Probe<'_>,
        environment: &EnvironmentSamples<'_>,
        rays: u32,
        output: &Output,
    ) -> Outcome<Self> {
        let half = |seed| {
            output.say(format!("tracing the truth of {name}, half {} of 2, {} rays", seed + 1, rays / 2));
            truth::colours(name, probe, environment, rays / 2, seed, output)
        };
        Self::of_halves(&half(0), &half(1))
    }

    /// The mean of two independent estimates. Their difference has twice the variance of one, and their mean half of
    /// it: the noise of the mean is half the L2 norm of the difference.
    pub fn of_halves(a: &[[f32; 3]], b: &[[f32; 3]]) -> Outcome<Self> {
        let mean = |(a, b): (&[f32; 3], &[f32; 3])| [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]));
        let colours: Vec<[f32; 3]> = a.iter().zip(b).map(mean).collect();
        let difference = l2(&flat(a), &flat(b)).map_err(Failure::work)?;
        let size = norm(&colours);
        let noise = if size > 0.0 { 0.5 * difference / size } else { 0.0 };
        Ok(Self { colours, noise })
    }

    /// Relative L2 noise of the truth: the floor of the model error.
    pub fn noise(&self) -> f64 {
        self.noise
    }

    /// Root mean square error of all vertices over the root mean square colour, the truth's own noise subtracted in
    /// quadrature; 0 where the error is not above the noise.
    pub fn error(&self, colours: &[[f32; 3]]) -> Outcome<f64> {
        let whole = relative_l2(&flat(colours), &flat(&self.colours)).map_err(Failure::work)?;
        Ok((whole * whole - self.noise * self.noise).max(0.0).sqrt())
    }

    /// 95th percentile over vertices of the length of a vertex's error, over the root mean square colour. The truth's
    /// noise stays in it.
    pub fn error_p95(&self, colours: &[[f32; 3]]) -> Outcome<f64> {
        let rms = norm(&self.colours) / (self.colours.len() as f64).sqrt();
        let length = |(a, b): (&[f32; 3], &[f32; 3])| {
            (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>().sqrt() / rms.max(f64::MIN_POSITIVE)
        };
        let errors: Vec<f64> = colours.iter().zip(&self.colours).map(length).collect();
        percentile(&errors, 95.0).map_err(Failure::work)
    }
}

/// All channels in a row.
pub fn flat(colours: &[[f32; 3]]) -> Vec<f64> {
    colours.iter().flatten().map(|&value| f64::from(value)).collect()
}

fn norm(colours: &[[f32; 3]]) -> f64 {
    colours.iter().flatten().map(|&value| f64::from(value).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise with a known deviation, alternating signs; the error of a known offset comes back from under it.
    #[test]
    fn the_noise_of_the_truth_is_found_and_taken_away() {
        let count = 4000;
        let noise =
            |vertex: usize, stride: usize| if (vertex / stride).is_multiple_of(2) { 0.1 } else { -0.1 };
        let a: Vec<[f32; 3]> = (0..count).map(|v| [1.0 + noise(v, 1); 3]).collect();
        let b: Vec<[f32; 3]> = (0..count).map(|v| [1.0 + noise(v, 2); 3]).collect();
        let truth = Truth::of_halves(&a, &b).unwrap();
        // The mean of two independent estimates of deviation 0.1.
        let expected = 0.1 / 2.0_f64.sqrt();
        assert!((truth.noise() - expected).abs() < 1e-3, "{} instead of {expected}", truth.noise());
        let off = vec![[1.05; 3]; count];
        let error = truth.error(&off).unwrap();
        assert!((error - 0.05).abs() < 1e-3, "{error} instead of 0.05");
        assert!(truth.error(&vec![[1.0; 3]; count]).unwrap() < 1e-2, "no error is left at the truth");
    }

    /// One vertex in ten is far off: the percentile sees it as it is, the mean square dilutes it.
    #[test]
    fn the_percentile_sees_mottling() {
        let truth = Truth::of_halves(&[[1.0; 3]; 100], &[[1.0; 3]; 100]).unwrap();
        let mottled: Vec<[f32; 3]> = (0..100).map(|v| [if v % 10 == 0 { 1.5 } else { 1.0 }; 3]).collect();
        let (error, p95) = (truth.error(&mottled).unwrap(), truth.error_p95(&mottled).unwrap());
        let expected = 0.5 * 0.1_f64.sqrt();
        assert!((error - expected).abs() < 1e-6, "{error} instead of {expected}");
        assert!((p95 - 0.5).abs() < 1e-6, "{p95} instead of 0.5");
    }
}
