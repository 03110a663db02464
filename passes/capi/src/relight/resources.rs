//! The resources of a frame, by number.

use airglow_relight::Resource;

/// What a step of the pass uses. With `AIRGLOW_RESOURCE_VECTORS` the index is a mesh's place in the pass, with
/// `..._VERTEX_LIGHT`, `..._VISIBILITY` and `..._NORMALS` an instance's in the frame; otherwise it is 0.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowResource {
    /// The environment's image.
    Environment = 0,
    /// Integrals of the basis over the columns of the environment.
    ColumnTable = 1,
    /// Integrals of the basis over the rows of the environment.
    RowTable = 2,
    /// Sums over the columns of each row.
    RowSums = 3,
    /// The environment's coefficients in the frame of its map.
    MapCoefficients = 4,
    /// The environment's coefficients; kept from frame to frame.
    EnvironmentLight = 5,
    /// SH RGB light of the host.
    UniformLight = 6,
    /// The light in the space of each instance.
    Lights = 7,
    /// The sparse triple-product tensor.
    Tensor = 8,
    /// The product matrix of each instance's light.
    Matrices = 9,
    /// The baked vectors of a mesh.
    Vectors = 10,
    /// The light of each vertex of an instance: `3 * order^2` floats a vertex.
    VertexLight = 11,
    /// The dynamic visibility of each vertex of an instance: `order^2` floats a vertex.
    Visibility = 12,
    /// The normals of an instance's vertices: 3 floats a vertex.
    Normals = 13,
    /// The packed rectangle of the fragment method.
    Rectangle = 14,
    /// The results of all instances.
    Results = 15,
    /// Counters of bad texels.
    Health = 16,
}

/// The number and the index of a resource.
pub(super) fn number(resource: Resource) -> (AirglowResource, u32) {
    use AirglowResource as R;
    match resource {
        Resource::Environment => (R::Environment, 0),
        Resource::ColumnTable => (R::ColumnTable, 0),
        Resource::RowTable => (R::RowTable, 0),
        Resource::RowSums => (R::RowSums, 0),
        Resource::MapCoefficients => (R::MapCoefficients, 0),
        Resource::EnvironmentLight => (R::EnvironmentLight, 0),
        Resource::Health => (R::Health, 0),
        Resource::UniformLight => (R::UniformLight, 0),
        Resource::Lights => (R::Lights, 0),
        Resource::Tensor => (R::Tensor, 0),
        Resource::Matrices => (R::Matrices, 0),
        Resource::Vectors(mesh) => (R::Vectors, mesh),
        Resource::VertexLight(instance) => (R::VertexLight, instance),
        Resource::Visibility(instance) => (R::Visibility, instance),
        Resource::Normals(instance) => (R::Normals, instance),
        Resource::Rectangle => (R::Rectangle, 0),
        Resource::Results => (R::Results, 0),
    }
}
