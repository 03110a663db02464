//! glTF, environments and scene files to plain meshes, lights, images and cameras; every error names file, item
//! and mend.
//!
//! [`load`] reads a glTF 2.0 file or a TOML scene file into a [`Scene`], which is plain data: arrays, numbers and
//! glam matrices. What the crate does not read stands in [`Scene::warnings`]. [`image_io`] reads and writes
//! pictures, [`exposure`] and [`tone`] take them to the display.
//!
//! Input is not trusted: sizes are checked against [`limits`] before memory is taken, and a broken or hostile
//! file is an error, never a panic.
//!
//! ```no_run
//! let scene = airglow_scene::load("room.toml".as_ref())?;
//! for warning in &scene.warnings {
//!     eprintln!("{warning}");
//! }
//! for instance in &scene.instances {
//!     let mesh = &scene.meshes[instance.mesh];
//!     println!("{}: {} triangles at {}", mesh.name, mesh.triangle_count(), instance.transform);
//! }
//! # Ok::<(), airglow_scene::SceneError>(())
//! ```

#![forbid(unsafe_code)]

mod animation;
mod camera;
mod environment;
mod error;
pub mod exposure;
mod false_colour;
mod figure;
mod files;
pub mod geometry;
mod gltf_file;
mod image;
pub mod image_io;
mod light;
pub mod limits;
mod material;
mod mesh;
mod motion;
mod pose;
mod presets;
mod scene;
mod scene_file;
mod settings;
pub mod tone;
mod warning;

use std::path::Path;

pub use animation::{Animation, Channel, ChannelValues, Interpolation, LocalTransform, Node, Skin};
pub use camera::{Camera, Projection, Sphere};
pub use environment::Environment;
pub use error::SceneError;
pub use exposure::Exposure;
pub use false_colour::false_colour;
pub use figure::Figure;
pub use files::write_atomically;
pub use image::{Encoding, FloatImage, Image, luminance, srgb_decode, srgb_encode};
pub use light::{Blocker, Emitter, EmitterShape, Light, LightKind, Medium, VISIBILITY_CONTRAST};
pub use material::{AlphaMode, IDENTITY_UV, LAMBERT_ROUGHNESS, Material, MaterialClass, Texture, Wrap};
pub use mesh::{ContentHash, Mesh};
pub use presets::{LIGHT_TRANSPORT, Presets};
pub use scene::{Instance, Scene};
pub use settings::{Quality, Shadow, Storage};
pub use warning::Warning;

/// Loads a scene: a `.toml` scene file, or a `.glb` or `.gltf` file by itself.
///
/// # Errors
/// [`SceneError`] if a file is missing, broken, too large or asks for something that cannot be left out.
pub fn load(file: &Path) -> Result<Scene, SceneError> {
    load_with_data(file, None)
}

/// The same, with the folder in which glTF files lie that a scene file names `data:…`: large ones that are not shipped
/// with it.
///
/// # Errors
/// As [`load`], and where a scene file names such a file and there is no folder.
pub fn load_with_data(file: &Path, data: Option<&Path>) -> Result<Scene, SceneError> {
    let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    let scene = match extension.to_ascii_lowercase().as_str() {
        "toml" => scene_file::load(file, data)?,
        "glb" | "gltf" => gltf_file::load(file)?,
        other => {
            let feature = format!("the file name extension {other:?}");
            let mend = "name a .toml scene file, a .glb or a .gltf file";
            return Err(error::unsupported(file, "file", feature, mend));
        }
    };
    match scene.find_far_instance() {
        Some(instance) => {
            let item = format!("instance {:?}", instance.name);
            let problem =
                format!("a vertex lies farther than {:e} m from the origin", limits::MAX_COORDINATE);
            Err(error::invalid(file, item, problem, "scale the scene down"))
        }
        None => Ok(scene),
    }
}
