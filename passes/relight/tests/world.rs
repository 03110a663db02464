//! Hosts that differ in axes, hand, units, winding, depth, origin and pre-exposure get the same picture.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

#[path = "gpu/host/mod.rs"]
mod host;

use airglow_bake::{Mesh, unshadowed};
use airglow_math::World;
use airglow_math::world::Winding;
use airglow_relight::{
    Bench, Case, CaseLight, Instance, Light, Relight, RelightError, Settings, Texels, instance_rotation,
};
use glam::{DMat3, DMat4, DQuat, DVec3, Mat4, Vec3};
use host::draw::{Drawing, SIDE, draw};
use host::ellipsoid::Ellipsoid;
use host::{Numbers, with_bench};

const ORDER: usize = 4;
const PARTS: usize = 24;

/// Where the scene stands in airglow's world, far from its zero, as hosts with an origin at the camera have it.
const PLACE: DVec3 = DVec3::new(400.0, -30.0, 1200.0);
const EYE: DVec3 = DVec3::new(0.5, 1.0, 5.0);

fn hosts() -> [World; 3] {
    // Positions relative to the camera, as this host's axes and units name its place.
    let at_camera = |world: World| World { origin: world.host_position(PLACE + EYE), ..world };
    let [like_gltf, like_unreal, y_down] = airglow_tests::hosts::hosts();
    let like_gltf = World { origin: PLACE, ..like_gltf };
    [like_gltf, at_camera(like_unreal), at_camera(y_down)]
}

/// The host's instance matrix for one of airglow's world and object space.
fn host_matrix(world: &World, matrix: DMat4) -> DMat4 {
    let (to, from) = (world.axes.host_from_airglow(), world.axes.airglow_from_host());
    let linear = to * DMat3::from_mat4(matrix) * from;
    let mut host = DMat4::from_mat3(linear);
    host.w_axis = world.host_position(matrix.w_axis.truncate()).extend(1.0);
    host
}

/// The host's projection of its positions: its own depth, airglow's camera.
fn clip_from_host(world: &World) -> DMat4 {
    let turn = DQuat::from_rotation_arc(DVec3::NEG_Z, -EYE.normalize());
    let view = DMat4::from_rotation_translation(turn, PLACE + EYE).inverse();
    let mut to_airglow = DMat4::from_mat3(world.metres_per_unit * world.axes.airglow_from_host());
    to_airglow.w_axis = world.position(DVec3::ZERO).extend(1.0);
    // Clip w is the view distance z in metres; depth value times w is linear in z.
    let value = |z: f64| world.depth.value(z / world.metres_per_unit) * z;
    let slope = value(3.0) - value(2.0);
    let projection = DMat4::from_cols_array_2d(&[
        [2.5, 0.0, 0.0, 0.0],
        [0.0, -2.5, 0.0, 0.0],
        [0.0, 0.0, -slope, -1.0],
        [0.0, 0.0, value(2.0) - 2.0 * slope, 0.0],
    ]);
    projection * view * to_airglow
}

/// The instances in airglow's world: one turned and scaled, one mirrored, which the first hides in part.
fn instances() -> [DMat4; 2] {
    let turned = DMat4::from_scale_rotation_translation(
        DVec3::splat(0.8),
        DQuat::from_axis_angle(DVec3::new(0.3, 1.0, 0.2).normalize(), 0.9),
        PLACE + DVec3::new(-0.3, 0.1, 0.8),
    );
    let mirrored = DMat4::from_scale_rotation_translation(
        DVec3::new(1.0, 1.0, -1.0),
        DQuat::from_axis_angle(DVec3::new(1.0, 0.0, -0.4).normalize(), 2.0),
        PLACE + DVec3::new(0.7, 0.0, -0.5),
    );
    [turned, mirrored]
}

/// What one host sees: colours of the vertices without its pre-exposure, pixels, and view distances in metres.
struct Seen {
    vertices: Vec<f32>,
    pixels: Vec<[f32; 4]>,
    distances: Vec<f64>,
}

fn see(bench: &Bench<'_>, world: &World, sky: &Texels<'_>) -> Seen {
    // The host's own mesh, in its own axes, units and winding; its bake is in that object space.
    let ellipsoid = Ellipsoid::new(PARTS);
    let to_host = |v: &Vec3| world.host_direction(v.as_dvec3());
    let positions: Vec<[f32; 3]> = ellipsoid
        .positions
        .iter()
        .map(|p| (to_host(p) / world.metres_per_unit).as_vec3().to_array())
        .collect();
    let normals: Vec<[f32; 3]> = ellipsoid.normals.iter().map(|n| to_host(n).as_vec3().to_array()).collect();
    let clockwise = world.front_face == Winding::Clockwise;
    let indices = ellipsoid.indices(clockwise);
    let mesh = Mesh { name: "ellipsoid", positions: &positions, normals: &normals, indices: &indices };
    let baked = unshadowed(&mesh, Mat4::IDENTITY, ORDER).unwrap().transfer.coefficients;

    let mut relight = Relight::new(bench.context, Settings { order: ORDER, ..Settings::default() }).unwrap();
    relight.set_world(*world).unwrap();
    let id = relight.add_mesh(bench.context, "ellipsoid", positions.len() as u32, Some(&baked)).unwrap();
    let turn = world.axes.host_rotation(DQuat::from_axis_angle(DVec3::new(0.2, 1.0, -0.6).normalize(), 1.3));
    let clip = clip_from_host(world);
    let mut vertices = Vec::new();
    let mut drawings = Vec::new();
    for matrix in instances() {
        let matrix = host_matrix(world, matrix);
        let orientation = instance_rotation(DMat3::from_mat4(matrix)).unwrap();
        let case = Case { orientation, ..Case::new(CaseLight::Environment(*sky, turn), id) };
        let colours = bench.results(&mut relight, &case).unwrap();
        vertices.extend(&colours);
        drawings.push(Drawing {
            clip_from_object: (clip * matrix).as_mat4(),
            colours,
            clockwise: clockwise != (matrix.determinant() < 0.0),
        });
    }
    let (mut pixels, depths) = draw(bench, world.depth, &positions, &indices, &drawings);
    let unexposed = |value: &mut f32| *value = (f64::from(*value) / world.pre_exposure) as f32;
    vertices.chunks_exact_mut(4).flat_map(|rgba| &mut rgba[..3]).for_each(unexposed);
    pixels.iter_mut().flat_map(|rgba| &mut rgba[..3]).for_each(unexposed);
    let [a, b, c, d] = world.depth_coefficients();
    let distances = depths.iter().map(|&depth| (a + b * f64::from(depth)) / (c + d * f64::from(depth)));
    Seen { vertices, pixels, distances: distances.collect() }
}

/// Vertices agree to 3e-6 of the brightest, pixels to 1e-3 of it and distances to 1e-3, but for pixels on an outline.
#[test]
fn three_hosts_get_the_same_picture() {
    with_bench(|bench| {
        let rgb: Vec<[f32; 3]> =
            Numbers::new(5).rgb(32 * 16).into_iter().map(|rgb| rgb.map(|c| 1.0 + c)).collect();
        let sky = Texels { width: 32, height: 16, rgb: &rgb };
        let [first, others @ ..] = hosts().map(|world| see(bench, &world, &sky));
        let brightest = first.vertices.iter().fold(0.0f32, |a, b| a.max(*b));
        let covered: Vec<usize> = (0..SIDE * SIDE).filter(|&i| first.pixels[i][3] > 0.0).collect();
        assert!(covered.len() > SIDE * SIDE / 10, "only {} pixels are drawn", covered.len());
        // The front of the nearer instance, not its back, is what the camera sees.
        let nearest = covered.iter().map(|&i| first.distances[i]).fold(f64::INFINITY, f64::min);
        let nearest_vertex = nearest_vertex();
        assert!((nearest - nearest_vertex).abs() < 0.02, "{nearest} m, the mesh is {nearest_vertex} m away");
        for (host, seen) in others.iter().enumerate() {
            for (vertex, (ours, theirs)) in first.vertices.iter().zip(&seen.vertices).enumerate() {
                assert!(
                    (ours - theirs).abs() <= 3e-6 * brightest,
                    "host {}, value {vertex}: {theirs} instead of {ours}",
                    host + 1
                );
            }
            let differs = |&&i: &&usize| {
                let colour = first.pixels[i].iter().zip(&seen.pixels[i]);
                let colour = colour.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                let (ours, theirs) = (first.distances[i], seen.distances[i]);
                colour > 1e-3 * brightest || (ours - theirs).abs() > 1e-3 * ours
            };
            let different = covered.iter().filter(differs).count();
            println!("host {}: {different} of {} pixels differ", host + 1, covered.len());
            assert!(500 * different <= covered.len(), "host {}: {different} pixels differ", host + 1);
        }
    });
}

/// View distance of the nearest vertex in metres.
fn nearest_vertex() -> f64 {
    let forward = -EYE.normalize();
    let ellipsoid = Ellipsoid::new(PARTS);
    let vertices = instances().into_iter().flat_map(|matrix| {
        let place = move |p: &Vec3| (matrix * p.as_dvec3().extend(1.0)).truncate();
        ellipsoid.positions.iter().map(place).collect::<Vec<_>>()
    });
    vertices.map(|p| (p - PLACE - EYE).dot(forward)).fold(f64::INFINITY, f64::min)
}

/// Light that a host has as harmonics about its own axes.
#[test]
fn harmonics_about_the_host_s_axes_give_the_same_colours() {
    with_bench(|bench| {
        let mut numbers = Numbers::new(6);
        let light = numbers.rgb(ORDER * ORDER);
        let normals: Vec<DVec3> =
            (0..50).map(|_| DVec3::new(numbers.next(), numbers.next(), numbers.next()).normalize()).collect();
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), -2.2);
        let matrix = DMat3::from_axis_angle(DVec3::new(0.0, 0.6, 0.8), 0.4) * 3.0;
        let colours = hosts().map(|world| {
            let own = world.harmonics(ORDER).unwrap().inverse().apply_rgb(&host::wide_rgb(&light)).unwrap();
            let own: Vec<[f32; 3]> = own.iter().map(|rgb| rgb.map(|c| c as f32)).collect();
            let normals: Vec<[f32; 3]> =
                normals.iter().map(|n| world.host_direction(*n).as_vec3().to_array()).collect();
            let settings = Settings { order: ORDER, normals: true, ..Settings::default() };
            let mut relight = Relight::new(bench.context, settings).unwrap();
            relight.set_world(world).unwrap();
            let mesh = relight.add_mesh(bench.context, "points", 50, None).unwrap();
            let matrix = world.axes.host_from_airglow() * matrix * world.axes.airglow_from_host();
            let case = Case {
                orientation: instance_rotation(matrix).unwrap(),
                normals: Some(&normals),
                ..Case::new(CaseLight::Uniform(&own, world.axes.host_rotation(turn)), mesh)
            };
            let colours = bench.results(&mut relight, &case).unwrap();
            let rgb = colours.chunks_exact(4).flat_map(|rgba| rgba[..3].to_vec());
            rgb.map(|value| f64::from(value) / world.pre_exposure).collect::<Vec<_>>()
        });
        let scale = colours[0].iter().fold(0.0f64, |a, b| a.max(b.abs()));
        for (host, theirs) in colours.iter().enumerate().skip(1) {
            for (ours, theirs) in colours[0].iter().zip(theirs) {
                assert!((ours - theirs).abs() < 3e-6 * scale, "host {host}: {theirs} instead of {ours}");
            }
        }
    });
}

#[test]
fn what_no_host_can_mean_is_refused() {
    with_bench(|bench| {
        let mut relight = Relight::new(bench.context, Settings { order: 1, ..Settings::default() }).unwrap();
        let bad = World { pre_exposure: 0.0, ..World::default() };
        assert!(matches!(relight.set_world(bad), Err(RelightError::Math(_))));
        let mesh = relight.add_mesh(bench.context, "point", 1, Some(&[1.0])).unwrap();
        let light = Light::Uniform { coefficients: (), rotation: DQuat::IDENTITY };
        let frame =
            airglow_relight::Frame::<(), ()> { light, instances: vec![Instance::new(mesh)], target: None };
        let rotations = relight.prepare(bench.context, &frame).unwrap().rotations.unwrap();
        for bad in [0.0, -1.0, f64::NAN] {
            assert!(matches!(rotations.set_pre_exposure(bad), Err(RelightError::Math(_))), "{bad}");
        }
    });
}
