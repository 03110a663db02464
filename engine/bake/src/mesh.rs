//! The host's arrays: the mesh that receives light and the triangles that block it.

use glam::{DMat3, DMat4, DVec3, Mat4};

use crate::BakeError;

/// The mesh whose vertices are baked, in the host's vertex order and object space.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    /// Name used in errors.
    pub name: &'a str,
    /// Vertex positions, metres.
    pub positions: &'a [[f32; 3]],
    /// Outward normals, one per position, any length; a zero normal gives a zero transfer vector and is counted.
    pub normals: &'a [[f32; 3]],
    /// Three per triangle. They only tell a vertex its surroundings, so that its rays start beside its own
    /// triangles; vertices that no triangle uses are baked like the others.
    pub indices: &'a [u32],
}

/// Triangles that block light, from both sides.
#[derive(Clone, Copy)]
pub struct Occluder<'a> {
    /// Name used in errors.
    pub name: &'a str,
    /// Vertex positions, metres.
    pub positions: &'a [[f32; 3]],
    /// Three per triangle.
    pub indices: &'a [u32],
    /// From the positions' space to the space baked in: the identity when a mesh shadows itself in object
    /// space, the instance's world matrix when the scene shadows an instance.
    pub transform: Mat4,
    /// Holes of a material with masked alpha; `None` blocks everywhere.
    pub mask: Option<Mask<'a>>,
}

/// Where a triangle with masked alpha is solid.
#[derive(Clone, Copy)]
pub struct Mask<'a> {
    /// Names the content of the mask (a hash of texture and cutoff), for the cache key.
    pub key: &'a [u8],
    /// Called with the triangle's number in its occluder and the barycentric weights of its second and third
    /// vertex; returns whether light is blocked there. Must be a pure function.
    pub solid: &'a (dyn Fn(usize, [f32; 2]) -> bool + Sync),
}

impl std::fmt::Debug for Occluder<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .debug_struct("Occluder")
            .field("name", &self.name)
            .field("vertices", &self.positions.len())
            .field("triangles", &(self.indices.len() / 3))
            .field("transform", &self.transform)
            .field("masked", &self.mask.is_some())
            .finish()
    }
}

impl<'a> Mesh<'a> {
    /// The mesh as an occluder of itself, in its own object space.
    #[must_use]
    pub fn occluder(&self) -> Occluder<'a> {
        self.occluder_at(Mat4::IDENTITY)
    }

    /// The mesh as an occluder under an instance's matrix.
    #[must_use]
    pub fn occluder_at(&self, transform: Mat4) -> Occluder<'a> {
        Occluder { name: self.name, positions: self.positions, indices: self.indices, transform, mask: None }
    }

    /// Checks lengths, indices and finiteness.
    ///
    /// # Errors
    /// Names the first fault found.
    pub fn check(&self) -> Result<(), BakeError> {
        if self.normals.len() != self.positions.len() {
            return Err(BakeError::NormalCount {
                mesh: self.name.to_owned(),
                positions: self.positions.len(),
                normals: self.normals.len(),
            });
        }
        check_triangles(self.name, self.positions, self.indices)?;
        check_finite(self.name, "normal", self.normals)
    }
}

/// Checks a triangle list: whole triangles, indices in range, finite positions.
pub(crate) fn check_triangles(name: &str, positions: &[[f32; 3]], indices: &[u32]) -> Result<(), BakeError> {
    if !indices.len().is_multiple_of(3) {
        return Err(BakeError::IndexCount { mesh: name.to_owned(), count: indices.len() });
    }
    if let Some(place) = indices.iter().position(|&index| index as usize >= positions.len()) {
        return Err(BakeError::IndexOutOfRange {
            mesh: name.to_owned(),
            place,
            value: indices[place],
            vertices: positions.len(),
        });
    }
    check_finite(name, "position", positions)
}

fn check_finite(name: &str, what: &'static str, vectors: &[[f32; 3]]) -> Result<(), BakeError> {
    match vectors.iter().position(|vector| vector.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(BakeError::NotFinite { mesh: name.to_owned(), what, vertex }),
        None => Ok(()),
    }
}

/// An instance's matrix in f64, checked, with the matrix that carries its normals.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    matrix: DMat4,
    normal: DMat3,
}

impl Placement {
    /// Checks the matrix: finite, affine, invertible.
    pub(crate) fn new(name: &str, transform: Mat4) -> Result<Self, BakeError> {
        let refuse = |why| BakeError::Transform { mesh: name.to_owned(), why };
        let matrix = transform.as_dmat4();
        if !matrix.is_finite() {
            return Err(refuse("is not finite"));
        }
        if matrix.row(3) != glam::DVec4::W {
            return Err(refuse("is not affine"));
        }
        let linear = DMat3::from_mat4(matrix);
        let normal = linear.inverse().transpose();
        if linear.determinant() == 0.0 || !normal.is_finite() {
            return Err(refuse("has no inverse"));
        }
        Ok(Self { matrix, normal })
    }

    /// A position in the space baked in, rounded to f32: the same bits for the receiver and for the occluder
    /// it is.
    pub(crate) fn position(&self, position: [f32; 3]) -> [f32; 3] {
        let position = DVec3::from(position.map(f64::from));
        self.matrix.transform_point3(position).as_vec3().to_array()
    }

    /// A normal in the space baked in, not normalised, by the inverse transpose: mirrored instances keep
    /// normals that point outward.
    pub(crate) fn normal(&self, normal: [f32; 3]) -> DVec3 {
        self.normal * DVec3::from(normal.map(f64::from))
    }
}
