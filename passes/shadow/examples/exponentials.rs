//! `cargo run --release -p airglow-shadow --example exponentials`: error of every exponential against the exact
//! projection of binary visibility, over the families of blockers, in f64; then that of the exact exponential, and the longest
//! logarithm, over the clip of eigenvalues.

use airglow_shadow::families::FAMILIES;
use airglow_shadow::reference::{Reference, rms, truth};
use airglow_shadow::{Exponential, ShadowError};

/// Scenes of a family.
const SCENES: u32 = 60;
/// Clips of eigenvalues, and scenes of each.
const CLIPS: [f64; 6] = [0.001, 0.005, 0.01, 0.02, 0.05, 0.1];
const CLIP_SCENES: u32 = 12;
/// Degree of the rule the truth is integrated by.
const DEGREE: usize = 300;

fn methods() -> Vec<(String, Exponential)> {
    let mut methods = vec![("exact".to_owned(), Exponential::Operator)];
    methods.push(("default".to_owned(), Exponential::Adaptive));
    methods.extend([3, 9].map(|degree| (format!("PS-{degree}"), Exponential::Series { degree })));
    let apart = |degree| (format!("PS-{degree}, mean apart"), Exponential::Horner { degree, norm: 1e9 });
    methods.extend([3, 9].map(apart));
    methods.extend([2, 9].map(|degree| (format!("PS*-{degree}"), Exponential::ScaledSeries { degree })));
    methods.push(("squares".to_owned(), Exponential::Horner { degree: 2, norm: 0.25 }));
    methods.push(("OL".to_owned(), Exponential::OptimalLinear));
    methods.extend([0.25, 1.0, 4.8].map(|t| (format!("HYB {t}"), Exponential::Hybrid { threshold: t })));
    methods
}

fn main() -> Result<(), ShadowError> {
    for order in 3..=6 {
        let reference = Reference::new(order)?;
        println!("order {order}: mean and largest RMS error over the sphere, {SCENES} scenes; largest |f^|");
        for family in FAMILIES {
            let mut errors = vec![(0.0, 0.0_f64); methods().len() + 1];
            let mut norm = 0.0_f64;
            for scene in 0..SCENES {
                let caps = family.scene(scene)?;
                let exact = truth(order, DEGREE, &caps)?;
                let logarithm = reference.log_visibility(&caps)?;
                norm = norm.max(logarithm[1..].iter().map(|f| f * f).sum::<f64>().sqrt());
                let mut add = |at: usize, found: &[f64]| {
                    let error = rms(found, &exact);
                    errors[at].0 += error / f64::from(SCENES);
                    errors[at].1 = errors[at].1.max(error);
                };
                add(0, &reference.chain(&caps)?);
                for (at, (_, method)) in methods().into_iter().enumerate() {
                    add(at + 1, &reference.evaluator().exponential(method, &logarithm)?);
                }
            }
            println!("  {}, |f^| up to {norm:.1}", family.name);
            let names =
                ["products".to_owned()].into_iter().chain(methods().into_iter().map(|method| method.0));
            for (name, (mean, largest)) in names.zip(errors) {
                println!("    {name:16} {mean:.4}  {largest:.4}");
            }
        }
    }
    for order in [4, 6] {
        clips(order)?;
    }
    Ok(())
}

/// The exact exponential over the clip.
fn clips(order: usize) -> Result<(), ShadowError> {
    println!(
        "order {order}: mean RMS error of the exact exponential, largest |f^|, {CLIP_SCENES} scenes, by clip {CLIPS:?}"
    );
    for family in FAMILIES {
        let mut line = String::new();
        for clip in CLIPS {
            let reference = Reference::with_clip(order, clip)?;
            let (mut error, mut norm) = (0.0, 0.0_f64);
            for scene in 0..CLIP_SCENES {
                let caps = family.scene(scene)?;
                let logarithm = reference.log_visibility(&caps)?;
                let found = reference.evaluator().exponential(Exponential::Operator, &logarithm)?;
                error += rms(&found, &truth(order, DEGREE, &caps)?) / f64::from(CLIP_SCENES);
                norm = norm.max(logarithm[1..].iter().map(|f| f * f).sum::<f64>().sqrt());
            }
            line += &format!("  {error:.4} {norm:5.1}");
        }
        println!("  {:20}{line}", family.name);
    }
    Ok(())
}
