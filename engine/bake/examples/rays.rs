//! Rays per second on a displaced sphere of 100 000 triangles, ray generation and accumulation included.
//! `cargo run --release -p airglow-bake --example rays -- [THREADS] [ORDER] [RAYS] [VERTICES]`

use std::f32::consts::{PI, TAU};
use std::ops::ControlFlow;

use airglow_bake::{BakeError, BelowHorizon, Mesh, Occluders, Report, Settings, Threads, bake};
use glam::{Mat4, Vec3};

fn main() -> Result<(), BakeError> {
    let argument =
        |place, default| std::env::args().nth(place).and_then(|text| text.parse().ok()).unwrap_or(default);
    let (threads, order, rays, vertices) =
        (argument(1, 1), argument(2, 4), argument(3, 256) as u32, argument(4, 10_000));
    let (positions, normals, indices) = bumpy_sphere(226, 226);
    let whole = Mesh { name: "bumpy sphere", positions: &positions, normals: &normals, indices: &indices };
    let occluders = Occluders::build(&[whole.occluder()])?;
    println!("{} triangles, hierarchy built in {:.0?}", indices.len() / 3, occluders.build_time());
    // A share of the vertices, spread over the mesh; the surroundings of a vertex need no triangles here.
    let step = (positions.len() / vertices).max(1);
    let pick = |all: &[[f32; 3]]| all.iter().copied().step_by(step).collect::<Vec<_>>();
    let (some_positions, some_normals) = (pick(&positions), pick(&normals));
    let some = Mesh { name: "share", positions: &some_positions, normals: &some_normals, indices: &[] };
    for visibility in [None, Some(BelowHorizon::Mean)] {
        let settings = Settings { order, rays, visibility, ..Settings::default() };
        let mut progress = |report: &Report| {
            let left = report.time_left().unwrap_or_default();
            eprint!("\r{}/{} vertices, {left:.1?} left   ", report.vertices, report.vertex_count);
            ControlFlow::Continue(())
        };
        let baked =
            bake(&some, Mat4::IDENTITY, &occluders, &settings, &Threads::new(threads), &mut progress)?;
        let stats = baked.stats;
        println!(
            "\rorder {order}, {rays} rays, visibility {visibility:?}, {threads} threads: {:.3} million rays/s, {:.3} per thread, {:.1} % blocked, {:.2?}",
            stats.rays_per_second() * 1e-6,
            stats.rays_per_second() * 1e-6 / threads as f64,
            100.0 * stats.blocked as f64 / stats.rays as f64,
            stats.time,
        );
    }
    Ok(())
}

/// A sphere pushed in and out by waves, columns x rows x 2 triangles.
fn bumpy_sphere(columns: u32, rows: u32) -> (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<u32>) {
    let point = |u: f32, v: f32| {
        let direction =
            Vec3::new((PI * v).sin() * (TAU * u).cos(), (PI * v).cos(), (PI * v).sin() * (TAU * u).sin());
        let waves = (direction.x * 9.0).sin() * (direction.y * 11.0).sin() * (direction.z * 10.0).sin();
        direction * (1.0 + 0.25 * waves)
    };
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for row in 0..=rows {
        for column in 0..=columns {
            let (u, v) = (column as f32 / columns as f32, row as f32 / rows as f32);
            let step = 1e-3;
            let (du, dv) = (point(u + step, v) - point(u - step, v), point(u, v + step) - point(u, v - step));
            let normal = du.cross(dv).normalize_or(point(u, v));
            positions.push(point(u, v).to_array());
            normals.push((normal * normal.dot(point(u, v)).signum()).to_array());
            if row < rows && column < columns {
                let here = row * (columns + 1) + column;
                let below = here + columns + 1;
                indices.extend([here, below, here + 1, here + 1, below, below + 1]);
            }
        }
    }
    (positions, normals, indices)
}
