//! Rays aimed at the edges and corners of closed meshes from inside: whatever gets out is a leak of the triangle
//! test or of the hierarchy.

use std::cell::Cell;

use glam::{Mat4, Vec3A};
use obvhs::rt_triangle::RtTriangle;

use crate::triangle::Segment;
use crate::{Mesh, Occluders};

/// A sphere of `rings` rings and twice as many sectors, turned so that nothing is axis-aligned.
fn ball(rings: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let turn = glam::Mat3::from_euler(glam::EulerRot::XYZ, 0.3, 1.0, -0.7);
    let sectors = 2 * rings;
    let mut positions = vec![(turn * glam::Vec3::Z).to_array(), (turn * glam::Vec3::NEG_Z).to_array()];
    for ring in 1..rings {
        for sector in 0..sectors {
            let (sin, cos) = (std::f32::consts::PI * ring as f32 / rings as f32).sin_cos();
            let (sin_s, cos_s) = (std::f32::consts::TAU * sector as f32 / sectors as f32).sin_cos();
            positions.push((turn * glam::Vec3::new(sin * cos_s, sin * sin_s, cos)).to_array());
        }
    }
    let at = |ring: u32, sector: u32| match ring {
        0 => 0,
        _ if ring == rings => 1,
        _ => 2 + (ring - 1) * sectors + sector % sectors,
    };
    let mut indices = Vec::new();
    for ring in 0..rings {
        for sector in 0..sectors {
            let quad =
                [at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1), at(ring, sector + 1)];
            indices.extend([quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]]);
        }
    }
    (positions, indices)
}

/// Rays, and how many escape our test over the hierarchy, and obvhs's own Möller-Trumbore over all triangles.
fn leaks(place: Mat4, rings: u32, towards: impl Fn([Vec3A; 3], &dyn Fn(Vec3A))) -> [usize; 3] {
    let (positions, indices) = ball(rings);
    let positions: Vec<[f32; 3]> =
        positions.iter().map(|p| place.transform_point3(glam::Vec3::from(*p)).to_array()).collect();
    let mesh = Mesh { name: "ball", positions: &positions, normals: &positions, indices: &indices };
    let occluders = Occluders::build(&[mesh.occluder()]).unwrap();
    let corners: Vec<[Vec3A; 3]> = (indices.chunks_exact(3))
        .map(|i| [i[0], i[1], i[2]].map(|i| occluders.scale().apply(positions[i as usize])))
        .collect();
    let rounded: Vec<RtTriangle> = corners.iter().map(|[a, b, c]| RtTriangle::new(*a, *b, *c)).collect();
    let origin = place.transform_point3(glam::Vec3::new(0.12, -0.2, 0.31));
    let origin = occluders.scale().apply(origin.to_array());
    let counts = [const { Cell::new(0) }; 3];
    let count = |which: usize| counts[which].set(counts[which].get() + 1);
    for (number, triangle) in corners.iter().enumerate() {
        towards(*triangle, &|target| {
            let segment = Segment { origin, direction: (target - origin).normalize(), reach: f32::INFINITY };
            count(0);
            if !occluders.blocks(&segment) {
                count(1);
            }
            // The triangles around the one aimed at; the whole mesh where few rays are cast.
            let ray = obvhs::ray::Ray::new_inf(segment.origin, segment.direction);
            let near = number.saturating_sub(4 * rings as usize + 4)..(number + 4 * rings as usize + 5);
            let hit = |triangle: &RtTriangle| triangle.intersect(&ray).is_finite();
            if !rounded[near.start..near.end.min(rounded.len())].iter().any(hit) && !rounded.iter().any(hit) {
                count(2);
            }
        });
    }
    counts.map(Cell::into_inner)
}

#[test]
fn no_ray_leaves_a_closed_mesh_through_its_edges_or_corners() {
    let far = Mat4::from_translation(glam::Vec3::new(50.0, 20.0, -30.0));
    let mut ours = 0;
    for (name, place) in [("at the origin", Mat4::IDENTITY), ("50 radii away", far)] {
        let edges = leaks(place, 24, |[a, b, c], aim| {
            for step in 0..64 {
                let t = (step as f32 + 0.37) / 64.0;
                [(a, b), (b, c), (c, a)].into_iter().for_each(|(from, to)| aim(from.lerp(to, t)));
            }
        });
        let corners = leaks(place, 24, |triangle, aim| triangle.into_iter().for_each(aim));
        for (what, [rays, leaks, theirs]) in [("edges", edges), ("corners", corners)] {
            println!("{name}, {rays} rays at {what}: {leaks} leaks; Möller-Trumbore {theirs}");
            ours += leaks;
        }
    }
    assert_eq!(ours, 0, "rays left a closed mesh");
}
