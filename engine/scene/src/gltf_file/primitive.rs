//! Primitives: arrays read from checked accessors, made into triangle lists and mended.

use std::path::Path;

use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::{Mode, Semantic};

use super::accessor::{Use, check_use};
use super::document::Document;
use super::{label, name_of, repair};
use crate::error::{SceneError, at_most, invalid};
use crate::limits::{MAX_INDICES, MAX_VERTICES};
use crate::material::Material;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::warning::Warnings;

const FLOAT: &[DataType] = &[DataType::F32];
const FLOAT_OR_NORMALIZED: &[DataType] = &[DataType::F32, DataType::U8, DataType::U16];
const JOINT: &[DataType] = &[DataType::U8, DataType::U16];
const INDEX: &[DataType] = &[DataType::U8, DataType::U16, DataType::U32];

/// Reads every mesh; returns for each the meshes of the scene that its primitives became.
pub(super) fn read(
    document: &Document,
    scene: &mut Scene,
    warnings: &mut Warnings<'_>,
) -> Result<Vec<Vec<usize>>, SceneError> {
    let (mut vertices, mut indices) = (0, 0);
    let mut meshes = Vec::new();
    for mesh in document.gltf.meshes() {
        let mut primitives = Vec::new();
        for primitive in mesh.primitives() {
            let item =
                format!("{}, primitive {}", label("mesh", mesh.index(), mesh.name()), primitive.index());
            let Some(mut read) = read_one(document, &item, &primitive, warnings)? else { continue };
            vertices += read.positions.len() as u64;
            indices += read.indices.len() as u64;
            at_most(warnings.file, &item, vertices, MAX_VERTICES, "vertices of all meshes", "simplify")?;
            at_most(warnings.file, &item, indices, MAX_INDICES, "indices of all meshes", "simplify")?;
            read.name = name_of("mesh", mesh.index(), mesh.name());
            if mesh.primitives().len() > 1 {
                read.name.push_str(&format!("/{}", primitive.index()));
            }
            read.material = material(&primitive, document, scene);
            let normal_mapped = scene.materials[read.material].normal_texture.is_some();
            repair::mend(&item, &mut read, normal_mapped, warnings)?;
            read.hash = read.content_hash();
            primitives.push(scene.meshes.len());
            scene.meshes.push(read);
        }
        meshes.push(primitives);
    }
    Ok(meshes)
}

/// The primitive's material, or the default one, which is then added behind those of the file.
fn material(primitive: &gltf::Primitive<'_>, document: &Document, scene: &mut Scene) -> usize {
    let default = document.gltf.materials().len();
    let index = primitive.material().index().unwrap_or(default);
    if index == default && scene.materials.len() == default {
        scene.materials.push(Material::default());
    }
    index
}

fn read_one(
    document: &Document,
    item: &str,
    primitive: &gltf::Primitive<'_>,
    warnings: &mut Warnings<'_>,
) -> Result<Option<Mesh>, SceneError> {
    let file = warnings.file;
    if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
        warnings.add(item, format!("{:?} left out: only triangles are read", primitive.mode()));
        return Ok(None);
    }
    warn_of_unread(item, primitive, warnings);
    let reader = primitive.reader(|buffer| document.bytes(buffer));
    let uses = Attributes { file, item, primitive };
    let count = uses.check(Semantic::Positions, "POSITION", Dimensions::Vec3, FLOAT, None)?;
    let Some(count) = count else {
        return Err(invalid(file, item, "it has no positions", "export the mesh again"));
    };
    let vertices = Some(count);
    uses.check(Semantic::Normals, "NORMAL", Dimensions::Vec3, FLOAT, vertices)?;
    uses.check(Semantic::Tangents, "TANGENT", Dimensions::Vec4, FLOAT, vertices)?;
    uses.check(Semantic::TexCoords(0), "TEXCOORD_0", Dimensions::Vec2, FLOAT_OR_NORMALIZED, vertices)?;
    let joints = uses.check(Semantic::Joints(0), "JOINTS_0", Dimensions::Vec4, JOINT, vertices)?;
    let weights =
        uses.check(Semantic::Weights(0), "WEIGHTS_0", Dimensions::Vec4, FLOAT_OR_NORMALIZED, vertices)?;
    if joints.is_some() != weights.is_some() {
        return Err(invalid(file, item, "it has joints or weights but not both", "export the mesh again"));
    }
    if let Some(indices) = primitive.indices() {
        let wanted = Use { name: "indices", dimensions: Dimensions::Scalar, types: INDEX };
        check_use(file, item, &indices, &wanted, None)?;
    }
    at_most(file, item, count as u64, MAX_VERTICES, "vertices", "simplify the mesh")?;
    let sequence = match reader.read_indices() {
        Some(indices) => indices.into_u32().collect(),
        None => (0..count as u32).collect(),
    };
    Ok(Some(Mesh {
        positions: reader.read_positions().map(Iterator::collect).unwrap_or_default(),
        normals: reader.read_normals().map(Iterator::collect).unwrap_or_default(),
        tangents: reader.read_tangents().map(Iterator::collect).unwrap_or_default(),
        uv0: reader.read_tex_coords(0).map(|uv| uv.into_f32().collect()).unwrap_or_default(),
        joints: reader.read_joints(0).map(|joints| joints.into_u16().collect()).unwrap_or_default(),
        weights: reader.read_weights(0).map(|weights| weights.into_f32().collect()).unwrap_or_default(),
        indices: triangle_list(file, item, primitive.mode(), sequence)?,
        ..Mesh::default()
    }))
}

/// Checks of the attributes of one primitive.
struct Attributes<'a> {
    file: &'a Path,
    item: &'a str,
    primitive: &'a gltf::Primitive<'a>,
}

impl Attributes<'_> {
    /// Checks an attribute if it is there and returns its number of elements.
    fn check(
        &self,
        semantic: Semantic,
        name: &'static str,
        dimensions: Dimensions,
        types: &'static [DataType],
        count: Option<usize>,
    ) -> Result<Option<usize>, SceneError> {
        let Some(accessor) = self.primitive.get(&semantic) else { return Ok(None) };
        check_use(self.file, self.item, &accessor, &Use { name, dimensions, types }, count)?;
        Ok(Some(accessor.count()))
    }
}

/// Names attributes and targets that are not kept.
fn warn_of_unread(item: &str, primitive: &gltf::Primitive<'_>, warnings: &mut Warnings<'_>) {
    let targets = primitive.morph_targets().len();
    warnings.count(item, targets, "morph targets left out: they are not supported");
    for (semantic, _) in primitive.attributes() {
        let meaning = match semantic {
            Semantic::Colors(_) => "vertex colours are not supported",
            Semantic::TexCoords(set) if set > 0 => "only TEXCOORD_0 is kept",
            Semantic::Joints(set) | Semantic::Weights(set) if set > 0 => "four joints a vertex are kept",
            Semantic::Extras(_) => "application-specific attributes are not kept",
            _ => continue,
        };
        warnings.add(item, format!("{} left out: {meaning}", semantic.to_string()));
    }
}

/// Makes a list of triangles of lists, strips and fans, keeping the winding (glTF 2.0, 3.7.2.1).
fn triangle_list(file: &Path, item: &str, mode: Mode, sequence: Vec<u32>) -> Result<Vec<u32>, SceneError> {
    let wrong = |problem: String| Err(invalid(file, item, problem, "export the mesh again as triangles"));
    if sequence.len() < 3 {
        return wrong(format!("{} indices make no triangle", sequence.len()));
    }
    if matches!(mode, Mode::TriangleStrip | Mode::TriangleFan) {
        let listed = 3 * (sequence.len() as u64 - 2);
        at_most(file, item, listed, MAX_INDICES, "indices", "simplify the mesh")?;
    }
    match mode {
        Mode::TriangleStrip => Ok(sequence
            .windows(3)
            .enumerate()
            .flat_map(|(number, corners)| match number % 2 {
                0 => [corners[0], corners[1], corners[2]],
                _ => [corners[0], corners[2], corners[1]],
            })
            .collect()),
        Mode::TriangleFan => {
            Ok(sequence[1..].windows(2).flat_map(|edge| [edge[0], edge[1], sequence[0]]).collect())
        }
        _ if !sequence.len().is_multiple_of(3) => {
            wrong(format!("{} indices are not whole triangles", sequence.len()))
        }
        _ => Ok(sequence),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let list = |mode, count: u32| triangle_list(Path::new("a"), "mesh 0", mode, (0..count).collect());
        assert_eq!(list(Mode::TriangleStrip, 5).unwrap(), [0, 1, 2, 1, 3, 2, 2, 3, 4]);
        assert_eq!(list(Mode::TriangleFan, 4).unwrap(), [1, 2, 0, 2, 3, 0]);
        assert_eq!(list(Mode::Triangles, 3).unwrap(), [0, 1, 2]);
        assert!(list(Mode::Triangles, 4).is_err());
        assert!(list(Mode::TriangleFan, 2).is_err());
    }
}
