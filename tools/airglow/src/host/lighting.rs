//! Where the light of the vertices comes from. What is left out is not there: no kernels, no bake, no memory.

use std::path::Path;

use airglow::relight::{MeshId, Orientation, Relight, Storage as RelightStorage};
use airglow_gpu::{Buffer, Requirements};
use airglow_graph::{Access, LeftOut};
use airglow_scene::{Scene, Storage};

use super::device::Device;
use super::transfer::{self, InstanceTransfer, SceneTransfer};
use super::upload;
use crate::failure::{Failure, Outcome};
use crate::output::Output;

/// Where the light of a scene's vertices comes from, before anything is on the device.
pub enum Source {
    /// The relight pass, with this transfer.
    Relight(SceneTransfer),
    /// Colours that the host computed, one list for each instance.
    Colours(Vec<Vec<[f32; 3]>>),
    /// Evenly from everywhere: the pass is left out.
    Even(Reason),
}

/// Why a scene is lit evenly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// There is nothing to relight by.
    NoEnvironment,
    /// The command line says so.
    Asked,
}

/// A [`Source`] on the device.
pub(super) enum Lighting {
    /// The pass and its meshes.
    Relight(Box<Lit>),
    /// Colours of all vertices, from an array of the host's.
    Colours(HostColours),
    /// Evenly from everywhere.
    Even(Reason),
}

/// The pass with a scene's transfer.
pub(super) struct Lit {
    pub(super) relight: Relight,
    pub(super) meshes: Vec<MeshId>,
    pub(super) instances: Vec<InstanceTransfer>,
    /// The shadows of what moves, where something does.
    #[cfg(feature = "shadow")]
    pub(super) shadow: Option<super::shadow::SceneShadow>,
    /// The radiance that meets surfaces with normal maps, where there are some.
    #[cfg(feature = "normals")]
    pub(super) incident: Option<super::incident::Incident>,
    /// The light of near emitters, where the scene has them.
    #[cfg(feature = "radiance")]
    pub(super) near: Option<super::near::NearLight>,
}

/// Colours of all vertices that the host computed itself.
pub(super) struct HostColours {
    pub(super) buffer: Buffer,
    /// First byte and size for each instance.
    pub(super) ranges: Vec<(u64, u64)>,
}

impl Source {
    /// The pass with its transfer, baked or found in `cache`, or nothing where the pass has nothing to do.
    pub fn of_scene(scene: &Scene, without_relight: bool, cache: &Path, output: &Output) -> Outcome<Self> {
        match (is_lit(scene), without_relight) {
            (_, true) => Ok(Self::Even(Reason::Asked)),
            (false, false) => Ok(Self::Even(Reason::NoEnvironment)),
            (true, false) => transfer::of_scene(scene, &scene.quality, cache, output).map(Self::Relight),
        }
    }

    /// The same without a bake, for plans alone.
    pub fn unbaked(scene: &Scene, without_relight: bool) -> Outcome<Self> {
        match (is_lit(scene), without_relight) {
            (_, true) => Ok(Self::Even(Reason::Asked)),
            (false, false) => Ok(Self::Even(Reason::NoEnvironment)),
            (true, false) => transfer::unbaked(scene).map(Self::Relight),
        }
    }

    /// Has the pass count bad texels of the environment, where there is the pass.
    pub fn count_health(&mut self) {
        if let Self::Relight(transfer) = self {
            transfer.health = true;
        }
    }

    /// What the device must offer.
    pub fn requirements(&self, scene: &Scene) -> Requirements {
        let requirements = match self {
            Self::Relight(_) => Relight::requirements(&relight_settings(scene)),
            Self::Colours(_) | Self::Even(_) => Requirements::engine(),
        };
        #[cfg(feature = "radiance")]
        let requirements = requirements.and(&super::near::requirements(scene));
        #[cfg(feature = "fog")]
        let requirements = requirements.and(&super::fog::requirements(scene));
        #[cfg(feature = "shadow")]
        let requirements = requirements.and(&super::shadow::requirements(scene));
        #[cfg(feature = "normals")]
        let requirements = requirements.and(&super::mapped::requirements(scene));
        requirements
    }
}

/// Whether a scene has light for the relight pass.
pub(super) fn is_lit(scene: &Scene) -> bool {
    #[cfg(feature = "radiance")]
    let near = super::near::is_drawn(scene);
    #[cfg(not(feature = "radiance"))]
    let near = false;
    scene.environment.is_some() || near
}

impl Lighting {
    /// Prepares what `source` needs and nothing else.
    pub(super) fn new(device: &Device<'_>, scene: &Scene, source: &Source) -> Outcome<Self> {
        Ok(match source {
            Source::Relight(transfer) => Self::Relight(Box::new(Lit::new(device, scene, transfer)?)),
            Source::Colours(colours) => Self::Colours(HostColours::new(device, colours)?),
            Source::Even(reason) => Self::Even(*reason),
        })
    }
}

impl Lit {
    fn new(device: &Device<'_>, scene: &Scene, transfer: &SceneTransfer) -> Outcome<Self> {
        let context = device.context();
        let settings = airglow::relight::Settings { health: transfer.health, ..relight_settings(scene) };
        let mut relight = Relight::new(context, settings).map_err(Failure::work)?;
        let mut meshes = Vec::with_capacity(transfer.transfers.len());
        for (index, (baked, account)) in transfer.transfers.iter().zip(&transfer.accounts).enumerate() {
            let count = baked.vertex_count as u32;
            let moves = transfer.instances.iter().any(|lit| lit.moves && lit.transfer == index);
            let vectors = (!moves).then_some(&baked.coefficients[..]);
            let mesh = relight.add_mesh(context, &account.name, count, vectors);
            meshes.push(mesh.map_err(Failure::work)?);
        }
        Ok(Self {
            relight,
            meshes,
            instances: transfer.instances.clone(),
            #[cfg(feature = "shadow")]
            shadow: super::shadow::SceneShadow::new(device, scene, transfer)?,
            #[cfg(feature = "radiance")]
            near: super::near::NearLight::new(context, scene, transfer)?,
            #[cfg(feature = "normals")]
            incident: super::incident::Incident::new(context, scene, transfer)?,
        })
    }

    /// How each instance stands to the space its transfer is in.
    pub(super) fn orientations(&self) -> Vec<Orientation> {
        let orientation = |&InstanceTransfer { rotation, inverted, .. }: &InstanceTransfer| Orientation {
            rotation,
            inverted,
        };
        self.instances.iter().map(orientation).collect()
    }
}

impl HostColours {
    fn new(device: &Device<'_>, colours: &[Vec<[f32; 3]>]) -> Outcome<Self> {
        let mut all: Vec<[f32; 4]> = Vec::new();
        let mut ranges = Vec::with_capacity(colours.len());
        for colours in colours {
            ranges.push((16 * all.len() as u64, 16 * colours.len() as u64));
            all.extend(colours.iter().map(|&[r, g, b]| [r, g, b, 1.0]));
        }
        let buffer = device
            .run(|recorder| upload::buffer(recorder, "reference colours", &all, Access::VertexBuffer))
            .map_err(Failure::work)?;
        Ok(Self { buffer, ranges })
    }
}

/// The pass's settings for a scene.
pub(super) fn relight_settings(scene: &Scene) -> airglow::relight::Settings {
    airglow::relight::Settings {
        order: scene.quality.order as usize,
        storage: match scene.quality.storage {
            Storage::F32 => RelightStorage::F32,
            Storage::F16 => RelightStorage::F16,
        },
        #[cfg(feature = "radiance")]
        light: match super::near::is_drawn(scene) {
            true => airglow::relight::LightKind::Vertex,
            false => airglow::relight::LightKind::Uniform,
        },
        #[cfg(feature = "shadow")]
        visibility: super::shadow::is_drawn(scene),
        normals: !scene.figures.is_empty(),
        ..airglow::relight::Settings::default()
    }
}

/// Bytes that the pass would hold and make for a scene: transfer of all meshes, colours of all instances.
pub fn relight_bytes(scene: &Scene) -> u64 {
    let settings = relight_settings(scene);
    let [baked, drawn] = transfer::vertex_counts(scene);
    baked * settings.vector_bytes() + drawn * settings.output_bytes()
}

/// The record of the relight pass being left out by the host.
pub(super) fn left_out(why: &str, would_return: &str, bytes: u64, time: Option<f64>) -> LeftOut {
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
