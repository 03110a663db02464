//! The options of every command that takes a scene.

use std::path::{Path, PathBuf};

use airglow_math::Preset;
use airglow_scene::{LIGHT_TRANSPORT, Presets, Quality, Scene, Shadow, Storage};
use clap::{Args, ValueEnum};

use crate::failure::{Failure, Outcome};
use crate::host::unread;
use crate::output::Output;

/// Where bakes are kept, unless told otherwise.
pub const CACHE: &str = ".cache/airglow";

/// The variable that names the folder of files that scene files name `data:…`.
const DATA: &str = "AIRGLOW_DATA";

/// A scene, and what its light transport is computed with.
#[derive(Clone, Debug, Args)]
pub struct SceneOptions {
    /// A scene file (.toml) or a glTF file (.glb, .gltf).
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Light the scene by this equirectangular map (.exr, .hdr) instead of the scene file's.
    #[arg(long, value_name = "FILE")]
    pub environment: Option<PathBuf>,
    /// How exactly the passes work, instead of the scene file's: low, medium, high or reference; or one of them for one
    /// pass, as in fog=high. May be given several times.
    #[arg(long, value_name = "[PASS=]NAME", value_parser = preset)]
    pub preset: Vec<PresetOption>,
    /// Bands of spherical harmonics, 1 to 6, instead of the scene file's.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=6))]
    pub order: Option<u32>,
    /// Rays for each vertex of the bake, instead of the scene file's.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub rays: Option<u32>,
    /// Number format of transfer vectors on the device, instead of the scene file's.
    #[arg(long, value_enum)]
    pub storage: Option<StorageName>,
    /// What casts shadows on what, instead of the scene file's.
    #[arg(long, value_enum)]
    pub shadow: Option<ShadowName>,
    /// Seconds after the scene's time 0: figures stand where they are then.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    pub time: f64,
    /// Folder of baked transfer and of fitted spheres.
    #[arg(long, value_name = "FOLDER", default_value = CACHE)]
    pub cache: PathBuf,
}

/// `--storage`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StorageName {
    /// 4 bytes a coefficient.
    F32,
    /// 2 bytes a coefficient.
    F16,
}

/// `--shadow`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShadowName {
    /// Everything shadows everything: one bake for each instance.
    Scene,
    /// Each mesh shadows itself: one bake for each mesh.
    Object,
    /// Nothing casts a shadow.
    Unshadowed,
}

/// `--preset`: for all passes, or for one of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PresetOption {
    room: Option<&'static str>,
    preset: Preset,
}

/// The rooms that presets speak of, by name.
pub const ROOMS: [&str; 5] = ["relight", "fog", "radiance", "normals", "shadow"];

/// Reads `--preset`.
fn preset(text: &str) -> Result<PresetOption, String> {
    let (room, name) = match text.split_once('=') {
        Some((room, name)) => (Some(room), name),
        None => (None, text),
    };
    let known = |room| ROOMS.into_iter().find(|known| *known == room);
    let room = match room {
        Some(room) => {
            Some(known(room).ok_or_else(|| format!("there is no pass `{room}`; give {}", ROOMS.join(", ")))?)
        }
        None => None,
    };
    Ok(PresetOption { room, preset: name.parse().map_err(|error| format!("{error}"))? })
}

/// Applies what the command line says of presets, which goes before what the scene file says of anything.
fn ask(scene: &mut Scene, asked: &[PresetOption]) {
    let Presets { all, rooms } = &mut scene.presets;
    for option in asked {
        match option.room {
            Some(room) => {
                rooms.insert(room.to_owned(), option.preset);
            }
            None => {
                rooms.clear();
                *all = Some(option.preset);
            }
        }
        if option.room.is_none_or(|room| room == LIGHT_TRANSPORT) {
            scene.quality = Quality { shadow: scene.quality.shadow, ..option.preset.into() };
        }
    }
}

impl SceneOptions {
    /// A scene as its file says, lit by another environment if one is named.
    pub fn plain(scene: &Path, environment: Option<&Path>) -> Self {
        Self {
            scene: scene.to_owned(),
            environment: environment.map(Path::to_owned),
            preset: Vec::new(),
            order: None,
            rays: None,
            storage: None,
            shadow: None,
            time: 0.0,
            cache: PathBuf::from(CACHE),
        }
    }

    /// Loads the scene, repeats its warnings, and applies the options that override it.
    pub fn load(&self, output: &Output) -> Outcome<Scene> {
        let data = std::env::var_os(DATA).map(PathBuf::from);
        let mut scene =
            airglow_scene::load_with_data(&self.scene, data.as_deref()).map_err(Failure::input)?;
        for warning in scene.warnings.iter().map(ToString::to_string).chain(unread::warnings(&scene)) {
            output.warn(warning);
        }
        if scene.instances.is_empty() {
            return Err(Failure::input(format!(
                "{}: there is nothing to draw; add a mesh",
                self.scene.display()
            )));
        }
        scene.set_time(self.time as f32);
        if let Some(path) = &self.environment {
            let environment = airglow_scene::image_io::read_environment(path).map_err(Failure::input)?;
            let distance = scene.environment.and_then(|stated| stated.distance);
            scene.environment = Some(airglow_scene::Environment { distance, ..environment });
        }
        #[cfg(all(feature = "radiance", feature = "relight"))]
        crate::host::emitters::place(&mut scene);
        let endless = scene.environment.as_ref().is_some_and(|environment| environment.distance.is_none());
        if endless && scene.medium.is_some() {
            output.warn(
                "no light of the environment comes through the medium without end before it; state `distance`, metres, \
                 in [environment] of the scene file",
            );
        }
        if let Some(unknown) = scene.presets.rooms.keys().find(|room| !ROOMS.contains(&room.as_str())) {
            output.warn(format!("[quality.presets] of the scene file: there is no pass {unknown:?}"));
        }
        ask(&mut scene, &self.preset);
        let quality = &mut scene.quality;
        *quality = Quality {
            order: self.order.unwrap_or(quality.order),
            rays: self.rays.unwrap_or(quality.rays),
            storage: self.storage.map_or(quality.storage, |name| match name {
                StorageName::F32 => Storage::F32,
                StorageName::F16 => Storage::F16,
            }),
            shadow: self.shadow.map_or(quality.shadow, |name| match name {
                ShadowName::Scene => Shadow::Scene,
                ShadowName::Object => Shadow::Object,
                ShadowName::Unshadowed => Shadow::Unshadowed,
            }),
        };
        Ok(scene)
    }
}
