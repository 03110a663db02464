//! Pictures read where rays meet them, and what a medium takes of the light, against cube maps in f64.

use airglow_radiance::gpu::{Atlas, LightShape, TexelSettings, Texels};
use airglow_radiance::reference::{Cube, triangles};
use airglow_radiance::{Lights, Picture, Shown};
use glam::{DVec2, DVec3};

use crate::scenes::{block, blocks, points};
use crate::texels::check;
use crate::with_bench;

/// A square of two triangles that shows a picture, turned and more than once.
fn screen(picture: usize, corner: DVec3) -> [Shown; 2] {
    let (x, y) = (DVec3::new(0.9, 0.1, 0.0), DVec3::new(0.0, 0.8, 0.3));
    let corners = [corner, corner + x, corner + x + y, corner + y];
    let places = [(0.0, 1.0), (1.3, 0.9), (1.2, -0.4), (-0.1, -0.3)].map(|(u, v)| DVec2::new(u, v));
    [[0, 1, 2], [0, 2, 3]].map(|half| Shown {
        corners: half.map(|i: usize| corners[i]),
        places: half.map(|i: usize| places[i]),
        picture,
    })
}

#[test]
fn pictures_are_read_and_light_is_dimmed_as_in_the_reference() {
    let texel =
        |i: usize| [(i % 7) as f32, 0.1 * (i % 64) as f32, if i.is_multiple_of(5) { 4.0 } else { 0.0 }];
    let texels: Vec<[f32; 3]> = (0..64 * 48).map(texel).collect();
    let pictures =
        [Picture { size: [64, 48], texels: &texels }, Picture { size: [5, 3], texels: &texels[..15] }];
    let shown = [screen(0, DVec3::new(-0.4, -0.4, -1.3)), screen(1, DVec3::new(0.5, -0.2, 1.1))].concat();
    let emitters = block(DVec3::new(0.2, 0.1, -0.9), 0.1, DVec3::new(1.0, 2.0, 3.0));
    let points = points(16);
    for extinction in [[0.0; 3], [0.2, 0.7, 3.0]] {
        let lights =
            Lights { emitters: &emitters, shown: &shown, pictures: &pictures, extinction, ..Lights::NONE };
        for (order, gradients, size, rays) in [(4, true, 16, 2), (5, false, 8, 4)] {
            let shape = LightShape { order, gradients };
            let cube = Cube::new(order, size as usize).unwrap().with_rays(rays as usize).unwrap();
            let cube = if gradients { cube.with_gradients() } else { cube };
            let sample = |point: &DVec3| cube.sample_lights(*point, &lights).unwrap();
            let truth: Vec<_> = points.iter().map(sample).collect();
            let found: Vec<_> = with_bench(&Texels::requirements(), |bench| {
                let texels = Texels::new(bench.context, TexelSettings { shape, size, rays }).unwrap();
                let texels = texels.with_closed_forms(bench.context).unwrap();
                let sampled = bench.sampled_of(&texels, &lights, &points).unwrap();
                sampled.into_iter().map(|sample| sample.light).collect()
            });
            check(&format!("extinction {extinction:?}, order {order}"), &found, &truth, 2e-5);
        }
    }
}

/// The rival that draws cube maps sees what the kernel sees.
#[test]
fn an_atlas_holds_what_rays_through_the_middles_of_pixels_see() {
    let (emitters, points) = (blocks(), points(40));
    let settings = TexelSettings { shape: LightShape { order: 4, gradients: true }, size: 8, rays: 4 };
    with_bench(&Atlas::requirements(), |bench| {
        let cube = Cube::new(4, 8).unwrap().with_rays(4).unwrap().with_straight_rays().with_gradients();
        let expected: Vec<_> = points.iter().map(|point| cube.sample(*point, &emitters).unwrap()).collect();
        let atlas = Atlas::new(bench.context, settings, 512).unwrap();
        assert_eq!(atlas.most_samples(), 42);
        let buffers = bench.buffers(settings.shape, &emitters, &points).unwrap();
        let arguments = Atlas::arguments(emitters.len() as u32, points.len() as u32);
        let arguments = bench.upload("arguments", &arguments).unwrap();
        (bench.run)(&mut |recorder| atlas.record(recorder, &buffers, &(&arguments).into())).unwrap();
        let (lights, gradients) = (buffers.lights.buffer(), buffers.gradients.buffer());
        let found = bench.incidents(settings.shape, points.len(), lights, gradients).unwrap();
        // A rasteriser rounds corners to parts of a pixel: some rays at edges go to a neighbour.
        check("atlas", &found, &expected, 0.02);
    });
}

/// Through a medium a small square's light changes along the way as its closed form times the transmittance does.
#[test]
fn gradients_know_what_a_medium_takes() {
    let emitters = &block(DVec3::new(0.3, 0.2, -1.0), 0.03, DVec3::ONE)[..2];
    let extinction = 4.0_f32;
    let light = |point: DVec3| {
        let clear = triangles(3, point, emitters).unwrap();
        (-f64::from(extinction) * clear.distance()).exp() * clear.coefficients[0].x
    };
    let lights = Lights { emitters, extinction: [extinction; 3], ..Lights::NONE };
    let cube = Cube::new(3, 128).unwrap().with_rays(8).unwrap().with_gradients();
    let gradient = cube.sample_lights(DVec3::ZERO, &lights).unwrap().gradients[0];
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let expected = (light(1e-4 * axis) - light(-1e-4 * axis)) / 2e-4;
        let found = (gradient * axis).x;
        println!("along {axis}: {found:.5e}, by differences {expected:.5e}");
        assert!((found - expected).abs() < 0.03 * light(DVec3::ZERO) * f64::from(extinction));
    }
}
