//! What a host may come to need, and every pipeline of it, made ahead of the frames on a thread of the host's choice.

use std::collections::BTreeMap;
use std::sync::Arc;

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Blend, ComputePipeline, ComputePipelineDesc, Context, GpuError, GraphicsPipeline, GraphicsPipelineDesc,
};

use crate::RelightError;
use crate::kernels::{self, Kernel, Source};
use crate::relight::RECTANGLE_FORMAT;
use crate::settings::{LightKind, Method, Output, Settings, Storage};

/// Every [`Settings`] that can be made of these. What does not go together, such as normals and incident radiance, is
/// no part of it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Envelope {
    /// Orders, 1 to [`MAX_ORDER`](crate::MAX_ORDER).
    pub orders: Vec<usize>,
    /// Storages of baked vectors.
    pub storages: Vec<Storage>,
    /// What is written.
    pub outputs: Vec<Output>,
    /// How it is written.
    pub methods: Vec<Method>,
    /// Kinds of light.
    pub lights: Vec<LightKind>,
    /// Whether dynamic visibility may be needed.
    pub visibility: bool,
    /// Whether lighting from normals may be needed.
    pub normals: bool,
    /// Whether counting of bad texels may be needed.
    pub health: bool,
}

impl From<Settings> for Envelope {
    /// The envelope of these settings alone.
    fn from(settings: Settings) -> Self {
        Self {
            orders: vec![settings.order],
            storages: vec![settings.storage],
            outputs: vec![settings.output],
            methods: vec![settings.method],
            lights: vec![settings.light],
            visibility: settings.visibility,
            normals: settings.normals,
            health: settings.health,
        }
    }
}

impl Envelope {
    /// Every settings of the envelope that has kernels, each with all of visibility, normals and counting that it can
    /// have.
    ///
    /// # Errors
    /// [`RelightError::Order`] for an order without kernels, [`RelightError::Settings`] when no combination has any.
    pub fn settings(&self) -> Result<Vec<Settings>, RelightError> {
        let mut all = Vec::new();
        for &order in &self.orders {
            Settings { order, ..Settings::default() }.check()?;
            for (&storage, &output) in product(&self.storages, &self.outputs) {
                for (&method, &light) in product(&self.methods, &self.lights) {
                    let normals = self.normals && output == Output::Colour;
                    let Self { visibility, health, .. } = *self;
                    let settings =
                        Settings { order, storage, output, method, light, visibility, normals, health };
                    all.extend(settings.check().is_ok().then_some(settings));
                }
            }
        }
        if all.is_empty() {
            return Err(RelightError::Settings {
                what: "the envelope holds no combination that has kernels",
                mend: "give every list an entry, and Method::Compute for Output::Incident",
            });
        }
        Ok(all)
    }

    /// How many pipelines it takes.
    ///
    /// # Errors
    /// As [`Envelope::settings`].
    pub fn pipeline_count(&self) -> Result<usize, RelightError> {
        Ok(permutations(&self.settings()?).len())
    }

    /// Refuses settings outside, naming the first that is.
    ///
    /// # Errors
    /// [`RelightError::Envelope`].
    pub fn check(&self, settings: &Settings) -> Result<(), RelightError> {
        let Settings { order, storage, output, method, light, visibility, normals, health } = *settings;
        let fields = [
            (self.orders.contains(&order), "orders", format!("order {order}")),
            (self.storages.contains(&storage), "storages", format!("storage {storage:?}")),
            (self.outputs.contains(&output), "outputs", format!("output {output:?}")),
            (self.methods.contains(&method), "methods", format!("method {method:?}")),
            (self.lights.contains(&light), "lights", format!("light {light:?}")),
            (self.visibility || !visibility, "visibility", "dynamic visibility".to_owned()),
            (self.normals || !normals, "normals", "lighting from normals".to_owned()),
            (self.health || !health, "health", "counting of bad texels".to_owned()),
        ];
        match fields.into_iter().find(|(inside, ..)| !inside) {
            Some((_, field, setting)) => Err(RelightError::Envelope { setting, field }),
            None => Ok(()),
        }
    }
}

fn product<'a, A, B>(first: &'a [A], second: &'a [B]) -> impl Iterator<Item = (&'a A, &'a B)> {
    first.iter().flat_map(move |a| second.iter().map(move |b| (a, b)))
}

/// A pipeline by what it does; equal ones are the same pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Permutation {
    /// Where its module begins: modules are told apart by their place in the program.
    module: usize,
    method: Stage,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Stage {
    Compute,
    Fragment,
}

impl Permutation {
    fn new(kernel: &Kernel, method: Stage) -> Self {
        Self { module: kernel.spirv.as_ptr().addr(), method }
    }
}

/// The kernel over vertices of a source.
fn vertex_kernel(settings: &Settings, source: Source) -> (Permutation, Kernel) {
    let (kernel, method) = match settings.method {
        Method::Compute => (kernels::vertices(settings, source), Stage::Compute),
        Method::Fragment => (kernels::rectangle(settings, source), Stage::Fragment),
    };
    (Permutation::new(&kernel, method), kernel)
}

/// Every kernel that the settings can need.
pub(crate) fn kernels_of(settings: &Settings) -> impl Iterator<Item = Kernel> {
    permutations(&[*settings]).into_values()
}

/// Every kernel that some of `all` need, once.
fn permutations(all: &[Settings]) -> BTreeMap<Permutation, Kernel> {
    let of = |settings: &Settings| {
        let compute = |kernel: Kernel| (Permutation::new(&kernel, Stage::Compute), kernel);
        let order = settings.order;
        let mut found: Vec<_> =
            Source::all(settings).into_iter().map(|source| vertex_kernel(settings, source)).collect();
        if settings.light == LightKind::Uniform {
            let light = [kernels::environment_rows, kernels::environment_bands, kernels::rotate];
            found.extend(light.map(|kernel| compute(kernel(order))));
            found.extend(settings.health.then(|| compute(kernels::counted_environment_rows(order))));
            found.extend(settings.shadows().then(|| compute(kernels::product_matrix(order))));
        }
        found
    };
    all.iter().flat_map(of).collect()
}

/// Every pipeline of an [`Envelope`]: no [`Relight`](crate::Relight) made with it makes another, nor does any frame.
/// Clones refer to the same.
#[derive(Clone)]
pub struct Pipelines {
    shared: Arc<Made>,
}

struct Made {
    envelope: Envelope,
    pipelines: BTreeMap<Permutation, VertexPipeline>,
}

/// A pipeline over the vertices of a chunk, or of the light.
#[derive(Clone)]
pub(crate) enum VertexPipeline {
    Compute(ComputePipeline),
    Rectangle(GraphicsPipeline),
}

/// The kernels of the light.
pub(crate) struct LightPipelines {
    pub rows: ComputePipeline,
    pub bands: ComputePipeline,
    pub rotate: ComputePipeline,
    pub matrix: Option<ComputePipeline>,
}

impl Pipelines {
    /// Makes every pipeline of the envelope, on the thread that calls it, with the host's pipeline cache. Frames may
    /// be recorded on other threads meanwhile.
    ///
    /// # Errors
    /// As [`Envelope::settings`]; [`RelightError::Gpu`] when the device refuses.
    pub fn prepare(context: &Context, envelope: Envelope) -> Result<Self, RelightError> {
        let mut pipelines = BTreeMap::new();
        for (permutation, kernel) in permutations(&envelope.settings()?) {
            let pipeline = match permutation.method {
                Stage::Compute => VertexPipeline::Compute(compute(context, &kernel)?),
                Stage::Fragment => VertexPipeline::Rectangle(rectangle(context, &kernel)?),
            };
            pipelines.insert(permutation, pipeline);
        }
        Ok(Self { shared: Arc::new(Made { envelope, pipelines }) })
    }

    /// What they were prepared for.
    #[must_use]
    pub fn envelope(&self) -> &Envelope {
        &self.shared.envelope
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.shared.pipelines.len()
    }

    /// Those over vertices that the settings can need.
    pub(crate) fn vertices(&self, settings: &Settings) -> BTreeMap<Source, VertexPipeline> {
        let pipeline = |source| {
            let (permutation, _) = vertex_kernel(settings, source);
            Some((source, self.shared.pipelines.get(&permutation)?.clone()))
        };
        Source::all(settings).into_iter().filter_map(pipeline).collect()
    }

    /// Those of uniform light, where the settings have it.
    pub(crate) fn light(&self, settings: &Settings) -> Option<LightPipelines> {
        let compute = |kernel: fn(usize) -> Kernel| match self
            .shared
            .pipelines
            .get(&Permutation::new(&kernel(settings.order), Stage::Compute))?
        {
            VertexPipeline::Compute(pipeline) => Some(pipeline.clone()),
            VertexPipeline::Rectangle(_) => None,
        };
        if settings.light != LightKind::Uniform {
            return None;
        }
        let rows = match settings.health {
            true => kernels::counted_environment_rows,
            false => kernels::environment_rows,
        };
        Some(LightPipelines {
            rows: compute(rows)?,
            bands: compute(kernels::environment_bands)?,
            rotate: compute(kernels::rotate)?,
            matrix: compute(kernels::product_matrix),
        })
    }
}

/// A compute pipeline of a kernel.
pub(crate) fn compute(context: &Context, kernel: &Kernel) -> Result<ComputePipeline, GpuError> {
    context.create_compute_pipeline(&ComputePipelineDesc {
        name: kernel.name,
        spirv: &kernel.words(),
        bindings: &kernel.binding_descs(),
        push_constant_size: kernel.push_constant_size,
    })
}

fn rectangle(context: &Context, kernel: &Kernel) -> Result<GraphicsPipeline, GpuError> {
    context.create_graphics_pipeline(&GraphicsPipelineDesc {
        name: kernel.name,
        vertex: &kernels::rectangle_vertex(),
        fragment: Some(&kernel.words()),
        bindings: &kernel.binding_descs(),
        push_constant_size: kernel.push_constant_size,
        vertex_buffers: &[],
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        cull: vk::CullModeFlags::NONE,
        front_face: vk::FrontFace::COUNTER_CLOCKWISE,
        depth: None,
        colors: &[RECTANGLE_FORMAT],
        blend: Blend::None,
    })
}
