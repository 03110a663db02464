//! The kernels of this room: their SPIR-V, and every binding stated once.
//!
//! A test reflects each module and compares it with what stands here.

mod modules;
mod source;

use airglow_gpu::{BindingDesc, BindingKind};
use airglow_graph::Access;

use modules::{
    ByOrder, COLOUR, ENVIRONMENT_BANDS, ENVIRONMENT_ROWS, ENVIRONMENT_ROWS_HEALTH, INCIDENT_BAKED,
    INCIDENT_BOTH, INCIDENT_DYNAMIC, INCIDENT_OPEN, PRODUCT, PRODUCT_MATRIX, RECTANGLE, ROTATE,
};

use crate::rotation::RotateConstants;
use crate::settings::{LightKind, Output, Settings, Storage};

pub(crate) use modules::RECTANGLE_VERTEX;
pub(crate) use source::Source;

/// Invocations of a workgroup of the kernels that run over vertices; README.md has the measurement.
pub const WORKGROUP: u32 = 64;

/// One binding of descriptor set 0 and how the kernel uses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    /// `layout(binding = …)`.
    pub binding: u32,
    /// What it holds.
    pub kind: BindingKind,
    /// How the kernel uses it.
    pub access: Access,
}

/// A kernel: a module and its interface.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    /// Name of the pipeline, shown by captures.
    pub name: &'static str,
    /// SPIR-V 1.3, little-endian words as bytes.
    pub spirv: &'static [u8],
    /// Its bindings.
    pub bindings: &'static [Binding],
    /// Bytes of its push constants.
    pub push_constant_size: u32,
}

impl Kernel {
    /// The bindings as a pipeline takes them.
    #[must_use]
    pub fn binding_descs(&self) -> Vec<BindingDesc> {
        self.bindings.iter().map(|binding| BindingDesc::new(binding.binding, binding.kind)).collect()
    }
}

const fn storage(binding: u32, access: Access) -> Binding {
    Binding { binding, kind: BindingKind::StorageBuffer, access }
}
const fn read(binding: u32) -> Binding {
    storage(binding, Access::ComputeStorageRead)
}
const fn write(binding: u32) -> Binding {
    storage(binding, Access::ComputeStorageWrite)
}
const fn uniform(binding: u32) -> Binding {
    Binding { binding, kind: BindingKind::UniformBuffer, access: Access::ComputeUniform }
}
const fn fragment_read(binding: u32) -> Binding {
    storage(binding, Access::FragmentStorageRead)
}
const fn fragment_uniform(binding: u32) -> Binding {
    Binding { binding, kind: BindingKind::UniformBuffer, access: Access::FragmentUniform }
}
const fn sampled(binding: u32) -> Binding {
    Binding { binding, kind: BindingKind::SampledImage, access: Access::ComputeSampled }
}

/// Bytes of the push constants `vertex_count`, `stride`, `first_row` of the kernels over vertices.
const CHUNK: u32 = 12;

/// Sums over the columns of each row: environment, column table, row sums.
#[must_use]
pub(crate) fn environment_rows(order: usize) -> Kernel {
    Kernel {
        name: "relight environment rows",
        spirv: ENVIRONMENT_ROWS[order - 1],
        bindings: const { &[sampled(0), read(1), write(2)] },
        push_constant_size: 8,
    }
}

/// The same, counting bad texels: environment, column table, row sums, counters.
#[must_use]
pub(crate) fn counted_environment_rows(order: usize) -> Kernel {
    Kernel {
        spirv: ENVIRONMENT_ROWS_HEALTH[order - 1],
        bindings: const { &[sampled(0), read(1), write(2), storage(3, Access::ComputeStorageReadWrite)] },
        ..environment_rows(order)
    }
}

/// Sums over the rows: row table, row sums, map-frame coefficients.
#[must_use]
pub(crate) fn environment_bands(order: usize) -> Kernel {
    Kernel {
        name: "relight environment bands",
        spirv: ENVIRONMENT_BANDS[order - 1],
        bindings: const { &[read(0), read(1), write(2)] },
        push_constant_size: 8,
    }
}

/// Rotations: source vectors, quaternions, rotated vectors.
#[must_use]
pub(crate) fn rotate(order: usize) -> Kernel {
    Kernel {
        name: "relight rotate",
        spirv: ROTATE[order - 1],
        bindings: const { &[read(0), read(1), write(2)] },
        push_constant_size: size_of::<RotateConstants>() as u32,
    }
}

/// Products of pairs: tensor, left, right, product.
#[must_use]
pub(crate) fn product(order: usize) -> Kernel {
    Kernel {
        name: "relight product",
        spirv: PRODUCT[order - 1],
        bindings: const { &[read(0), read(1), read(2), write(3)] },
        push_constant_size: 0,
    }
}

/// Product matrices of lights: tensor, lights, matrices.
#[must_use]
pub(crate) fn product_matrix(order: usize) -> Kernel {
    Kernel {
        name: "relight product matrix",
        spirv: PRODUCT_MATRIX[order - 1],
        bindings: const { &[read(0), read(1), write(2)] },
        push_constant_size: 8,
    }
}

/// The kernel that writes colours or incident radiance for a chunk of vertices.
#[must_use]
pub(crate) fn vertices(settings: &Settings, source: Source) -> Kernel {
    let (name, modules) = match settings.output {
        Output::Colour => ("relight colour", colour_modules(&COLOUR, settings, source)),
        Output::Incident => ("relight incident", incident_modules(settings, source)),
    };
    Kernel {
        name,
        spirv: modules[settings.order - 1],
        bindings: vertex_bindings(settings, source),
        push_constant_size: CHUNK,
    }
}

/// Vertices of one workgroup of that kernel. Where one light is for all, an invocation makes two colours: loading
/// each coefficient of the light once for both is what makes it as fast as its bytes can be moved.
#[must_use]
pub(crate) fn vertices_per_workgroup(settings: &Settings, source: Source) -> u32 {
    let one_light = settings.light == LightKind::Uniform && settings.output == Output::Colour;
    if one_light && source == Source::Baked { 2 * WORKGROUP } else { WORKGROUP }
}

/// The fragment kernel of the packed rectangle; its vertex stage is [`rectangle_vertex`].
#[must_use]
pub(crate) fn rectangle(settings: &Settings, source: Source) -> Kernel {
    Kernel {
        name: "relight rectangle",
        spirv: colour_modules(&RECTANGLE, settings, source)[settings.order - 1],
        bindings: match (source, settings.light) {
            (Source::Baked | Source::Normals, LightKind::Uniform) => {
                const { &[fragment_read(0), fragment_uniform(1)] }
            }
            (Source::Baked | Source::Normals, LightKind::Vertex) => {
                const { &[fragment_read(0), fragment_read(1)] }
            }
            (_, LightKind::Uniform) => const { &[fragment_read(0), fragment_read(3), fragment_uniform(4)] },
            (_, LightKind::Vertex) => {
                const { &[fragment_read(0), fragment_read(1), fragment_read(3), fragment_read(4)] }
            }
        },
        push_constant_size: CHUNK,
    }
}

fn storage_index(settings: &Settings) -> usize {
    usize::from(settings.storage == Storage::F16)
}

/// Where the kernel has its transfer from: f32, f16 or normals.
fn transfer_index(settings: &Settings, source: Source) -> usize {
    if source.has_normals() { 2 } else { storage_index(settings) }
}

fn light_index(settings: &Settings) -> usize {
    usize::from(settings.light == LightKind::Vertex)
}

fn colour_modules(
    family: &'static [[[ByOrder; 3]; 2]; 2],
    settings: &Settings,
    source: Source,
) -> &'static ByOrder {
    &family[usize::from(source.is_shadowed())][light_index(settings)][transfer_index(settings, source)]
}

fn incident_modules(settings: &Settings, source: Source) -> &'static ByOrder {
    let light = light_index(settings);
    match source {
        Source::Dynamic => &INCIDENT_DYNAMIC[light],
        Source::Both => &INCIDENT_BOTH[light][storage_index(settings)],
        Source::Open => &INCIDENT_OPEN[light],
        // No settings allow normals here.
        Source::Baked | Source::Normals | Source::ShadowedNormals => {
            &INCIDENT_BAKED[light][storage_index(settings)]
        }
    }
}

/// Transfer or normals 0, light 1, result 2, visibility 3, product matrix 4, tensor 4 (colour) or 5 (incident).
fn vertex_bindings(settings: &Settings, source: Source) -> &'static [Binding] {
    match (settings.output, source, settings.light) {
        (_, Source::Open, LightKind::Uniform) => const { &[uniform(1), write(2)] },
        (_, Source::Open, LightKind::Vertex) => const { &[read(1), write(2)] },
        (Output::Colour, Source::Baked | Source::Normals, LightKind::Uniform) => {
            const { &[read(0), uniform(1), write(2)] }
        }
        (Output::Colour, Source::Baked | Source::Normals, LightKind::Vertex) => {
            const { &[read(0), read(1), write(2)] }
        }
        (Output::Colour, _, LightKind::Uniform) => const { &[read(0), write(2), read(3), uniform(4)] },
        (Output::Colour, _, LightKind::Vertex) => const { &[read(0), read(1), write(2), read(3), read(4)] },
        (Output::Incident, Source::Dynamic, LightKind::Uniform) => const { &[write(2), read(3), uniform(4)] },
        (Output::Incident, Source::Dynamic, LightKind::Vertex) => {
            const { &[read(1), write(2), read(3), read(5)] }
        }
        (Output::Incident, Source::Both, LightKind::Uniform) => {
            const { &[read(0), write(2), read(3), uniform(4), read(5)] }
        }
        (Output::Incident, Source::Both, LightKind::Vertex) => {
            const { &[read(0), read(1), write(2), read(3), read(5)] }
        }
        (Output::Incident, _, LightKind::Uniform) => const { &[read(0), write(2), uniform(4)] },
        (Output::Incident, _, LightKind::Vertex) => const { &[read(0), read(1), write(2), read(5)] },
    }
}

/// Every kernel once, for tests that reflect them: compute and fragment.
#[must_use]
pub fn all() -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for order in 1..=crate::order::MAX_ORDER {
        let rows = [environment_rows, counted_environment_rows];
        kernels.extend(rows.map(|kernel| kernel(order)));
        kernels.extend([environment_bands, rotate, product, product_matrix].map(|kernel| kernel(order)));
        for storage in [Storage::F32, Storage::F16] {
            for light in [LightKind::Uniform, LightKind::Vertex] {
                let settings = Settings { order, storage, light, ..Settings::default() };
                let incident = Settings { output: Output::Incident, ..settings };
                for source in [Source::Baked, Source::Both] {
                    kernels.push(vertices(&settings, source));
                    kernels.push(rectangle(&settings, source));
                    kernels.push(vertices(&incident, source));
                }
            }
        }
        for light in [LightKind::Uniform, LightKind::Vertex] {
            let settings = Settings { order, light, ..Settings::default() };
            let incident = Settings { output: Output::Incident, ..settings };
            for source in [Source::Normals, Source::ShadowedNormals] {
                kernels.push(vertices(&settings, source));
                kernels.push(rectangle(&settings, source));
            }
            kernels.extend([Source::Dynamic, Source::Open].map(|source| vertices(&incident, source)));
        }
    }
    kernels
}
