//! What a host says each frame, and what it gets back.
//!
//! The types are generic over how buffers and images are named: graph handles on the graph's road
//! ([`Relight::add`](crate::Relight::add)), slices and views on the road without a graph
//! ([`Relight::prepare`](crate::Relight::prepare)).

use glam::DQuat;

use crate::control::Rotations;
use crate::mesh::MeshId;
use crate::rotation::Orientation;
use crate::shown::Shown;

/// An equirectangular environment: linear Rec. 709 radiance, W/sr/m2, constant on each texel, the centre looking
/// forward, u growing to the right, v down, whatever the axes of the host's world.
#[derive(Clone, Copy, Debug)]
pub struct Environment<I> {
    /// The image; only the first mip is read, texel by texel, without a sampler. Any float format; at most 1e6 and not
    /// negative ([`check_environment`](crate::check_environment)); a component that is not finite counts as 0.
    pub image: I,
    /// Texels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// A number that the host changes with the image's contents; the projection runs only when it does.
    pub revision: u64,
    /// Turns the environment in the host's world, about its axes; any length but zero.
    pub rotation: DQuat,
}

/// The light of a frame.
#[derive(Clone, Copy, Debug)]
pub enum Light<B, I> {
    /// There is none: the pass is left out.
    None,
    /// An environment, projected and rotated into the frame of each instance. For [`LightKind::Uniform`](crate::LightKind).
    Environment(Environment<I>),
    /// SH RGB about the axes of the host's world, `vec4[order^2]` with w unused, rotated like an environment. For
    /// [`LightKind::Uniform`](crate::LightKind).
    Uniform {
        /// The coefficients, W/sr/m2.
        coefficients: B,
        /// Turns the light in the host's world; any length but zero.
        rotation: DQuat,
    },
    /// Each instance brings the light of its vertices, in object space and multiplied with the pre-exposure. For [`LightKind::Vertex`](crate::LightKind).
    Vertices,
}

/// One appearance of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Instance<B> {
    /// The mesh.
    pub mesh: MeshId,
    /// From object space to the host's world, see [`instance_rotation`](crate::instance_rotation).
    pub orientation: Orientation,
    /// With [`Light::Vertices`]: SH RGB of each vertex in object space, `[[f32; 3]; order^2]` a vertex.
    pub light: Option<B>,
    /// Dynamic visibility of each vertex in object space, `[f32; order^2]` a vertex: the SH projection of a function
    /// that is 1 where the vertex sees the light and 0 where something moving blocks it.
    pub visibility: Option<B>,
    /// The current normal of each vertex in object space, of a mesh without vectors: `[f32; 3]` a vertex, of any
    /// length, tightly packed, as glTF and the vertex format `R32G32B32_SFLOAT` have them, so that the output of a
    /// skinning pass serves as a vertex buffer and as this. The vertex gets the transfer of an unshadowed surface; one
    /// with a zero normal stays black. For [`Settings::normals`](crate::Settings::normals).
    pub normals: Option<B>,
}

impl<B> Instance<B> {
    /// An instance in the orientation of its object space and without inputs of its own.
    #[must_use]
    pub fn new(mesh: MeshId) -> Self {
        Self { mesh, orientation: Orientation::IDENTITY, light: None, visibility: None, normals: None }
    }

    /// Whether it brings dynamic visibility.
    pub(crate) fn is_shadowed(&self) -> bool {
        self.visibility.is_some()
    }
}

/// A frame: light, and what it falls on.
#[derive(Clone, Debug)]
pub struct Frame<B, I> {
    /// The light.
    pub light: Light<B, I>,
    /// The instances; their results lie in this order in one buffer.
    pub instances: Vec<Instance<B>>,
    /// The host's own buffer for the results, or `None` for one made for the frame.
    pub target: Option<B>,
}

/// Where the results of an instance lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResultRange {
    /// First byte in the buffer of results: the offset of its vertex buffer.
    pub offset: u64,
    /// Bytes: vertices times [`Settings::output_bytes`](crate::Settings::output_bytes).
    pub size: u64,
    /// Vertices.
    pub vertices: u32,
}

/// What the pass hands on. Everything is `None` or empty when it was left out.
#[derive(Clone, Debug)]
pub struct Relit<B> {
    /// The results of all instances: colours to be read at vertex input, or incident radiance to be read as storage.
    pub results: Option<B>,
    /// Where those of each instance lie.
    pub ranges: Vec<ResultRange>,
    /// The environment's coefficients as it comes in, neither turned nor multiplied with the pre-exposure, about
    /// airglow's axes: `vec4[order^2]`, for the vertex, fragment and compute shaders of other passes.
    pub environment: Option<B>,
    /// Turns light and instances before the plan is recorded again; none for light of each vertex.
    pub rotations: Option<Rotations>,
    /// Shows and hides instances before the plan is recorded again.
    pub shown: Shown,
}
