//! Scene files: TOML that names glTF files and an environment and adds what glTF cannot say. This crate's README
//! describes every table.

mod figure;
mod place;
mod placed;
mod schema;
mod values;

use std::path::Path;

use place::Builder;
use schema::{CameraTable, EnvironmentTable, SceneFile};

use crate::camera::{Camera, Projection};
use crate::environment::Environment;
use crate::error::SceneError;
use crate::files;
use crate::image::FloatImage;
use crate::image_io::{check_radiance, read_environment};
use crate::limits::MAX_SCENE_FILE_BYTES;
use crate::scene::Scene;
use crate::warning::Warning;

/// Loads a scene file and what it names; `data` is the folder of files that it names `data:…`.
pub(crate) fn load(file: &Path, data: Option<&Path>) -> Result<Scene, SceneError> {
    let bytes = files::read(file, MAX_SCENE_FILE_BYTES)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let problem = "not UTF-8 text; save the scene file as UTF-8".to_owned();
        at(file, &String::from_utf8_lossy(&bytes[..error.valid_up_to()]), error.valid_up_to(), problem)
    })?;
    let parsed: SceneFile = toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        at(file, text, start, error.message().to_owned())
    })?;
    build(Builder::new(file, data), text, parsed)
}

fn build(mut builder: Builder<'_>, text: &str, parsed: SceneFile) -> Result<Scene, SceneError> {
    let file = builder.file;
    for entry in &parsed.gltf {
        if let Some(mesh) = &entry.mesh {
            let problem = "[[gltf]] places a whole file; use [[instance]] to place one mesh".to_owned();
            return Err(at(file, text, mesh.span().start, problem));
        }
        builder.place_file(entry)?;
    }
    for entry in &parsed.instance {
        let count = builder.place_meshes(entry)?;
        if let (0, Some(mesh)) = (count, &entry.mesh) {
            let (mesh, named) = (mesh.span().start, mesh.get_ref());
            let problem = format!("{} places no mesh {named:?}; name one it has", entry.file.display());
            return Err(at(file, text, mesh, problem));
        }
    }
    for (index, table) in parsed.figure.iter().enumerate() {
        figure::place(file, text, table, index, &mut builder)?;
    }
    let environment =
        parsed.environment.map(|table| environment(&builder.resolve(&table.file), &table)).transpose()?;
    let camera = parsed.camera.map(|table| camera(file, text, table, &builder.scene)).transpose()?;
    let mut scene = Scene {
        environment,
        chosen_camera: camera,
        medium: parsed.medium.map(|table| table.0),
        exposure: parsed.exposure.0,
        quality: parsed.quality.quality,
        presets: parsed.quality.presets,
        ..builder.scene
    };
    let emitters = parsed.emitter.into_iter().enumerate();
    scene.emitters = emitters.map(|(index, table)| table.emitter(index)).collect();
    let blockers = parsed.blocker.into_iter().enumerate();
    scene.blockers = blockers.map(|(index, table)| table.blocker(index)).collect();
    if scene.instances.is_empty() {
        let message = "no mesh is placed; add a [[gltf]] table".to_owned();
        scene.warnings.push(Warning { file: file.to_path_buf(), item: "scene".into(), message });
    }
    Ok(scene)
}

fn environment(path: &Path, table: &EnvironmentTable) -> Result<Environment, SceneError> {
    let mut environment = read_environment(path)?;
    environment.rotation = table.rotation.0;
    environment.distance = table.distance.map(|distance| distance.0);
    if let Some(scale) = table.scale {
        environment.pixels.as_flattened_mut().iter_mut().for_each(|value| *value *= scale.0);
        // A large scale may have left the range of f32.
        let (width, height) = (environment.width, environment.height);
        let scaled = FloatImage { width, height, pixels: environment.pixels };
        check_radiance(path, &scaled)?;
        environment.pixels = scaled.pixels;
    }
    Ok(environment)
}

fn camera(file: &Path, text: &str, table: CameraTable, scene: &Scene) -> Result<Camera, SceneError> {
    match table {
        CameraTable::Named(name) => {
            let found = scene.cameras.iter().find(|camera| camera.name == *name.get_ref());
            found.cloned().ok_or_else(|| {
                let names: Vec<_> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
                let problem =
                    format!("no camera {:?} in the glTF files; they have {names:?}", name.get_ref());
                at(file, text, name.span().start, problem)
            })
        }
        CameraTable::Stated { from, to, up, vertical_degrees, near, far } => {
            let vertical_angle = vertical_degrees.to_radians();
            let projection = Projection::Perspective { vertical_angle, near, far, aspect: None };
            Camera::look_at("scene file", from, to, up, projection)
                .ok_or_else(|| at(file, text, 0, "the camera looks along its up direction".into()))
        }
    }
}

/// An error at byte `offset` of `text`.
fn at(file: &Path, text: &str, offset: usize, problem: String) -> SceneError {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    SceneError::SceneFile { file: file.to_path_buf(), line, column, problem }
}
