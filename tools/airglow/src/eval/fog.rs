//! The evaluators of the fog pass: `fog-airlight`, `fog-surface`, `fog-psf`.

use airglow::fog::eval::surface::{self, SpreadRow, SurfaceRow};
use airglow::fog::eval::{self, AirlightRow, Evaluated};
use airglow::fog::{Bench, FogError, Phase, Preset};

use super::table::Table;
use super::{Columns, Settings, accepted, number, rejoin};
use crate::failure::{Failure, Outcome};

/// `fog-airlight`: beta, d_sv, d_vp, gamma and, if there, light_radius, phase and method in, radiance out.
pub fn airlight(bench: &Bench<'_>, table: &Table, settings: &Settings) -> Outcome<Columns> {
    let method = settings.get("method").map_or("default", String::as_str);
    preset(method).map_err(|problem| Failure::usage(format!("--set method: {problem}")))?;
    let read = |row| {
        let number = |column| table.number(row, column);
        Ok(AirlightRow {
            extinction: number("beta")?,
            light_distance: number("d_sv")?,
            gamma: number("gamma")?,
            distance: number("d_vp")?,
            radius: number::parse(table.word(row, "light_radius", "0")?)
                .map_err(|problem| format!("light_radius {problem}"))?,
            phase: phase(table.word(row, "phase", "isotropic")?)?,
            preset: preset(table.word(row, "method", method)?)?,
        })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    let results = eval::airlight(bench, &rows).map_err(Failure::work)?;
    Ok(joined(places, results))
}

/// `fog-surface`: t_sp, theta, n and, if there, method in, g out.
pub fn surface(bench: &Bench<'_>, table: &Table, settings: &Settings) -> Outcome<Columns> {
    let method = settings.get("method").map_or("default", String::as_str);
    fineness(method).map_err(|problem| Failure::usage(format!("--set method: {problem}")))?;
    let read = |row| {
        Ok(SurfaceRow {
            optical_distance: table.number(row, "t_sp")?,
            theta: table.number(row, "theta")?,
            exponent: table.number(row, "n")?,
            preset: fineness(table.word(row, "method", method)?)?,
        })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    Ok(joined(places, surface::surface(bench, &rows).map_err(Failure::work)?))
}

/// `fog-psf`: t_sv, gamma and, if there, method in, psf out.
pub fn spread(bench: &Bench<'_>, table: &Table, settings: &Settings) -> Outcome<Columns> {
    let method = settings.get("method").map_or("exact", String::as_str);
    factored(method).map_err(|problem| Failure::usage(format!("--set method: {problem}")))?;
    let read = |row| {
        Ok(SpreadRow {
            optical_distance: table.number(row, "t_sv")?,
            gamma: table.number(row, "gamma")?,
            factored: factored(table.word(row, "method", method)?)?,
        })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    Ok(joined(places, surface::spread(bench, &rows).map_err(Failure::work)?))
}

/// Rows of one number each.
fn joined(places: Vec<Result<(), String>>, results: Vec<Result<Evaluated, FogError>>) -> Columns {
    let rows =
        rejoin(places, results, |Evaluated { value, reference }| (vec![vec![value]], vec![vec![reference]]));
    Columns { rows }
}

/// How fine a table of a lobe is.
fn fineness(text: &str) -> Result<Preset, String> {
    match text {
        "default" | "table:64" => Ok(Preset::Default),
        "reference" | "table:256" => Ok(Preset::Reference),
        _ => Err(format!("method is `{text}`; expected default (table:64) or reference (table:256)")),
    }
}

/// Whether the point spread function is taken apart.
fn factored(text: &str) -> Result<bool, String> {
    match text {
        "exact" => Ok(false),
        "factored" => Ok(true),
        _ => Err(format!("method is `{text}`; expected exact or factored")),
    }
}

/// `isotropic`, `hg:g`, `poly:w0;w1;w2;w3` or `draine:g;alpha`.
fn phase(text: &str) -> Result<Phase, String> {
    let (name, values) = text.split_once(':').unwrap_or((text, ""));
    let refuse =
        || format!("phase is `{text}`; expected isotropic, hg:g, poly:w0;w1;w2;w3 or draine:g;alpha");
    if (name, values) == ("isotropic", "") {
        return Ok(Phase::Isotropic);
    }
    let values = number::parse_vector(values).map_err(|_| refuse())?;
    match (name, &values[..]) {
        ("hg", &[g]) => Ok(Phase::HenyeyGreenstein { g }),
        ("draine", &[g, alpha]) => Ok(Phase::Draine { g, alpha }),
        ("poly", &[a, b, c, d]) => Ok(Phase::Polynomial([a, b, c, d])),
        _ => Err(refuse()),
    }
}

/// `default` and `reference`, or what they are.
fn preset(text: &str) -> Result<Preset, String> {
    match text {
        "default" | "taps:6" => Ok(Preset::Default),
        "reference" | "taps:16" => Ok(Preset::Reference),
        _ => Err(format!("method is `{text}`; expected default (taps:6) or reference (taps:16)")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_and_methods_are_read_or_refused() {
        assert_eq!(phase("isotropic"), Ok(Phase::Isotropic));
        assert_eq!(phase("hg:-0.5"), Ok(Phase::HenyeyGreenstein { g: -0.5 }));
        assert_eq!(phase("poly:1;0;0;0.5"), Ok(Phase::Polynomial([1.0, 0.0, 0.0, 0.5])));
        assert_eq!(phase("draine:0.1;1"), Ok(Phase::Draine { g: 0.1, alpha: 1.0 }));
        for bad in ["", "hg", "hg:", "hg:1;2", "poly:1;2", "isotropic:1", "mie"] {
            assert!(phase(bad).unwrap_err().contains("expected isotropic"), "{bad}");
        }
        assert_eq!(preset("taps:16"), Ok(Preset::Reference));
        assert!(preset("table:64").unwrap_err().contains("expected default"));
        assert_eq!(fineness("table:256"), Ok(Preset::Reference));
        assert!(fineness("taps:6").unwrap_err().contains("expected default"));
        assert_eq!(factored("factored"), Ok(true));
        assert!(factored("").unwrap_err().contains("expected exact"));
    }
}
