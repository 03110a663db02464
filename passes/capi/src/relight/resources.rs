//! The resources of a frame, by number.

use airglow_relight::{Need, Prepared, Resource};

use crate::access::{self, AirglowOrigin, Number, Step, Uses, What};

/// What a step of the pass uses. With `AIRGLOW_RELIGHT_RESOURCE_VECTORS` the index is a mesh's place in the pass, with
/// `..._VERTEX_LIGHT`, `..._VISIBILITY` and `..._NORMALS` an instance's in the frame; otherwise it is 0.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowRelightResource {
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
pub(super) fn number(resource: Resource) -> Number {
    use AirglowRelightResource as R;
    let (kind, index) = match resource {
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
    };
    (kind as u32, index)
}

/// What a frame uses. `texels`: its environment is the library's own.
pub(super) fn uses(prepared: &Prepared, coefficients: u64, texels: bool) -> Uses {
    let resource = |(resource, need): &(Resource, Need)| {
        let what = match (resource, need) {
            (Resource::Environment, _) if texels => What::Image(AirglowOrigin::Library),
            (Resource::Environment, _) => What::Image(AirglowOrigin::Host),
            (_, Need::Ours { buffer, .. }) => What::Buffer(AirglowOrigin::Library, buffer.size()),
            (_, Need::Host) => {
                What::Buffer(AirglowOrigin::Host, host_bytes(prepared, coefficients, *resource))
            }
            (_, Need::Scratch(desc)) => What::Scratch(*desc),
        };
        access::Resource { number: number(*resource), name: resource.to_string(), what }
    };
    let resources = prepared.needs.iter().map(resource).collect();
    let steps = prepared.stages.iter().map(|stage| {
        let uses = stage.uses.iter().map(|used| (number(used.resource), used.access)).collect();
        Step { name: stage.name, uses }
    });
    Uses::new(resources, &steps.collect::<Vec<_>>())
}

/// Bytes that a buffer of the host's must have.
pub(super) fn host_bytes(prepared: &Prepared, coefficients: u64, resource: Resource) -> u64 {
    let vertices =
        |instance: u32| prepared.ranges.get(instance as usize).map_or(0, |range| u64::from(range.vertices));
    match resource {
        Resource::Results => prepared.ranges.last().map_or(0, |range| range.offset + range.size),
        Resource::UniformLight => 16 * coefficients,
        Resource::VertexLight(instance) => 12 * coefficients * vertices(instance),
        Resource::Visibility(instance) => 4 * coefficients * vertices(instance),
        Resource::Normals(instance) => 12 * vertices(instance),
        _ => 0,
    }
}
