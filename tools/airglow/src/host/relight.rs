//! The relight pass as a scene asks for it, and what a plan says where it is left out.

#[cfg(feature = "radiance")]
use airglow::relight::LightKind;
use airglow::relight::{Settings, Storage as RelightStorage};
use airglow_graph::LeftOut;
use airglow_scene::{Scene, Storage};

#[cfg(feature = "radiance")]
use super::needed;
use super::transfer;

/// The pass's settings for a scene.
pub fn settings(scene: &Scene) -> Settings {
    Settings {
        order: scene.quality.order as usize,
        storage: match scene.quality.storage {
            Storage::F32 => RelightStorage::F32,
            Storage::F16 => RelightStorage::F16,
        },
        #[cfg(feature = "radiance")]
        light: match needed::near_light(scene) {
            true => LightKind::Vertex,
            false => LightKind::Uniform,
        },
        #[cfg(feature = "shadow")]
        visibility: super::shadow::is_drawn(scene),
        normals: !scene.figures.is_empty(),
        ..Settings::default()
    }
}

/// Bytes that the pass would hold and make for a scene: transfer of all meshes, colours of all instances.
pub fn bytes(scene: &Scene) -> u64 {
    let settings = settings(scene);
    let [baked, drawn] = transfer::vertex_counts(scene);
    baked * settings.vector_bytes() + drawn * settings.output_bytes()
}

/// The record of the relight pass being left out by the host.
pub fn left_out(why: &str, would_return: &str, bytes: u64, time: Option<f64>) -> LeftOut {
    LeftOut {
        what: "relight".to_owned(),
        why: why.to_owned(),
        bytes,
        time,
        would_return: would_return.to_owned(),
    }
}

/// The record of the pass being left out because there is nothing to relight by.
pub fn no_environment(bytes: u64, time: Option<f64>) -> LeftOut {
    let returns = "an environment, named in the scene file or with --environment";
    left_out("the scene has no environment", returns, bytes, time)
}
