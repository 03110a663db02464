//! The passes over the vertices of a scene in a graph of their own, and what they leave, read back.

use airglow::relight::{Environment, Frame, Instance, Light};
use airglow_gpu::{Execution, Imports};
use airglow_graph::{Access, Graph};

use super::Shown;
use crate::failure::{Failure, Outcome};
use crate::host::frame;
use crate::host::kept::Kept;
use crate::host::lighting::Lighting;
#[cfg(feature = "radiance")]
use crate::host::near::Arrival;
use crate::host::renderer::Renderer;

/// What the passes made, for each instance; empty where there was no such pass.
#[derive(Default)]
pub struct Probed {
    /// `[f32; 4]` a vertex: the light that a white diffuse surface sends out.
    pub colours: Vec<Vec<[f32; 4]>>,
    /// Dynamic visibility, as many coefficients a vertex as relighting has.
    #[cfg(feature = "shadow")]
    pub visibility: Vec<Vec<f32>>,
    /// Light of near emitters, as many coefficients a vertex.
    #[cfg(feature = "radiance")]
    pub light: Vec<Vec<[f32; 3]>>,
    /// Spheres looked at by each cluster of receivers, and receivers clamped.
    #[cfg(feature = "shadow")]
    pub records: Vec<Vec<[u32; 2]>>,
}

impl Shown<'_> {
    /// Runs them once.
    pub fn probe(&self, renderer: &mut Renderer<'_>) -> Outcome<Probed> {
        let context = self.device.context();
        let (mut graph, mut imports) = (Graph::new(), Imports::new());
        let filter = frame::filter(renderer, &self.settings);
        #[cfg(feature = "radiance")]
        let extinction = frame::extinction(renderer, &self.settings);
        let posed = renderer.skins.as_ref().map_or(Vec::new(), |skins| skins.add(&mut graph, &mut imports));
        let environment =
            renderer.scene.environment.as_ref().zip(renderer.environment.as_ref()).map(|(sky, map)| {
                let image = sky.map.image();
                let sampled = Access::FragmentSampled;
                let handle = graph.import_image("environment", *image.desc(), sampled, sampled);
                imports.image(&handle, image);
                let (width, height, rotation) = (map.width, map.height, self.settings.turn * map.rotation);
                Light::Environment(Environment { image: handle, width, height, revision: 1, rotation })
            });
        let Lighting::Relight(lit) = &mut renderer.lighting else {
            return Err(Failure::input(
                "nothing is relit in this scene: it needs an environment or an [[emitter]]",
            ));
        };
        #[cfg(feature = "shadow")]
        let shadowed = lit
            .shadow
            .as_ref()
            .map_or_else(Default::default, |shadow| shadow.add(&mut graph, &mut imports, &posed, true));
        let instances = lit.instances.iter().zip(lit.orientations()).enumerate();
        let instances = instances.map(|(number, (instance, orientation))| Instance {
            orientation,
            #[cfg(feature = "shadow")]
            visibility: shadowed.visibility.get(number).copied().flatten(),
            normals: posed.iter().find(|posed| posed.instance == number).map(|posed| posed.normals),
            ..Instance::new(lit.meshes[instance.transfer])
        });
        #[cfg_attr(not(feature = "radiance"), expect(unused_mut, reason = "only near emitters change it"))]
        let mut relit =
            Frame { light: environment.unwrap_or(Light::None), instances: instances.collect(), target: None };
        #[cfg(feature = "radiance")]
        if let Some(near) = &lit.near {
            let arrival = Arrival { turn: self.settings.turn, filter: filter.as_deref(), extinction };
            let sampled = near.add(&mut graph, &mut imports, arrival)?;
            relit.light = if sampled.light.is_empty() { Light::None } else { Light::Vertices };
            relit
                .instances
                .iter_mut()
                .zip(sampled.light)
                .for_each(|(instance, light)| instance.light = Some(light));
        }
        let kept = |graph: &mut Graph<_>, buffer: Option<_>| {
            buffer.map(|buffer| Kept::add(graph, "read back", buffer))
        };
        #[cfg(feature = "radiance")]
        let light: Vec<_> = relit.instances.iter().map(|instance| kept(&mut graph, instance.light)).collect();
        #[cfg(feature = "shadow")]
        let visibility: Vec<_> =
            relit.instances.iter().map(|instance| kept(&mut graph, instance.visibility)).collect();
        let result = lit.relight.add(context, &mut graph, &mut imports, &relit).map_err(Failure::work)?;
        if let (Some(rotations), Some(factors)) = (&result.rotations, &filter) {
            rotations.set_filter(factors).map_err(Failure::work)?;
        }
        let colours = kept(&mut graph, result.results);
        let plan = graph.compile(&context.graph_limits()).map_err(Failure::work)?;
        let mut execution = Execution::prepare(context, plan).map_err(Failure::work)?;
        self.device.frames(&mut execution, &imports, None, 1, |_| Ok(()))?;
        let all: Vec<[f32; 4]> = colours.map_or(Ok(Vec::new()), |kept| kept.take())?;
        let of = |range: &airglow::relight::ResultRange| {
            let first = (range.offset / 16) as usize;
            all.get(first..first + (range.size / 16) as usize).unwrap_or_default().to_vec()
        };
        Ok(Probed {
            colours: result.ranges.iter().map(of).collect(),
            #[cfg(feature = "shadow")]
            visibility: taken(&visibility)?,
            #[cfg(feature = "radiance")]
            light: taken(&light)?,
            #[cfg(feature = "shadow")]
            records: records(&shadowed)?,
        })
    }
}

/// What was kept of each instance; nothing of those without.
#[cfg(any(feature = "radiance", feature = "shadow"))]
fn taken<T: bytemuck::Pod>(kept: &[Option<Kept>]) -> Outcome<Vec<Vec<T>>> {
    kept.iter().map(|kept| kept.as_ref().map_or(Ok(Vec::new()), Kept::take)).collect()
}

/// The records of each instance, of which those without a shadow have none.
#[cfg(feature = "shadow")]
fn records(shadowed: &crate::host::shadow::Shadowed) -> Outcome<Vec<Vec<[u32; 2]>>> {
    let mut slots = shadowed.counts.iter();
    let of = |visibility: &Option<_>| match visibility {
        Some(_) => slots.next().map_or(Ok(Vec::new()), Kept::take),
        None => Ok(Vec::new()),
    };
    shadowed.visibility.iter().map(of).collect()
}
