//! Why the evaluator that ships does: the line of the curve, in words.

use crate::report::model::{Choice, Point};

/// The shipped setting among measured points, and how it stands to the closed form and to what is not slower.
pub fn of(points: &[Point], shipped: &str) -> Option<Choice> {
    let find = |setting: &str| points.iter().find(|point| point.setting == setting);
    let time = |setting: &str| Some(find(setting)?.time()?.median);
    let error = |setting: &str| find(setting)?.error.setting;
    let (mine, exact) = (time(shipped)?, time("taps 16")?);
    let [fast, fine] = [time("poles 4")? / mine, time("poles 7")? / exact];
    let verdict = match fast > 1.0 && fine > 1.0 {
        true => {
            "Taps alone: the closed form would be a second road, for isotropic and homogeneous media, and no faster."
        }
        false => {
            "Taps for every medium and phase function; on this device the closed form is faster where it applies."
        }
    };
    let reason = format!(
        "{verdict} {shipped} takes {mine:.3} ms at {:.1e}, taps 16 {exact:.3} ms at {:.1e}; the closed form \
         {:.3} ms at {:.1e} and {:.3} ms at {:.1e} ({:.1} and {:.1} times as \
         long as the taps of its error).",
        error(shipped)?,
        error("taps 16")?,
        time("poles 4")?,
        error("poles 4")?,
        time("poles 7")?,
        error("poles 7")?,
        fast,
        fine
    );
    Some(Choice { setting: shipped.to_owned(), reason })
}
