//! What surfaces reflect of the glow about a lamp, at the ends of exponents and distances.

use std::f64::consts::PI;

use super::Outcome;
use crate::bench::Bench;
use crate::eval::surface::{SurfaceRow, surface};
use crate::{FogError, Preset};

pub(super) fn cases(bench: &Bench<'_>, chosen: impl Fn(&str) -> bool) -> Result<Vec<Outcome>, FogError> {
    let mut named = Vec::new();
    for exponent in [1.0, 2.0, 30.0, 1000.0] {
        for optical_distance in [1e-8, 1e-4, 0.1, 5.0, 50.0, 1e3] {
            for theta in [0.0, 1e-4, 1.0, PI] {
                let name = format!(
                    "glow in a lobe of exponent {exponent}, {theta} from it, T_sp {optical_distance:e}"
                );
                let row = SurfaceRow { optical_distance, theta, exponent, preset: Preset::Reference };
                named.push((name, row));
            }
        }
    }
    named.retain(|(name, _)| chosen(name));
    let rows: Vec<SurfaceRow> = named.iter().map(|(_, row)| *row).collect();
    let found = surface(bench, &rows)?;
    let join = |((name, row), found): ((String, SurfaceRow), Result<_, FogError>)| {
        let crate::eval::Evaluated { value, reference } = found?;
        Ok(Outcome::of_value(name, format!("{row:?}"), value, reference))
    };
    named.into_iter().zip(found).map(join).collect()
}
