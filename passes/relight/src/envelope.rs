//! What a host may come to need, and every pipeline of it, made ahead of the frames on a thread of the host's choice.

use std::collections::BTreeMap;

use airglow_gpu::{ComputePipeline, Context, GpuError, GraphicsPipeline, Outside, Permutations, Stages};

use crate::RelightError;
use crate::kernels::{self, Kernel, Source};
use crate::pack::RECTANGLE_FORMAT;
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

    /// Refuses settings outside, naming the first that is.
    ///
    /// # Errors
    /// [`RelightError::Envelope`].
    pub fn check(&self, settings: &Settings) -> Result<(), RelightError> {
        let Settings { order, storage, output, method, light, visibility, normals, health } = *settings;
        Ok(Outside::check([
            (self.orders.contains(&order), "orders", format!("order {order}")),
            (self.storages.contains(&storage), "storages", format!("storage {storage:?}")),
            (self.outputs.contains(&output), "outputs", format!("output {output:?}")),
            (self.methods.contains(&method), "methods", format!("method {method:?}")),
            (self.lights.contains(&light), "lights", format!("light {light:?}")),
            (self.visibility || !visibility, "visibility", "dynamic visibility".to_owned()),
            (self.normals || !normals, "normals", "lighting from normals".to_owned()),
            (self.health || !health, "health", "counting of bad texels".to_owned()),
        ])?)
    }
}

impl Permutations for Envelope {
    type Error = RelightError;

    fn kernels(&self) -> Result<Vec<airglow_gpu::Kernel>, RelightError> {
        let of = |settings: &Settings| kernels_of(settings).into_iter().map(Made::kernel);
        Ok(self.settings()?.iter().flat_map(of).collect())
    }
}

fn product<'a, A, B>(first: &'a [A], second: &'a [B]) -> impl Iterator<Item = (&'a A, &'a B)> {
    first.iter().flat_map(move |a| second.iter().map(move |b| (a, b)))
}

/// Every pipeline of an [`Envelope`]: no [`Relight`](crate::Relight) made with it makes another, nor does any frame.
pub type Pipelines = airglow_gpu::Pipelines<Envelope>;

/// A kernel and the stages that it is made for.
#[derive(Clone, Copy)]
pub(crate) struct Made {
    pub kernel: Kernel,
    method: Method,
}

impl Made {
    fn compute(kernel: Kernel) -> Self {
        Self { kernel, method: Method::Compute }
    }

    /// What its pipeline is made of.
    fn kernel(self) -> airglow_gpu::Kernel {
        let Kernel { name, spirv, push_constant_size, .. } = self.kernel;
        let stages = match self.method {
            Method::Compute => Stages::Compute(spirv),
            Method::Fragment => Stages::Rectangles {
                vertex: kernels::RECTANGLE_VERTEX,
                fragment: spirv,
                vertex_buffers: &[],
                format: RECTANGLE_FORMAT,
            },
        };
        let bindings = self.kernel.binding_descs();
        airglow_gpu::Kernel { name, stages, bindings, push_constant_size }
    }
}

/// The kernel over vertices of a source.
fn vertex_kernel(settings: &Settings, source: Source) -> Made {
    let method = settings.method;
    let kernel = match method {
        Method::Compute => kernels::vertices(settings, source),
        Method::Fragment => kernels::rectangle(settings, source),
    };
    Made { kernel, method }
}

/// Every kernel that the settings can need.
pub(crate) fn kernels_of(settings: &Settings) -> Vec<Made> {
    let order = settings.order;
    let mut found: Vec<_> =
        Source::all(settings).into_iter().map(|source| vertex_kernel(settings, source)).collect();
    if settings.light == LightKind::Uniform {
        let mut light =
            vec![kernels::environment_rows(order), kernels::environment_bands(order), kernels::rotate(order)];
        light.extend(settings.health.then(|| kernels::counted_environment_rows(order)));
        light.extend(settings.shadows().then(|| kernels::product_matrix(order)));
        found.extend(light.into_iter().map(Made::compute));
    }
    found
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

/// Those over vertices that the settings can need.
pub(crate) fn of_vertices(
    pipelines: &Pipelines,
    settings: &Settings,
) -> Result<BTreeMap<Source, VertexPipeline>, GpuError> {
    let pipeline = |source| {
        let kernel = vertex_kernel(settings, source).kernel();
        let found = match settings.method {
            Method::Compute => VertexPipeline::Compute(pipelines.compute(&kernel)?),
            Method::Fragment => VertexPipeline::Rectangle(pipelines.graphics(&kernel)?),
        };
        Ok((source, found))
    };
    Source::all(settings).into_iter().map(pipeline).collect()
}

/// Those of uniform light, where the settings have it.
pub(crate) fn of_light(
    pipelines: &Pipelines,
    settings: &Settings,
) -> Result<Option<LightPipelines>, GpuError> {
    if settings.light != LightKind::Uniform {
        return Ok(None);
    }
    let compute =
        |kernel: fn(usize) -> Kernel| pipelines.compute(&Made::compute(kernel(settings.order)).kernel());
    let rows = match settings.health {
        true => kernels::counted_environment_rows,
        false => kernels::environment_rows,
    };
    Ok(Some(LightPipelines {
        rows: compute(rows)?,
        bands: compute(kernels::environment_bands)?,
        rotate: compute(kernels::rotate)?,
        matrix: settings.shadows().then(|| compute(kernels::product_matrix)).transpose()?,
    }))
}

/// A compute pipeline of a kernel by itself.
pub(crate) fn compute(context: &Context, kernel: &Kernel) -> Result<ComputePipeline, GpuError> {
    Made::compute(*kernel).kernel().compute_pipeline(context)
}
