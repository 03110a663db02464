//! What is wrong with the values of a mesh: refused where its shape is at stake, mended with a warning elsewhere.

use std::path::Path;

use glam::{Vec3, Vec4};

use crate::error::{SceneError, invalid};
use crate::geometry::{count_degenerate, generate_normals, generate_tangents};
use crate::mesh::Mesh;
use crate::warning::Warnings;

/// Length of a normal or tangent, off 1, from which on it is worth a warning.
const UNIT_TOLERANCE: f32 = 1e-2;

/// Checks `mesh` and completes its normals, and its tangents if `normal_mapped`.
pub(super) fn mend(
    item: &str,
    mesh: &mut Mesh,
    normal_mapped: bool,
    warnings: &mut Warnings<'_>,
) -> Result<(), SceneError> {
    let file = warnings.file;
    check_indices(file, item, mesh)?;
    check_finite(file, item, "position", &mesh.positions)?;
    check_finite(file, item, "texture coordinate", &mesh.uv0)?;
    check_finite(file, item, "weight", &mesh.weights)?;
    let flat = count_degenerate(&mesh.positions, &mesh.indices);
    warnings.count(item, flat, "triangles have no area");
    mend_normals(item, mesh, warnings);
    mend_tangents(item, mesh, normal_mapped, warnings);
    mend_weights(item, mesh, warnings)
}

fn check_indices(file: &Path, item: &str, mesh: &Mesh) -> Result<(), SceneError> {
    let count = mesh.positions.len();
    match mesh.indices.iter().position(|index| *index as usize >= count) {
        Some(at) => {
            let problem = format!("index {at} is {}, but there are {count} vertices", mesh.indices[at]);
            Err(invalid(file, item, problem, "export the mesh again"))
        }
        None => Ok(()),
    }
}

fn check_finite<const N: usize>(
    file: &Path,
    item: &str,
    what: &str,
    values: &[[f32; N]],
) -> Result<(), SceneError> {
    let bad = |value: &[f32; N]| value.iter().any(|number| !number.is_finite());
    let Some(first) = values.iter().position(bad) else { return Ok(()) };
    let count = values.iter().filter(|value| bad(value)).count();
    let problem =
        format!("{count} {what}s are NaN or infinite, first of vertex {first}: {:?}", values[first]);
    Err(invalid(file, item, problem, "mend the mesh and export it again"))
}

/// Generates missing, zero and non-finite normals; brings the others to unit length.
fn mend_normals(item: &str, mesh: &mut Mesh, warnings: &mut Warnings<'_>) {
    if mesh.normals.is_empty() {
        mesh.normals = generate_normals(&mesh.positions, &mesh.indices);
        warnings.add(item, "normals generated, smooth over shared vertices: the file has none");
        return;
    }
    let mut unusable = Vec::new();
    let mut stretched = 0;
    for (vertex, normal) in mesh.normals.iter_mut().enumerate() {
        let length = Vec3::from(*normal).length();
        match Vec3::from(*normal).try_normalize() {
            Some(unit) => *normal = unit.into(),
            None => unusable.push(vertex),
        }
        stretched += usize::from(length.is_finite() && length > 0.0 && (length - 1.0).abs() > UNIT_TOLERANCE);
    }
    warnings.count(item, stretched, "normals were not of unit length; scaled");
    if !unusable.is_empty() {
        let generated = generate_normals(&mesh.positions, &mesh.indices);
        unusable.iter().for_each(|vertex| mesh.normals[*vertex] = generated[*vertex]);
        warnings.count(item, unusable.len(), "normals were zero, NaN or infinite; generated");
    }
}

/// Generates tangents where a normal texture needs them, and those of the file that are unusable.
fn mend_tangents(item: &str, mesh: &mut Mesh, normal_mapped: bool, warnings: &mut Warnings<'_>) {
    let generate = |mesh: &Mesh| {
        // Without texture coordinates every tangent is as good as another.
        let none = vec![[0.0; 2]; mesh.positions.len()];
        let uv = if mesh.uv0.is_empty() { &none } else { &mesh.uv0 };
        generate_tangents(&mesh.positions, &mesh.normals, uv, &mesh.indices)
    };
    if mesh.tangents.is_empty() {
        if normal_mapped && mesh.uv0.is_empty() {
            warnings.add(item, "the normal texture has no effect: the mesh has no texture coordinates");
        } else if normal_mapped {
            mesh.tangents = generate(mesh);
            warnings.add(item, "tangents generated from the texture coordinates: the file has none");
        }
        return;
    }
    let mut unusable = Vec::new();
    for (vertex, tangent) in mesh.tangents.iter_mut().enumerate() {
        match Vec4::from(*tangent).truncate().try_normalize() {
            Some(unit) if tangent[3].abs() == 1.0 => *tangent = unit.extend(tangent[3]).into(),
            _ => unusable.push(vertex),
        }
    }
    if !unusable.is_empty() {
        let generated = generate(mesh);
        unusable.iter().for_each(|vertex| mesh.tangents[*vertex] = generated[*vertex]);
        warnings.count(item, unusable.len(), "tangents were zero, not finite or without a sign; generated");
    }
}

/// Brings the weights of each vertex to a sum of 1.
fn mend_weights(item: &str, mesh: &mut Mesh, warnings: &mut Warnings<'_>) -> Result<(), SceneError> {
    let mut off = 0;
    for (vertex, weights) in mesh.weights.iter_mut().enumerate() {
        let sum: f32 = weights.iter().sum();
        if weights.iter().any(|weight| *weight < 0.0) || !sum.is_finite() {
            let problem = format!("vertex {vertex} has the weights {weights:?}");
            return Err(invalid(warnings.file, item, problem, "keep weights in [0, 1]"));
        }
        off += usize::from((sum - 1.0).abs() > UNIT_TOLERANCE);
        *weights = if sum > 0.0 { weights.map(|weight| weight / sum) } else { [1.0, 0.0, 0.0, 0.0] };
    }
    warnings.count(item, off, "vertices had weights that did not sum to 1; scaled");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Mesh {
        Mesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            uv0: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Mesh::default()
        }
    }

    fn mended(mut mesh: Mesh, normal_mapped: bool) -> Result<(Mesh, Vec<String>), SceneError> {
        let mut warnings = Warnings::new(Path::new("a.glb"));
        mend("mesh 0", &mut mesh, normal_mapped, &mut warnings)?;
        Ok((mesh, warnings.list.into_iter().map(|warning| warning.message).collect()))
    }

    #[test]
    fn what_is_missing_is_generated_and_said() {
        let (mesh, messages) = mended(square(), true).unwrap();
        assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 4]);
        assert_eq!(mesh.tangents, [[1.0, 0.0, 0.0, 1.0]; 4]);
        assert_eq!(messages.len(), 2, "{messages:?}");
        let (mesh, _) = mended(square(), false).unwrap();
        assert!(mesh.tangents.is_empty());
        let (mesh, messages) = mended(Mesh { uv0: vec![], ..square() }, true).unwrap();
        assert!(mesh.tangents.is_empty() && messages[1].contains("no effect"), "{messages:?}");
    }

    #[test]
    fn only_unusable_normals_are_replaced() {
        let tilted = [0.6, 0.0, 0.8];
        let normals = vec![tilted, [0.0; 3], [f32::NAN, 0.0, 1.0], [0.0, 0.0, 3.0]];
        let (mesh, messages) = mended(Mesh { normals, ..square() }, false).unwrap();
        let up = [0.0, 0.0, 1.0];
        assert!(Vec3::from(mesh.normals[0]).distance(tilted.into()) < 1e-6);
        assert_eq!(mesh.normals[1..], [up, up, up]);
        assert!(
            messages[0].starts_with("1 normals were not of unit") && messages[1].starts_with("2 normals")
        );
    }

    #[test]
    fn shapes_that_make_no_sense_are_refused() {
        let message = |mesh| mended(mesh, false).unwrap_err().to_string();
        let far = message(Mesh { indices: vec![0, 1, 4], ..square() });
        assert!(far.contains("index 2 is 4, but there are 4 vertices"), "{far}");
        let mut mesh = square();
        mesh.positions[2][1] = f32::INFINITY;
        let infinite = message(mesh);
        assert!(infinite.contains("1 positions are NaN or infinite, first of vertex 2"), "{infinite}");
        let weights = vec![[-0.5, 1.5, 0.0, 0.0]; 4];
        let negative = message(Mesh { weights, joints: vec![[0; 4]; 4], ..square() });
        assert!(negative.contains("keep weights in [0, 1]"), "{negative}");
    }

    #[test]
    fn flat_triangles_are_counted_and_weights_scaled() {
        let indices = vec![0, 1, 2, 0, 0, 1, 1, 1, 1];
        let weights = vec![[2.0, 2.0, 0.0, 0.0]; 4];
        let (mesh, messages) =
            mended(Mesh { indices, weights, joints: vec![[0; 4]; 4], ..square() }, false).unwrap();
        assert_eq!(mesh.weights[0], [0.5, 0.5, 0.0, 0.0]);
        assert!(messages[0].starts_with("2 triangles have no area"), "{messages:?}");
        assert!(messages[2].starts_with("4 vertices had weights"), "{messages:?}");
    }
}
