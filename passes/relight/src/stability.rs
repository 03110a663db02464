//! Extreme inputs with the GPU's result and the truth, and sweeps of each limit through its singularity.

mod sweep;
mod vertices;

use glam::DQuat;

use crate::RelightError;
use crate::bench::{Bench, Texels};
use crate::eval::{RotateRow, environment_sh, sh_rotate};

pub use sweep::{Sweep, SweepPoint, sweeps};

/// The bound on the relative L2 error of coefficient vectors.
pub const COEFFICIENT_BOUND: f64 = 1e-5;

/// One extreme input.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What is tried.
    pub name: String,
    /// The input in words.
    pub input: String,
    /// The GPU's result: the norm of the vector, a colour, or a refusal.
    pub result: String,
    /// The truth of the same.
    pub truth: String,
    /// The error, in the measure its bound is stated in; 0 for a refusal that came, infinite for one that did not.
    pub error: f64,
    /// The largest error allowed.
    pub bound: f64,
    /// How to run this input alone: an `airglow eval` row, or in words.
    pub reproduce: String,
}

impl Outcome {
    /// Whether the error is within its bound; NaN is not.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.error <= self.bound
    }
}

/// Runs every extreme input. `large` adds the mesh of two million vertices (a gigabyte of memory, seconds of time).
///
/// # Errors
/// [`RelightError::Gpu`] when the device fails; a wrong result is an [`Outcome`] that does not pass.
pub fn cases(bench: &Bench<'_>, large: bool) -> Result<Vec<Outcome>, RelightError> {
    let mut outcomes = environments(bench)?;
    outcomes.extend(rotations(bench)?);
    outcomes.push(refused_texels(bench));
    outcomes.extend(vertices::cases(bench, large)?);
    Ok(outcomes)
}

/// The Euclidean length of all values.
fn length<'v>(values: impl IntoIterator<Item = &'v f64>) -> f64 {
    values.into_iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// The relative L2 distance, or the length of the result where the truth is zero.
fn relative(values: &[f64], truth: &[f64]) -> f64 {
    let difference: Vec<f64> = values.iter().zip(truth).map(|(value, truth)| value - truth).collect();
    match length(truth) {
        0.0 => length(values),
        scale => length(&difference) / scale,
    }
}

fn environments(bench: &Bench<'_>) -> Result<Vec<Outcome>, RelightError> {
    // Directions of the last three: the pole, the seam behind the viewer, and the edge between +X and +Z of a cube.
    let maps = [
        ("one texel", 1, 1, 1.0, None),
        ("one column of 8192 texels", 1, 8192, 1.0, None),
        ("one row of 8192 texels", 8192, 1, 1.0, None),
        ("all zeros", 64, 32, 0.0, None),
        ("one texel of 1e5 at a pole", 64, 32, 0.01, Some((10, 0))),
        ("one texel of 1e5 at the seam", 64, 32, 0.01, Some((0, 16))),
        ("one texel of 1e5 at a cube edge", 64, 32, 0.01, Some((56, 16))),
    ];
    let mut outcomes = Vec::new();
    for (name, width, height, level, peak) in maps {
        let mut rgb = vec![[level; 3]; (width * height) as usize];
        if level > 0.0 {
            // A gentle ramp, so that no coefficient is zero by symmetry.
            for (i, texel) in rgb.iter_mut().enumerate() {
                *texel = texel.map(|value| value * (1.0 + (i % 97) as f32 / 97.0));
            }
        }
        if let Some((x, y)) = peak {
            rgb[(y * width + x) as usize] = [1e5; 3];
        }
        for (order, row) in
            [1, 6].into_iter().zip(environment_sh(bench, &[1, 6], &Texels { width, height, rgb: &rgb })?)
        {
            let row = row?;
            let (values, truth) = (row.values.concat(), row.reference.concat());
            outcomes.push(Outcome {
                name: format!("environment: {name}, order {order}"),
                input: format!("{width} x {height} texels of {level} to {}", 2.0 * level),
                result: format!("{:.9e}", length(&values)),
                truth: format!("{:.9e}", length(&truth)),
                error: relative(&values, &truth),
                bound: COEFFICIENT_BOUND,
                reproduce: format!("airglow eval environment-sh, order {order}, an image of that kind"),
            });
        }
    }
    Ok(outcomes)
}

/// Coefficients without symmetry: 1, -1/2, 1/3, …
fn coefficients(order: usize) -> Vec<f64> {
    (1..=order * order).map(|i| if i % 2 == 0 { -1.0 } else { 1.0 } / i as f64).collect()
}

/// The columns of an `sh-rotate` row.
fn rotate_row(row: &RotateRow) -> String {
    let f: Vec<String> = row.f.iter().map(f64::to_string).collect();
    let [x, y, z, w] = row.rotation.to_array();
    format!("order,f,qx,qy,qz,qw\n{},{},{x:e},{y:e},{z:e},{w:e}", row.order, f.join(";"))
}

fn rotations(bench: &Bench<'_>) -> Result<Vec<Outcome>, RelightError> {
    let quaternions = [
        ("identity", [0.0, 0.0, 0.0, 1.0]),
        ("half turn about x", [1.0, 0.0, 0.0, 0.0]),
        ("half turn about y", [0.0, 1.0, 0.0, 0.0]),
        ("half turn about z", [0.0, 0.0, 1.0, 0.0]),
        ("half turn about an odd axis", [0.36, -0.48, 0.8, 0.0]),
        ("length 1000", [100.0, -700.0, 500.0, 500.0]),
        ("length 1e-200", [1e-201, 7e-201, -5e-201, 5e-201]),
        ("zero", [0.0; 4]),
        ("not a number", [f64::NAN, 0.0, 0.0, 1.0]),
    ];
    let (mut rows, mut names) = (Vec::new(), Vec::new());
    for (name, q) in quaternions {
        for order in [1, 6] {
            rows.push(RotateRow { order, f: coefficients(order), rotation: DQuat::from_array(q) });
            names.push(format!("rotation: {name}, order {order}"));
        }
    }
    let results = sh_rotate(bench, &rows)?;
    let outcome = |((row, name), result): ((&RotateRow, String), Result<_, RelightError>)| {
        let refusal_due = !row.rotation.is_finite() || row.rotation == DQuat::from_array([0.0; 4]);
        let (result, truth, error) = match &result {
            Ok(crate::eval::Evaluated { values, reference }) => {
                let truth =
                    if refusal_due { "refused".to_owned() } else { format!("{:.9e}", length(reference)) };
                let error = if refusal_due { f64::INFINITY } else { relative(values, reference) };
                (format!("{:.9e}", length(values)), truth, error)
            }
            Err(reason) if refusal_due => (reason.to_string(), "refused".to_owned(), 0.0),
            Err(reason) => (reason.to_string(), "accepted".to_owned(), f64::INFINITY),
        };
        let (input, reproduce) = (format!("{}", row.rotation), rotate_row(row));
        Outcome { name, input, result, truth, error, bound: COEFFICIENT_BOUND, reproduce }
    };
    Ok(rows.iter().zip(names).zip(results).map(outcome).collect())
}

fn refused_texels(bench: &Bench<'_>) -> Outcome {
    let mut rgb = vec![[1.0; 3]; 64 * 32];
    rgb[7][0] = f32::NAN;
    rgb[77][1] = f32::INFINITY;
    rgb[777][2] = f32::NAN;
    let result = environment_sh(bench, &[4], &Texels { width: 64, height: 32, rgb: &rgb });
    let counted = matches!(result, Err(RelightError::Values { count: 3, first: 7, .. }));
    Outcome {
        name: "environment: NaN and infinite texels".to_owned(),
        input: "64 x 32 texels, three of them not finite, the first at 7".to_owned(),
        result: result.err().map_or_else(|| "accepted".to_owned(), |error| error.to_string()),
        truth: "refused, with the count 3".to_owned(),
        error: if counted { 0.0 } else { f64::INFINITY },
        bound: 0.0,
        reproduce: "airglow eval environment-sh on an image with NaN texels".to_owned(),
    }
}
