//! Scene files: what the README promises, line by line.

use crate::support::{full_model, put};
use airglow_math::Preset;
use airglow_scene::{
    EmitterShape, Exposure, FloatImage, LightKind, Quality, Scene, SceneError, Shadow, Storage, image_io,
    load,
};
use glam::Vec3;
use tempfile::TempDir;

/// A folder with `model.glb` and `sky.exr` (4 x 2, one pixel of 100).
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    put(&folder, "model.glb", &full_model().glb());
    let mut pixels = vec![[0.5; 3]; 8];
    pixels[3] = [100.0, 50.0, 0.0];
    let sky = FloatImage { width: 4, height: 2, pixels };
    image_io::write_exr(&folder.path().join("sky.exr"), &sky).unwrap();
    folder
}

fn load_text(folder: &TempDir, text: &str) -> Result<Scene, SceneError> {
    load(&put(folder, "scene.toml", text.as_bytes()))
}

#[test]
fn every_table_arrives() {
    let text = r#"
        [[gltf]]
        file = "model.glb"
        translation = [0, 10, 0]
        rotation = { yaw = 90 }
        scale = 2

        [[instance]]
        file = "model.glb"
        mesh = "mesh"
        translation = [5, 0, 0]
        material = { base_color = [0.5, 0.25, 0.125], roughness = 0.3 }

        [environment]
        file = "sky.exr"
        rotation = { axis = [1, 0, 0], degrees = 180 }
        scale = 2.0
        distance = 150

        [medium]
        visibility = 391.2
        albedo = 0.9
        anisotropy = 0.7

        [[emitter]]
        center = [1, 2, 3]
        radius = 0.1
        radiance = [10, 5, 1]

        [[emitter]]
        center = [0, 1, 0]
        size = [1, 0.5, 0.25]
        radiance = 2

        [[blocker]]
        name = "ball"
        center = [0, 0, 0]
        radius = 0.5

        [camera]
        from = [0, 0, 5]
        to = [0, 0, 0]
        vertical_degrees = 60

        [exposure]
        ev = -1

        [quality]
        order = 5
        rays = 256
        storage = "f16"
        shadow = "object"
    "#;
    let scene = load_text(&folder(), text).unwrap();
    // One mesh in memory, placed twice; the second with its own surface.
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 2));
    let (placed, extra) = (&scene.instances[0], &scene.instances[1]);
    assert_eq!((placed.skin, extra.skin, placed.material), (Some(0), None, 0));
    assert_eq!(scene.materials[extra.material].base_color, [0.5, 0.25, 0.125, 1.0]);
    // Scaled by 2, turned X to -Z, lifted by 10.
    let corner = placed.transform.transform_point3(Vec3::X);
    assert!(corner.distance(Vec3::new(0.0, 10.0, -2.0)) < 1e-5, "{corner}");
    assert_eq!(extra.transform.transform_point3(Vec3::X), Vec3::new(6.0, 0.0, 0.0));
    let knee = &scene.nodes[scene.skins[0].joints[1]];
    assert_eq!(knee.name, "knee");
    let at = knee.global.w_axis.truncate();
    assert!(at.distance(Vec3::new(0.0, 12.0, 0.0)) < 1e-5, "{at}");
    assert_eq!(scene.nodes[scene.animations[0].channels[0].node].name, "knee");
    let LightKind::Spot { position, direction, .. } = scene.lights[0].kind else { panic!() };
    assert_eq!(position, [0.0, 10.0, 0.0]);
    assert!(Vec3::from(direction).distance(Vec3::NEG_X) < 1e-6, "{direction:?}");

    let environment = scene.environment.as_ref().unwrap();
    assert_eq!((environment.width, environment.height, environment.pixels[3]), (4, 2, [200.0, 100.0, 0.0]));
    assert!((environment.rotation * Vec3::Y).distance(Vec3::NEG_Y) < 1e-6);
    assert_eq!(environment.distance, Some(150.0));
    let medium = scene.medium.unwrap();
    assert!((medium.extinction[1] - 0.01).abs() < 1e-5, "{medium:?}: ln 50 / 391.2 is 0.01");
    assert_eq!((medium.albedo, medium.anisotropy), ([0.9; 3], 0.7));
    assert_eq!(scene.emitters[0].shape, EmitterShape::Sphere { radius: 0.1 });
    assert_eq!(scene.emitters[1].shape, EmitterShape::Box { size: [1.0, 0.5, 0.25] });
    assert_eq!((scene.emitters[0].radiance, scene.blockers[0].name.as_str()), ([10.0, 5.0, 1.0], "ball"));
    assert_eq!(scene.camera().position(), Vec3::new(0.0, 0.0, 5.0));
    assert_eq!(scene.exposure, Exposure::Fixed { scale: 0.5 });
    let quality = Quality { order: 5, rays: 256, storage: Storage::F16, shadow: Shadow::Object };
    assert_eq!(scene.quality, quality);
}

#[test]
fn a_preset_says_what_the_file_does_not() {
    let quality = |text: &str| {
        let scene = load_text(&folder(), &format!("[quality]\n{text}")).unwrap();
        (scene.quality, scene.presets)
    };
    let (found, presets) = quality("preset = 'low'\nrays = 7\npresets.fog = 'high'");
    assert_eq!(found, Quality { rays: 7, ..Preset::Low.into() });
    assert_eq!([presets.of("shadow"), presets.of("fog")], [Some(Preset::Low), Some(Preset::High)]);
    let (found, presets) = quality("presets.relight = 'reference'");
    assert_eq!((found, presets.of("fog")), (Preset::Reference.into(), None));
}

#[test]
fn a_missing_table_is_its_default() {
    let scene = load_text(&folder(), "[[gltf]]\nfile = 'model.glb'\n[camera]\nname = 'camera 0'").unwrap();
    assert_eq!(scene.exposure, Exposure::Automatic { key: 0.18 });
    assert_eq!(scene.quality, Quality::default());
    assert!(scene.environment.is_none() && scene.medium.is_none());
    assert_eq!(scene.camera().position(), Vec3::new(0.0, 0.0, 3.0));
    let empty = load_text(&folder(), "").unwrap();
    assert!(empty.warnings[0].message.contains("no mesh is placed"), "{:?}", empty.warnings);
}

#[test]
fn faults_carry_line_and_column() {
    let folder = folder();
    let faults = [
        ("\n[qualty]\norder = 4", 2, "unknown field `qualty`"),
        ("[quality]\norder = 7", 1, "order is a whole number from 1 to 6"),
        ("[quality]\nstorage = 'f64'", 2, "unknown variant `f64`"),
        ("[quality]\npreset = 'ultra'", 2, "no preset \"ultra\": give low"),
        ("[medium]\nextinction = 1\nvisibility = 3", 1, "either extinction (1/m) or visibility (m)"),
        ("[environment]\nfile = 'sky.exr'\ndistance = -1.0", 3, "-1 found, a number not below 0"),
        ("[medium]\nvisibility = -3.0", 2, "-3 found, a positive number expected"),
        ("[medium]\nvisibility = 3\nanisotropy = 1.0", 3, "from -0.999 to 0.999"),
        ("[medium]\nextinction = [1, -1, 0]", 2, "three of them: [red, green, blue]"),
        ("[[emitter]]\ncenter = [0, nan, 0]\nradius = 1\nradiance = 1", 2, "a finite number expected"),
        ("[[emitter]]\ncenter = [0, 0, 0]\nradiance = 1", 1, "either a radius"),
        ("[environment]\nfile = 'sky.exr'\nrotation = { yaw = 1, degrees = 2 }", 3, "a rotation is"),
        ("[camera]\nfrom = [0, 0, 0]\nto = [0, 1, 0]", 1, "not only along up"),
        ("[camera]\nname = 'other'", 2, "no camera \"other\" in the glTF files; they have []"),
        ("[exposure]\nev = 1\nscale = 2", 1, "one of key (automatic), ev (stops) and scale"),
        ("[[gltf]]\nfile = 'model.glb'\nscale = 0", 3, "a number other than 0"),
        ("[[instance]]\nfile = 'model.glb'\nmesh = 'chair'", 3, "places no mesh \"chair\""),
        ("[[gltf]]\nfile = 'model.glb'\nmesh = 'mesh'", 3, "use [[instance]]"),
        ("[[gltf]\n", 1, ""),
    ];
    for (text, expected_line, expected) in faults {
        match load_text(&folder, text) {
            Err(SceneError::SceneFile { line, problem, .. }) => {
                assert!(line == expected_line && problem.contains(expected), "{text:?}: {line}: {problem}");
            }
            other => panic!("{text:?} gives {other:?}"),
        }
    }
    let message = load_text(&folder, "[[gltf]]\nfile = 'none.glb'").unwrap_err().to_string();
    assert!(message.contains("none.glb: cannot be read"), "{message}");
}

#[test]
fn a_scale_beyond_f32_is_refused() {
    let text = "[environment]\nfile = 'sky.exr'\nscale = 1e38";
    let error = load_text(&folder(), text).unwrap_err();
    assert!(matches!(error, SceneError::Radiance { count: 1, x: 3, y: 0, .. }), "{error}");
}

#[test]
fn files_of_the_data_folder_are_found_there_and_subdivided() {
    let (folder, data) = (tempfile::tempdir().unwrap(), folder());
    let text =
        "[[gltf]]\nfile = \"data:model.glb\"\n[[instance]]\nfile = \"data:model.glb\"\nsubdivide = 1\n";
    let file = put(&folder, "scene.toml", text.as_bytes());
    let found = airglow_scene::load_with_data(&file, Some(data.path()));
    // A skin cannot be subdivided.
    assert!(matches!(found, Err(SceneError::Invalid { .. })), "{found:?}");
    let plain = text.replace("subdivide = 1", "");
    let file = put(&folder, "plain.toml", plain.as_bytes());
    assert!(!airglow_scene::load_with_data(&file, Some(data.path())).unwrap().meshes.is_empty());
    let refused = load(&file).unwrap_err().to_string();
    assert!(refused.contains("data:model.glb") && refused.contains("AIRGLOW_DATA"), "{refused}");
    let error = load_text(&folder, "[[gltf]]\nfile = \"a.glb\"\nsubdivide = 7\n").unwrap_err().to_string();
    assert!(error.contains("0 to 6"), "{error}");
}

/// A figure is posed by its animation, stands where its velocity has taken it, and brings no camera.
#[test]
fn figures_move() {
    let text = |more: &str| {
        format!(
            "[[figure]]\nfile = \"model.glb\"\ntranslation = [1, 0, 0]\nrotation = {{ yaw = 90 }}\n{more}"
        )
    };
    let folder = folder();
    let mut scene = load_text(&folder, &text("velocity = [0, 0, 2]\nspheres = 7")).unwrap();
    assert_eq!((scene.figures.len(), scene.cameras.len()), (1, 0));
    let figure = scene.figures[0].clone();
    assert_eq!((figure.name.as_str(), figure.spheres, figure.instances.clone()), ("figure 0", 7, 0..1));
    assert!(scene.moves(0) && !scene.moves(1));
    let rest = figure.meshes[0];
    let low = |scene: &Scene| {
        let positions = &scene.meshes[scene.instances[0].mesh].positions;
        positions.iter().copied().map(Vec3::from).fold(Vec3::INFINITY, Vec3::min)
    };
    scene.set_time(0.0);
    let (start, meshes) = (low(&scene), scene.meshes.len());
    assert_ne!(scene.instances[0].mesh, rest, "the mesh at rest stays");
    assert!(scene.meshes[scene.instances[0].mesh].joints.is_empty());
    let period = scene.animations[figure.animation.unwrap()].duration();
    scene.set_time(period);
    // Forwards along its own +Z, which the yaw turns to +X.
    assert!((low(&scene) - start - 2.0 * period * Vec3::X).length() < 1e-4, "{} after {start}", low(&scene));
    assert_eq!(scene.meshes.len(), meshes, "posed anew in the same place");
    let refused = |more: &str| load_text(&folder, &text(more)).unwrap_err().to_string();
    assert!(refused("animation = \"none\"").contains("it has ["), "{}", refused("animation = \"none\""));
    assert!(refused("spheres = 0").contains("1 to 1024"));
    assert!(refused("mesh = \"mesh\"").contains("unknown field"));
}
