//! Extreme emitters and the limits of samples, as `airglow stability radiance` runs them.

use airglow_radiance::eval::{CubeRow, Method, cubes};
use airglow_radiance::gpu::Texels;
use airglow_radiance::{PassSettings, Radiance, RadianceError, Triangle, stability};
use glam::DVec3;

use crate::with_bench;

#[test]
fn extremes_and_limits_are_those_of_the_truth() {
    with_bench(&Texels::requirements(), |bench| {
        for outcome in stability::cases(bench, None).unwrap() {
            assert!(outcome.pass(), "{outcome:?}");
        }
        let name = "closed form: a corner comes to touch the point";
        for sweep in stability::sweeps(bench, Some(name)).unwrap() {
            assert!(sweep.pass(), "{:?}", sweep.points);
        }
        assert!(stability::cases(bench, Some("no such case")).unwrap().is_empty());
    });
}

#[test]
fn frames_of_extreme_receivers_pass() {
    let requirements = Radiance::requirements(&PassSettings::default());
    let outcomes = with_bench(&requirements, |bench| stability::frames(bench, None, false).unwrap());
    assert!(outcomes.len() > 15, "{}", outcomes.len());
    for outcome in outcomes {
        println!("{outcome:?}");
        assert!(outcome.pass(), "{outcome:?}");
    }
}

#[test]
fn rows_are_sampled_or_refused() {
    let triangle = |z: f64| Triangle {
        corners: [DVec3::new(-0.5, -0.4, z), DVec3::new(0.6, -0.5, z), DVec3::new(0.1, 0.7, z)],
        radiance: DVec3::new(2.0, 1.0, 0.0),
    };
    let row = |order, face, rays, method| CubeRow {
        order,
        face,
        rays,
        point: DVec3::new(0.1, 0.0, 0.2),
        triangles: vec![triangle(-1.0)],
        method,
    };
    let overlapping = |row: CubeRow| CubeRow { triangles: vec![triangle(-1.0), triangle(-2.0)], ..row };
    let rows = [
        row(1, 11, 1, Method::Cube),
        row(2, 16, 2, Method::Analytic),
        row(4, 16, 4, Method::Cube),
        overlapping(row(4, 16, 2, Method::Cube)),
        overlapping(row(4, 16, 2, Method::Analytic)),
        row(7, 16, 2, Method::Cube),
        row(4, 0, 2, Method::Cube),
        row(4, 16, 3, Method::Cube),
    ];
    let found = with_bench(&Texels::requirements(), |bench| cubes(bench, &rows).unwrap());
    for (row, found) in rows.iter().zip(&found[..4]) {
        let found = found.as_ref().unwrap();
        let error = stability::error(&found.value, &found.reference);
        println!("{row:?}: {error:e}");
        assert_eq!(found.value.coefficients.len(), row.order * row.order);
        assert!(error < 1e-6, "{:?} is not {:?}", found.value, found.reference);
    }
    assert!(matches!(found[4], Err(RadianceError::Overlap { first: 0, second: 1 })));
    for (found, word) in found[5..].iter().zip(["order", "face size", "rays"]) {
        assert!(found.as_ref().unwrap_err().to_string().starts_with(word), "{found:?}");
    }
}
