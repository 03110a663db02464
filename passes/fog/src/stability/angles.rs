//! Angles, distances and optical distances at the ends of the domain.

use std::f64::consts::PI;

use crate::eval::AirlightRow;
use crate::medium::MAX_G;
use crate::{Phase, Preset};

/// An isotropic row at the reference preset with a point light.
pub(super) fn row(extinction: f64, light_distance: f64, gamma: f64, distance: f64) -> AirlightRow {
    let (phase, preset) = (Phase::Isotropic, Preset::Reference);
    AirlightRow { extinction, light_distance, gamma, distance, radius: 0.0, phase, preset }
}

/// Every row with its name.
pub(super) fn rows() -> Vec<(String, AirlightRow)> {
    let mut rows = Vec::new();
    let angles = [0.0, 1e-7, 1e-4, 1.0, PI - 1e-7, PI];
    for gamma in angles {
        for distance in [5.0, 20.0, f64::INFINITY] {
            for optical in [1e-8, 1.0, 40.0, 1e3] {
                let name =
                    format!("angle {gamma:.7e}, surface at {distance} m, light at 10 m, T {optical:e}");
                rows.push((name, row(optical / 10.0, 10.0, gamma, distance)));
            }
        }
    }
    for gamma in [0.0, 1e-4, 1.0, PI] {
        // A power of two, so that f32 has the place of the light.
        for gap in [-0.5_f64.powi(13), 0.0, 0.5_f64.powi(13)] {
            let name = format!("light {gap:e} m before the surface, angle {gamma}");
            rows.push((name, row(0.1, 10.0 - gap, gamma, 10.0)));
        }
        for near in [1e-4, 1e-6] {
            rows.push((format!("light {near:e} m from the eye, angle {gamma}"), row(0.1, near, gamma, 50.0)));
        }
        for extinction in [1e-3, 0.1] {
            let name =
                format!("a millimetre of ray a kilometre away, angle {gamma}, extinction {extinction}");
            rows.push((name, row(extinction, 1e3, gamma, 1e-3)));
        }
        rows.push((format!("extinction 0, angle {gamma}"), row(0.0, 10.0, gamma, 5.0)));
        rows.push((
            format!("a lamp of 0.1 m at the eye, angle {gamma}"),
            AirlightRow { radius: 0.1, ..row(0.1, 0.0, gamma, 50.0) },
        ));
        rows.push((
            format!("a lamp of 0.1 m, angle {gamma}"),
            AirlightRow { radius: 0.1, ..row(0.1, 10.0, gamma, 50.0) },
        ));
        rows.push((format!("a ray of no length, angle {gamma}"), row(0.1, 10.0, gamma, 0.0)));
    }
    for phase in [
        Phase::HenyeyGreenstein { g: 0.8 },
        Phase::HenyeyGreenstein { g: -0.8 },
        Phase::HenyeyGreenstein { g: MAX_G },
        Phase::HenyeyGreenstein { g: -MAX_G },
        Phase::Draine { g: 0.0, alpha: 1.0 },
        Phase::Draine { g: 0.99, alpha: 1.0 },
        Phase::Polynomial([0.25 / PI, -0.2 / PI, 0.0, 0.0]),
    ] {
        for gamma in [1e-4, 1.0, PI - 1e-4] {
            rows.push((
                format!("{phase:?}, angle {gamma}"),
                AirlightRow { phase, ..row(0.1, 10.0, gamma, f64::INFINITY) },
            ));
        }
    }
    rows
}
