//! What the tests light.

use std::ops::ControlFlow;

use airglow_math::World;
use airglow_math::sh::zonal::{clamped_cosine, rotate_to_direction};
use airglow_radiance::Hierarchy;
use airglow_radiance::gpu::bench::Bench;
use airglow_radiance::{Part, PassSettings, Receiver};
use glam::{DVec3, Vec3};

/// A receiver on the CPU.
pub struct Mesh {
    pub positions: Vec<[f32; 3]>,
    pub transfer: Vec<f32>,
    pub tree: Hierarchy,
}

impl Mesh {
    fn new(positions: Vec<[f32; 3]>, normals: &[Vec3], order: usize) -> Self {
        let factors = clamped_cosine(order).unwrap();
        let factors: Vec<f64> = factors.iter().map(|a| a / std::f64::consts::PI).collect();
        let mut transfer = Vec::new();
        for normal in normals {
            let mut vector = vec![0.0; order * order];
            if *normal != Vec3::ZERO {
                rotate_to_direction(&factors, normal.as_dvec3(), &mut vector).unwrap();
            }
            transfer.extend(vector.iter().map(|t| *t as f32));
        }
        let tree = Hierarchy::build(&positions, &transfer, &mut |_, _| ControlFlow::Continue(())).unwrap();
        Self { positions, transfer, tree }
    }

    /// A ball of radius 0.6 about the origin; with `black` one of three vertices reflects nothing.
    pub fn ball(side: usize, order: usize, black: bool) -> Self {
        let at = |i: usize| {
            let (u, v) = ((i % side) as f32 / side as f32, ((i / side) as f32 + 0.5) / side as f32);
            let (angle, height) = (std::f32::consts::TAU * u, 1.0 - 2.0 * v);
            let ring = (1.0 - height * height).sqrt();
            Vec3::new(ring * angle.cos(), height, ring * angle.sin())
        };
        let directions: Vec<Vec3> = (0..side * side).map(at).collect();
        let positions = directions.iter().map(|d| (0.6 * *d).to_array()).collect();
        let normal = |(i, d): (usize, &Vec3)| if black && i % 3 == 0 { Vec3::ZERO } else { *d };
        Self::new(positions, &directions.iter().enumerate().map(normal).collect::<Vec<_>>(), order)
    }

    /// The ball as a host has it, about its own axes and in its units.
    pub fn ball_of(world: &World, side: usize, order: usize) -> Self {
        let ball = Self::ball(side, order, false);
        let points: Vec<DVec3> = (0..ball.positions.len()).map(|vertex| ball.point(vertex)).collect();
        let positions = points.iter().map(|p| world.host_position(*p).as_vec3().to_array()).collect();
        let normals: Vec<Vec3> =
            points.iter().map(|p| world.host_direction(p.normalize()).as_vec3()).collect();
        Self::new(positions, &normals, order)
    }

    /// All of it in one part.
    pub fn whole(&self) -> [Part; 1] {
        [Part { vertices: 0..self.positions.len() as u32, turn: None }]
    }

    pub fn receiver(&self, bench: &Bench<'_>, settings: PassSettings) -> Receiver {
        Receiver::new(bench.context, settings, &self.tree, &self.positions, &self.whole()).unwrap()
    }

    /// Red of each vertex under light of its own, order 3.
    pub fn colours(&self, light: &[f32]) -> Vec<f64> {
        let vertex = |(light, t): (&[f32], &[f32])| -> f64 {
            light.chunks_exact(3).zip(t).map(|(l, t)| f64::from(l[0]) * f64::from(*t)).sum()
        };
        light.chunks_exact(27).zip(self.transfer.chunks_exact(9)).map(vertex).collect()
    }

    pub fn point(&self, vertex: usize) -> DVec3 {
        DVec3::from(self.positions[vertex].map(f64::from))
    }
}
