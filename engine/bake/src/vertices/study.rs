//! The measurements behind the choice of estimator, as this crate's README prints them:
//! `cargo test --release -p airglow-bake --lib study -- --nocapture`
//! In a debug build they are made on fewer vertices and rays; what they are to show is asserted in both.

use airglow_math::sh::{product::TripleProduct, zonal};
use glam::{DVec3, Mat4, Vec3};

use super::Vertices;
use crate::analytic::{cosine_factors, unit};
use crate::directions::Directions;
use crate::{BelowHorizon, Mesh, Occluders, Settings};

const SIDE: u32 = 160;

/// Every how manyth vertex is baked, the rays of the truth, and the rays compared, ascending.
const EFFORT: (usize, u32, &[u32]) =
    if cfg!(debug_assertions) { (701, 8192, &[64, 512]) } else { (211, 65536, &[64, 256, 1024, 4096]) };

/// Positions, normals and indices of a sphere pushed in and out by waves.
fn bumpy_sphere() -> (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<u32>) {
    use std::f32::consts::{PI, TAU};
    let point = |u: f32, v: f32| {
        let ((sin, cos), (sin_u, cos_u)) = ((PI * v).sin_cos(), (TAU * u).sin_cos());
        let d = Vec3::new(sin * cos_u, cos, sin * sin_u);
        d * (1.0 + 0.35 * (d.x * 9.0).sin() * (d.y * 11.0).sin() * (d.z * 10.0).sin())
    };
    let (mut positions, mut normals, mut indices) = (vec![], vec![], vec![]);
    for row in 0..=SIDE {
        for column in 0..=SIDE {
            let (u, v, step) = (column as f32 / SIDE as f32, row as f32 / SIDE as f32, 1e-3);
            let (across, along) =
                (point(u + step, v) - point(u - step, v), point(u, v + step) - point(u, v - step));
            let normal = across.cross(along).normalize_or(point(u, v));
            positions.push(point(u, v).to_array());
            normals.push((normal * normal.dot(point(u, v)).signum()).to_array());
            if row < SIDE && column < SIDE {
                let here = row * (SIDE + 1) + column;
                indices.extend([here, here + SIDE + 1, here + 1, here + 1, here + SIDE + 1, here + SIDE + 2]);
            }
        }
    }
    (positions, normals, indices)
}

/// Transfer and visibility vectors of the picked vertices.
fn bake(vertices: &Vertices<'_>, picks: &[usize]) -> [Vec<f64>; 2] {
    let count = vertices.coefficient_count();
    let mut all = [vec![], vec![]];
    for vertex in picks {
        let (mut transfer, mut visibility) = (vec![0.0; count], vec![0.0; count]);
        vertices.bake(*vertex, &mut transfer, &mut visibility).unwrap();
        all[0].extend(transfer.into_iter().map(f64::from));
        all[1].extend(visibility.into_iter().map(f64::from));
    }
    all
}

fn relative(a: &[f64], b: &[f64]) -> f64 {
    let difference: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    (difference / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

#[test]
fn densities_control_variate_and_horizon() {
    let (positions, normals, indices) = bumpy_sphere();
    let mesh = Mesh { name: "bumpy", positions: &positions, normals: &normals, indices: &indices };
    let occluders = Occluders::build(&[mesh.occluder()]).unwrap();
    let (step, truth_rays, compared) = EFFORT;
    let picks: Vec<usize> = (0..positions.len()).step_by(step).collect();
    let settings = |rays, below| Settings { order: 6, rays, visibility: Some(below), ..Settings::default() };
    let vertices = |settings| Vertices::new(&mesh, Mat4::IDENTITY, &occluders, &settings).unwrap();
    let truth = bake(&vertices(settings(truth_rays, BelowHorizon::Blocked)), &picks);
    let mut chosen = Vec::new();
    for &rays in compared {
        let errors = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| {
            let settings = settings(rays, BelowHorizon::Blocked);
            let mut these = vertices(settings);
            these.directions = Directions::with_cosine_share(&settings, share).unwrap();
            let with = bake(&these, &picks);
            these.directions.residual.fill(0.0);
            let without = bake(&these, &picks);
            let error = |baked: &[Vec<f64>; 2]| [0, 1].map(|k| relative(&baked[k], &truth[k]));
            println!(
                "{rays} rays, cosine share {share}: transfer, visibility {:.5?}; without control variate {:.5?}",
                error(&with),
                error(&without)
            );
            error(&with)
        });
        let [uniform, _, half, _, cosine] = errors;
        assert!(
            half[0] < 1.05 * uniform[0],
            "transfer, {rays} rays: half {} uniform {}",
            half[0],
            uniform[0]
        );
        assert!(half[1] < 0.7 * cosine[1], "visibility, {rays} rays: half {} cosine {}", half[1], cosine[1]);
        chosen.push(half);
    }
    for pair in chosen.windows(2) {
        assert!(pair[1][0] < 0.5 * pair[0][0], "transfer error must fall with rays: {chosen:?}");
        assert!(pair[1][1] < 0.5 * pair[0][1], "visibility error must fall with rays: {chosen:?}");
    }
    for below in [BelowHorizon::Mean, BelowHorizon::Visible, BelowHorizon::Blocked] {
        let [transfer, visibility] = bake(&vertices(settings(truth_rays / 4, below)), &picks);
        let errors = [2, 3, 4, 6].map(|order| product_error(order, &picks, &normals, &transfer, &visibility));
        println!("{below:?}: product(H, v) against transfer at orders 2, 3, 4, 6: {errors:.4?}");
        assert!(errors[3] < 0.1 && errors[3] < errors[0], "{below:?}: {errors:?}");
    }
}

fn product_error(
    order: usize,
    picks: &[usize],
    normals: &[[f32; 3]],
    transfer: &[f64],
    visibility: &[f64],
) -> f64 {
    let (count, tensor) = (order * order, TripleProduct::new(order).unwrap());
    let (mut lobe, mut out) = (vec![0.0; count], vec![0.0; count]);
    let (mut products, mut expected) = (vec![], vec![]);
    for ((vertex, t), v) in picks.iter().zip(transfer.chunks(36)).zip(visibility.chunks(36)) {
        let normal = unit(DVec3::from(normals[*vertex].map(f64::from))).unwrap();
        zonal::rotate_to_direction(&cosine_factors(order).unwrap(), normal, &mut lobe).unwrap();
        tensor.product(&lobe, &v[..count], &mut out).unwrap();
        products.extend_from_slice(&out);
        expected.extend_from_slice(&t[..count]);
    }
    relative(&products, &expected)
}
