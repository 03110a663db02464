//! A frame as data: the resources it touches and the stages that use them. Both roads are made from it.

use std::fmt;

use airglow_gpu::{Buffer, ComputePipeline, GraphicsPipeline};
use airglow_graph::{Access, LeftOut, PassKind, ResourceDesc, State};

use crate::constants::{ChunkConstants, Pair};
use crate::control::{Once, Rotations};
use crate::frame::ResultRange;
use crate::resident::Upload;
use crate::shown::Shown;

/// What a stage uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Resource {
    /// The environment's image.
    Environment,
    /// Integrals of the basis over the columns of the environment.
    ColumnTable,
    /// Integrals of the basis over the rows of the environment.
    RowTable,
    /// Sums over the columns of each row.
    RowSums,
    /// The environment's coefficients in the frame of its map.
    MapCoefficients,
    /// The environment's coefficients; kept from frame to frame.
    EnvironmentLight,
    /// Counters of bad texels, see [`Relight::health`](crate::Relight::health).
    Health,
    /// SH RGB light of the host.
    UniformLight,
    /// The light in the frame of each instance.
    Lights,
    /// The sparse triple-product tensor.
    Tensor,
    /// The product matrix of each instance's light.
    Matrices,
    /// The baked vectors of a mesh, by the mesh's index.
    Vectors(u32),
    /// The light of each vertex of an instance, by its index in the frame.
    VertexLight(u32),
    /// The dynamic visibility of each vertex of an instance, by its index in the frame.
    Visibility(u32),
    /// The normals of an instance's vertices, by its index in the frame.
    Normals(u32),
    /// The packed rectangle of the fragment method.
    Rectangle,
    /// The results of all instances.
    Results,
}

impl fmt::Display for Resource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Environment => f.write_str("relight environment"),
            Self::ColumnTable => f.write_str("relight column table"),
            Self::RowTable => f.write_str("relight row table"),
            Self::RowSums => f.write_str("relight row sums"),
            Self::MapCoefficients => f.write_str("relight map coefficients"),
            Self::EnvironmentLight => f.write_str("relight environment light"),
            Self::Health => f.write_str("relight health"),
            Self::UniformLight => f.write_str("relight uniform light"),
            Self::Lights => f.write_str("relight lights"),
            Self::Tensor => f.write_str("relight tensor"),
            Self::Matrices => f.write_str("relight product matrices"),
            Self::Vectors(mesh) => write!(f, "relight vectors of mesh {mesh}"),
            Self::VertexLight(instance) => write!(f, "relight vertex light of instance {instance}"),
            Self::Visibility(instance) => write!(f, "relight visibility of instance {instance}"),
            Self::Normals(instance) => write!(f, "relight normals of instance {instance}"),
            Self::Rectangle => f.write_str("relight rectangle"),
            Self::Results => f.write_str("relight results"),
        }
    }
}

/// One use of one resource by a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// Which resource.
    pub resource: Resource,
    /// How; a write replaces all contents.
    pub access: Access,
}

/// Where a resource of a frame comes from.
#[derive(Clone)]
pub enum Need {
    /// This room keeps it: the buffer, and the state it is in before the frame and is to be in after it.
    Ours {
        /// The buffer.
        buffer: Buffer,
        /// Before the frame.
        entry: State,
        /// After the frame.
        exit: State,
    },
    /// The host gave it with the frame.
    Host,
    /// It lives within the frame: the graph makes it, or a host without a graph.
    Scratch(ResourceDesc),
}

/// One step: what it uses, and what it records. Barriers stand between stages, never within.
#[derive(Clone)]
pub struct Stage {
    /// Name, as the plan shows it.
    pub name: &'static str,
    /// What it records.
    pub kind: PassKind,
    /// What it uses, each resource once.
    pub uses: Vec<Use>,
    /// For each use, how the resource was used before it within the frame; `None` for the first.
    pub(crate) before: Vec<Option<Access>>,
    pub(crate) work: Work,
    pub(crate) once: Option<Once>,
    /// What of the frame is shown; none where that is all one.
    pub(crate) shown: Option<Shown>,
}

/// A frame as data, made by [`Relight::prepare`](crate::Relight::prepare).
#[derive(Clone)]
pub struct Prepared {
    /// The stages in order.
    pub stages: Vec<Stage>,
    /// Every resource the stages use, each once, sorted.
    pub needs: Vec<(Resource, Need)>,
    /// What this frame does without.
    pub left_out: Vec<LeftOut>,
    /// Where the results of each instance lie; empty when the pass was left out.
    pub ranges: Vec<ResultRange>,
    /// The rotations, to be changed before the frame is recorded again; none for light of each vertex.
    pub rotations: Option<Rotations>,
    /// Shows and hides light, instances and their dynamic visibility before the frame is recorded again.
    pub shown: Shown,
}

/// A binding of a kernel to part of a resource.
#[derive(Clone, Copy)]
pub(crate) struct Bound {
    pub binding: u32,
    pub uniform: bool,
    pub resource: Resource,
    pub offset: u64,
    pub size: u64,
}

/// A kernel over the vertices of a chunk.
#[derive(Clone)]
pub(crate) struct ChunkWork<P> {
    /// Whose vertices they are, by index in the frame.
    pub instance: u32,
    /// Whether it applies dynamic visibility; an instance that has some has a kernel for frames in which it does nothing.
    pub shadowed: bool,
    pub pipeline: P,
    pub bound: Vec<Bound>,
    pub constants: ChunkConstants,
    /// Workgroups of a dispatch; a draw does not read them.
    pub groups: u32,
}

impl ChunkWork<()> {
    /// The same by a pipeline.
    pub(crate) fn by<P>(self, pipeline: P) -> ChunkWork<P> {
        let Self { instance, shadowed, pipeline: (), bound, constants, groups } = self;
        ChunkWork { instance, shadowed, pipeline, bound, constants, groups }
    }
}

/// What a stage records.
#[derive(Clone)]
pub(crate) enum Work {
    Uploads(Vec<Upload>),
    Rows {
        pipeline: ComputePipeline,
        size: Pair,
        counted: bool,
    },
    Bands {
        pipeline: ComputePipeline,
        size: Pair,
        coefficients: u32,
    },
    Rotate {
        pipeline: ComputePipeline,
        source: Resource,
        target: Resource,
        rotations: Rotations,
        strides: Pair,
    },
    Matrices {
        pipeline: ComputePipeline,
        elements: u32,
        instances: u32,
        strides: Pair,
    },
    Vertices(Vec<ChunkWork<ComputePipeline>>, Shown),
    Rectangle(Vec<ChunkWork<GraphicsPipeline>>, Shown),
    Copy {
        size: u64,
    },
}
