//! The files that the repository ships load, whole and without a word.

use crate::support;
use crate::support::asset;
use airglow_scene::{LightKind, MaterialClass, Quality, image_io, load, luminance};

#[test]
fn meshes_have_the_stated_sizes() {
    let sizes = [("spot", 3225, 5856), ("nave", 54_128, 97_672), ("teapot", 3241, 6320)];
    for (name, vertices, triangles) in sizes {
        let scene = load(&asset(&format!("mesh/{name}.glb"))).unwrap();
        let mesh = &scene.meshes[0];
        assert_eq!((mesh.positions.len(), mesh.triangle_count()), (vertices, triangles), "{name}");
        assert_eq!(scene.warnings, [], "{name}");
        // A missing camera frames the scene: every vertex is inside the picture, and they fill much of it.
        let camera = scene.camera();
        let clip = camera.clip_from_view(1.0) * camera.view() * scene.instances[0].transform;
        let mut widest = 0.0_f32;
        for position in &mesh.positions {
            let point = clip.project_point3((*position).into());
            widest = widest.max(point.x.abs()).max(point.y.abs());
            assert!((0.0..=1.0).contains(&point.z), "{name}: {position:?} has the depth {}", point.z);
        }
        assert!((0.5..=1.0).contains(&widest), "{name}: the picture is filled up to {widest}");
    }
}

#[test]
fn spot_has_a_decoded_texture() {
    let scene = load(&asset("mesh/spot.glb")).unwrap();
    let texture = scene.materials[0].base_color_texture.unwrap();
    let image = &scene.images[texture.image];
    assert_eq!((image.width, image.height, image.pixels.len()), (512, 512, 512 * 512));
    assert_eq!(scene.materials[scene.meshes[0].material].class, MaterialClass::Glossy);
    let teapot = load(&asset("mesh/teapot.glb")).unwrap();
    assert_eq!(teapot.materials[0].class, MaterialClass::Lambert);
}

#[test]
fn lights_room_has_its_lights_and_camera() {
    let scene = load(&asset("mesh/lights_room.glb")).unwrap();
    let kinds: Vec<_> = scene.lights.iter().map(|light| std::mem::discriminant(&light.kind)).collect();
    assert!(kinds.len() == 3 && kinds[0] != kinds[1] && kinds[1] != kinds[2], "{:?}", scene.lights);
    let LightKind::Point { position, intensity, range } = scene.lights[0].kind else { panic!() };
    assert_eq!((position, intensity, range), ([1.6, 1.1, 0.6], [60.0, 51.0, 36.0], Some(8.0)));
    assert_eq!((scene.cameras.len(), scene.camera().position()), (1, glam::Vec3::new(2.5, 1.8, 5.5)));
}

#[test]
fn environments_have_the_stated_peaks() {
    let peaks = [
        ("env/courtyard_512.exr", 512, 28.59),
        ("env/interior_512.exr", 512, 1.559e4),
        ("env/sunrise_512.exr", 512, 1.574e4),
        ("env/kloppenheim_05_1k.hdr", 1024, 7.894e4),
    ];
    for (name, width, peak) in peaks {
        let map = image_io::read_environment(&asset(name)).unwrap();
        assert_eq!(
            (map.width, map.height, map.pixels.len()),
            (width, width / 2, width * width / 2),
            "{name}"
        );
        let found = map.pixels.iter().map(|pixel| luminance(*pixel)).fold(0.0, f32::max);
        assert!((found / peak - 1.0).abs() < 2e-3, "{name}: peak of {found}, stated {peak}");
    }
}

#[test]
fn the_scene_file_of_the_readme_loads() {
    let readme = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let (_, rest) = readme.split_once("```toml\n").unwrap();
    let (text, _) = rest.split_once("```").unwrap();
    let text = text.replace("\"../", &format!("\"{}/", asset("").display()));
    let folder = tempfile::tempdir().unwrap();
    let scene = load(&support::put(&folder, "scene.toml", text.as_bytes())).unwrap();
    assert_eq!((scene.warnings.as_slice(), scene.quality), ([].as_slice(), Quality::default()));
    assert!(scene.environment.is_some() && scene.medium.is_some());
    assert_eq!((scene.emitters.len(), scene.blockers.len(), scene.cameras.len()), (1, 1, 1));
    assert_eq!((scene.figures.len(), scene.figures[0].animation), (1, Some(0)));
    let spot = &scene.instances[scene.figures[0].instances.start - 1];
    assert_eq!(scene.meshes[spot.mesh].name, "spot");
    let nose_height = spot.transform.transform_point3(glam::Vec3::Y).y;
    assert!((nose_height - 1.5).abs() < 1e-6, "{nose_height}, expected 0.9 + 0.6");
}
