//! What lights the vertices, on the device. What is left out is not there: no kernels, no bake, no memory.

use airglow::relight::{MeshId, Orientation, Relight};
use airglow_gpu::{Buffer, Requirements};
use airglow_graph::Access;
use airglow_scene::Scene;

use super::device::Device;
use super::source::{Reason, Source};
use super::transfer::{InstanceTransfer, SceneTransfer};
use super::{relight, upload};
use crate::failure::{Failure, Outcome};

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

/// What the device must offer for a scene that `source` lights, with all passes of its frame.
pub fn requirements(source: &Source, scene: &Scene) -> Requirements {
    let requirements = match source {
        Source::Relight(_) => Relight::requirements(&relight::settings(scene)),
        Source::Colours(_) | Source::Even(_) => Requirements::engine(),
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
        let settings = airglow::relight::Settings { health: transfer.health, ..relight::settings(scene) };
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
