//! Meshes that are none, into the fitter, and skins that move nothing.

use airglow::shadow::Sphere;
use airglow::shadow::spheres::{FitSettings, SphereSet, fit, skinned, weights};
use glam::{DMat4, DVec3};

use super::super::Row;
use super::{again, row, wanted};

/// How far beyond its sphere a vertex may lie, relative to the radius.
const BOUND: f64 = 1e-9;

/// All inputs, or the one called `only`.
pub fn rows(only: Option<&str>) -> Vec<Row> {
    let (block, sides) = block();
    let triangle = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let line: Vec<[f32; 3]> = (0..9).map(|i| [i as f32, 0.0, 0.0]).collect();
    // Three triangles on one edge, and the same block twice with the inside out.
    let fan = vec![[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.5, 0.0], [-1.0, 0.5, 0.5], [-1.0, 0.5, -0.5]];
    let turned: Vec<u32> = sides.chunks_exact(3).flat_map(|t| [t[0], t[2], t[1]]).collect();
    let both = [&sides[..], &turned[..]].concat();
    let meshes = [
        ("an open mesh", block.clone(), sides[6..].to_vec()),
        ("a mesh whose edges have three sides", fan, vec![0, 1, 2, 0, 1, 3, 0, 1, 4]),
        ("a mesh twice, once inside out", block, both),
        ("a triangle, twice over", triangle, vec![0, 1, 2, 2, 1, 0]),
        ("triangles of no area", line, vec![0, 4, 8, 0, 0, 0, 3, 3, 5]),
        ("a single point", vec![[1.0; 3]], Vec::new()),
        (
            "points a millionth and a million apart",
            vec![[0.0; 3], [1e-6, 0.0, 0.0], [1e6, 0.0, 0.0]],
            vec![0, 1, 2],
        ),
    ];
    let mut rows: Vec<Row> = meshes
        .into_iter()
        .filter(|(name, ..)| wanted(only, &format!("fitter: {name}")))
        .map(|(name, positions, indices)| fitted(&format!("fitter: {name}"), &positions, &indices))
        .collect();
    rows.extend(wanted(only, "a skin of zero weights").then(|| still("a skin of zero weights")));
    rows
}

/// A cube from the origin.
fn block() -> (Vec<[f32; 3]>, Vec<u32>) {
    let corner = |i: u32| [(i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32];
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    ((0..8).map(corner).collect(), indices)
}

/// Whether every vertex lies within its sphere.
fn fitted(name: &str, positions: &[[f32; 3]], indices: &[u32]) -> Row {
    let settings = FitSettings { spheres: 6, teleports: 8, resolution: 16 };
    let input = format!("{} vertices, {} triangles, 6 spheres", positions.len(), indices.len() / 3);
    let truth = "every vertex within its sphere".to_owned();
    let (result, error) = match fit(positions, indices, &settings, &mut |_| ()) {
        Ok(set) => {
            let beyond = |(place, at): (&[f32; 3], &u32)| {
                let place = DVec3::from_array(place.map(f64::from));
                set.spheres.get(*at as usize).map_or(f64::INFINITY, |sphere| {
                    ((place - sphere.center).length() - sphere.radius) / sphere.radius.max(1e-30)
                })
            };
            let worst = positions.iter().zip(&set.assignment).map(beyond).fold(0.0, f64::max);
            let finite =
                set.spheres.iter().all(|sphere| sphere.center.is_finite() && sphere.radius.is_finite());
            let error = if finite { worst } else { f64::INFINITY };
            (format!("{} spheres, {:.3e} m3 outside", set.spheres.len(), set.outside), error)
        }
        Err(refusal) => (format!("refused: {refusal}"), f64::INFINITY),
    };
    row(name, input, result, truth, error, BOUND, again(name))
}

/// Spheres of vertices that no joint moves.
fn still(name: &str) -> Row {
    let spheres = vec![Sphere { center: DVec3::ONE, radius: 0.5 }; 2];
    let set = SphereSet { spheres: spheres.clone(), assignment: vec![0, 1], outside: 0.0, volume: 0.0 };
    let moved = weights(&set, &[[0, 1, 2, 3]; 2], &[[0.0; 4]; 2])
        .map(|weights| skinned(&spheres, &weights, &[DMat4::from_translation(DVec3::splat(9.0)); 4]));
    let (result, error) = match moved {
        Ok(moved) => {
            let step = moved[0].center.distance(DVec3::ONE) + (moved[0].radius - 0.5).abs();
            (format!("the sphere moves by {step:e}"), if step.is_finite() { step } else { f64::INFINITY })
        }
        Err(refusal) => (format!("refused: {refusal}"), f64::INFINITY),
    };
    let input = "joints that move by 15 m, all weights 0".to_owned();
    row(name, input, result, "it stays".to_owned(), error, BOUND, again(name))
}
