//! Limits approached in logarithmic steps.

use airglow::shadow::{ShadowError, Sphere};
use glam::DVec3;

use super::super::SweepTable;
use super::{BOUND, Sky, Trial, error, open, wanted};

/// A limit: its name, its parameter, the values of it, and the sky at one.
struct Limit {
    name: &'static str,
    parameter: &'static str,
    values: Vec<f64>,
    sky: fn(f64) -> Vec<Sphere>,
}

fn limits() -> Vec<Limit> {
    let decades = |from: i32, to: i32| (2 * from..=2 * to).map(|half| 10.0_f64.powf(0.5 * f64::from(half)));
    vec![
        Limit {
            name: "a receiver leaves a sphere",
            parameter: "distance from the surface over the radius",
            values: decades(-7, 4).collect(),
            sky: |height| vec![Sphere { center: (1.0 + height) * DVec3::new(0.6, 0.8, 0.0), radius: 1.0 }],
        },
        Limit {
            name: "a receiver sinks into a sphere",
            parameter: "depth below the surface over the radius",
            values: decades(-7, -1).collect(),
            sky: |depth| vec![Sphere { center: (1.0 - depth) * DVec3::new(0.6, 0.8, 0.0), radius: 1.0 }],
        },
        Limit {
            name: "a sphere grows",
            parameter: "radius, 1 m before the receiver",
            values: decades(-8, 6).collect(),
            sky: |radius| vec![Sphere { center: (1.0 + radius) * DVec3::new(0.0, 0.6, -0.8), radius }],
        },
        Limit {
            name: "spheres gather in one place",
            parameter: "number of spheres of 20 degrees",
            values: [1, 2, 4, 6, 8, 12, 16, 24].map(f64::from).to_vec(),
            sky: |count| {
                let radius = 20.0_f64.to_radians().sin();
                vec![Sphere { center: DVec3::Z, radius }; count as usize]
            },
        },
        Limit {
            name: "two spheres become one",
            parameter: "angle between them over their radius of 30 degrees",
            values: decades(-6, 0).collect(),
            sky: |share| {
                let angle = share * 30.0_f64.to_radians();
                [0.0, angle]
                    .map(|a| Sphere { center: DVec3::new(a.sin(), 0.0, a.cos()), radius: 0.5 })
                    .to_vec()
            },
        },
    ]
}

/// All sweeps at orders 4 and 6, or the one called `only`.
pub fn tables(trial: &Trial<'_>, only: Option<&str>) -> Result<Vec<SweepTable>, ShadowError> {
    let mut tables = Vec::new();
    for order in [4, 6] {
        for limit in limits() {
            let name = format!("{}, order {order}", limit.name);
            if wanted(only, &name) {
                tables.push(table(trial, name, order, &limit)?);
            }
        }
    }
    Ok(tables)
}

fn table(trial: &Trial<'_>, name: String, order: usize, limit: &Limit) -> Result<SweepTable, ShadowError> {
    let (mut points, mut reproduce) = (Vec::new(), Vec::new());
    for &at in &limit.values {
        let sky = Sky { order, spheres: (limit.sky)(at), clamp: false };
        let (found, truth, _) = sky.visibility(trial)?;
        let error = error(&found, &truth);
        points.push([at, open(&found), open(&truth), error]);
        if error.is_nan() || error > BOUND {
            reproduce.push(sky.again(&name));
        }
    }
    Ok(SweepTable {
        pass: reproduce.is_empty(),
        name,
        parameter: limit.parameter.to_owned(),
        measure: "share of the sky that is open".to_owned(),
        bound: BOUND,
        points,
        reproduce,
    })
}
