//! `cargo run --release -p airglow-shadow --example walker -- OUT.png [SECONDS]`: the walking figure of
//! `assets/mesh/walker.glb` on the ground, its shadow by the pass on the device at orders 3 to 6 and, on the right, by rays
//! against the mesh itself; the error of each order, and what the pass counted.

mod view;

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use airglow_bake::{Mesh, Occluders, Probe};
use airglow_gpu::{GpuError, Recorder};
use airglow_math::sequence::{cosine_hemisphere, hammersley};
use airglow_math::sh::{evaluate, product::TripleProduct, project};
use airglow_scene::image_io::write_png;
use airglow_scene::{Figure, Scene};
use airglow_shadow::reference::caps;
use airglow_shadow::spheres::{FitSettings, Hierarchy, fit, skinned, weights};
use airglow_shadow::{Bench, Blockers, Settings, Shadow, Sphere};
use airglow_tests::device::fixture_with;
use glam::{DMat4, DVec3, Mat4};
use view::{Picture, SIDE};

/// Spheres of the figure.
const SPHERES: usize = 60;
/// Rays of a pixel of the truth.
const RAYS: u32 = 512;

/// Radiance of the sky: a dim dome, a warm lobe and a blue one.
fn sky(direction: DVec3) -> DVec3 {
    let lobe = |axis: [f64; 3], width: f64| {
        (width * (direction.dot(DVec3::from_array(axis).normalize()) - 1.0)).exp()
    };
    let dome = DVec3::new(0.22, 0.25, 0.3) * (0.6 + 0.4 * direction.y);
    dome + lobe([-0.8, 0.9, 0.35], 14.0) * DVec3::new(2.6, 1.9, 1.1)
        + lobe([0.9, 0.55, -0.5], 10.0) * DVec3::new(0.25, 0.55, 1.2)
}

/// What a white surface of a normal reflects of the light that a visibility leaves (Sun 2008, section 5.2.4): `L_H(N) . g`.
fn shaded(
    tensor: &TripleProduct,
    light: &[Vec<f64>; 3],
    normal: DVec3,
    visibility: &[f64],
) -> Result<DVec3, Box<dyn Error>> {
    let order = tensor.order();
    let factors = airglow_math::sh::zonal::clamped_cosine(order)?;
    let mut cosine = vec![0.0; order * order];
    evaluate(order, normal, &mut cosine)?;
    cosine.iter_mut().enumerate().for_each(|(i, value)| *value *= factors[i.isqrt()] / std::f64::consts::PI);
    let mut shaded = DVec3::ZERO;
    let mut product = vec![0.0; order * order];
    for (channel, light) in light.iter().enumerate() {
        tensor.product(light, &cosine, &mut product)?;
        shaded[channel] = product.iter().zip(visibility).map(|(a, b)| a * b).sum();
    }
    Ok(shaded)
}

/// The same by rays against the mesh.
fn truth(picture: &Picture, positions: &[[f32; 3]], indices: &[u32]) -> Result<Vec<DVec3>, Box<dyn Error>> {
    let figure =
        airglow_bake::Occluder { name: "walker", positions, indices, transform: Mat4::IDENTITY, mask: None };
    let occluders = Occluders::build(&[figure])?;
    let mesh = Mesh { name: "pixels", positions: &picture.places, normals: &picture.normals, indices: &[] };
    let probe = Probe::new(&mesh, Mat4::IDENTITY, &occluders, f32::INFINITY)?;
    let pixel = |at: usize| {
        let normal = probe.normal(at).unwrap_or(DVec3::Y);
        let (side, front) = normal.any_orthonormal_pair();
        let ray = |ray| {
            let d = cosine_hemisphere(hammersley(ray, RAYS));
            let direction = (d.x * side + d.y * front + d.z * normal).normalize();
            if probe.sees(at, direction) { sky(direction) } else { DVec3::ZERO }
        };
        (0..RAYS).map(ray).sum::<DVec3>() / f64::from(RAYS)
    };
    Ok((0..picture.places.len()).map(pixel).collect())
}

/// The same by rays against the spheres.
fn by_spheres(picture: &Picture, spheres: &[Sphere]) -> Vec<DVec3> {
    let pixel = |(place, normal): (&[f32; 3], &[f32; 3])| {
        let normal = DVec3::from_array(normal.map(f64::from));
        let caps = caps(spheres, DVec3::from_array(place.map(f64::from)));
        let (side, front) = normal.any_orthonormal_pair();
        let ray = |ray| {
            let d = cosine_hemisphere(hammersley(ray, RAYS));
            let direction = (d.x * side + d.y * front + d.z * normal).normalize();
            if caps.iter().any(|cap| cap.hides(direction)) { DVec3::ZERO } else { sky(direction) }
        };
        (0..RAYS).map(ray).sum::<DVec3>() / f64::from(RAYS)
    };
    picture.places.iter().zip(&picture.normals).map(pixel).collect()
}

/// Root mean square of the difference over that of the truth, over pixels of the ground.
fn error(picture: &Picture, found: &[DVec3], truth: &[DVec3]) -> f64 {
    let ground = || (0..found.len()).filter(|&at| picture.ground[at]);
    let square: f64 = ground().map(|at| (found[at] - truth[at]).length_squared()).sum();
    let size: f64 = ground().map(|at| truth[at].length_squared()).sum();
    (square / size).sqrt()
}

/// World from mesh for each joint of the first instance, at a time of the first animation.
fn joints(scene: &Scene, seconds: f32) -> Vec<Mat4> {
    let walker = Figure {
        name: "walker".to_owned(),
        instances: 0..1,
        meshes: vec![0],
        root: 0,
        animation: Some(0),
        time: 0.0,
        velocity: [0.0; 3],
        spheres: SPHERES as u32,
    };
    let pose = scene.pose(&walker, seconds);
    scene.joints(&scene.instances[0], &pose)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let out = arguments.next().unwrap_or_else(|| "walker.png".to_owned());
    let seconds: f32 = arguments.next().map_or(Ok(0.2), |text| text.parse())?;
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/mesh/walker.glb");
    let scene = airglow_scene::load(&file)?;
    let mesh = &scene.meshes[0];
    let joints = joints(&scene, seconds);
    let begin = Instant::now();
    let set = fit(
        &mesh.positions,
        &mesh.indices,
        &FitSettings { spheres: SPHERES, ..Default::default() },
        &mut |_| (),
    )?;
    println!(
        "{} triangles to {} spheres in {:.1} s: {:.4} m3 outside, mesh {:.4} m3",
        mesh.indices.len() / 3,
        set.spheres.len(),
        begin.elapsed().as_secs_f64(),
        set.outside,
        set.volume
    );
    let bound = weights(&set, &mesh.joints, &mesh.weights)?;
    let wide: Vec<DMat4> = joints.iter().map(Mat4::as_dmat4).collect();
    let spheres: Vec<Sphere> = skinned(&set.spheres, &bound, &wide);
    let (positions, _) = mesh.posed(&joints);
    let picture = view::trace(&positions, &mesh.indices);
    let exact = truth(&picture, &positions, &mesh.indices)?;
    let spheres_alone = by_spheres(&picture, &spheres);
    println!(
        "rays against the spheres: ground {:.1} % RMS of the truth",
        100.0 * error(&picture, &spheres_alone, &exact)
    );

    let fixture = fixture_with(&Shadow::requirements());
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let mut panels = Vec::new();
    for order in 3..=6 {
        let light = |channel: usize| project(order, 60, |direction| sky(direction)[channel]);
        let (light, tensor) = ([light(0)?, light(1)?, light(2)?], TripleProduct::new(order)?);
        let plain = Hierarchy::without_ratios(&set.spheres)?;
        let begin = Instant::now();
        let corrected = Hierarchy::new(&set.spheres, order)?;
        println!("order {order}: ratios in {:.1} s", begin.elapsed().as_secs_f64());
        let ways = [
            ("spheres alone", &plain, 0.0),
            ("with ratios", &corrected, 0.0),
            ("and a cut", &corrected, 0.03),
        ];
        for (name, hierarchy, cut) in ways {
            let settings = Settings { order, cut, normals: true, ..Default::default() };
            let blockers = Blockers::default();
            blockers.set_nodes(&hierarchy.posed(&spheres)?, DMat4::IDENTITY)?;
            let shadow = Shadow::new(bench.context, settings)?;
            let frame = bench.blocked(&shadow, &picture.places, Some(&picture.normals), &blockers, 3)?;
            let mut found = Vec::new();
            for (values, normal) in frame.values.chunks(order * order).zip(&picture.normals) {
                let values: Vec<f64> = values.iter().map(|v| f64::from(*v)).collect();
                found.push(shaded(&tensor, &light, DVec3::from_array(normal.map(f64::from)), &values)?);
            }
            println!(
                "  {name:14} ground {:.1} % RMS of the truth, {:.1} % of rays against the spheres; {:?}; {:.1} ms for {} pixels",
                100.0 * error(&picture, &found, &exact),
                100.0 * error(&picture, &found, &spheres_alone),
                frame.counts,
                1e3 * frame.times[2].as_secs_f64(),
                SIDE * SIDE
            );
            if name == "and a cut" {
                panels.push(found);
            }
        }
        let mut open = vec![0.0; order * order];
        open[0] = (4.0 * std::f64::consts::PI).sqrt();
        let normal = |normal: &[f32; 3]| DVec3::from_array(normal.map(f64::from));
        let without = picture
            .normals
            .iter()
            .map(|n| shaded(&tensor, &light, normal(n), &open))
            .collect::<Result<Vec<_>, _>>()?;
        println!(
            "  {:14} ground {:.1} % RMS of the truth",
            "without shadow",
            100.0 * error(&picture, &without, &exact)
        );
    }
    panels.push(exact);
    write_png(Path::new(&out), &view::beside(&panels), 1.6)?;
    println!("wrote {out}");
    Ok(())
}
