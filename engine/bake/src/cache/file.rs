//! The cache file: safetensors with one metadata entry, checked from the outside in.

use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use half::f16;
use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde::{Deserialize, Serialize};

use super::CacheKey;
use crate::Transfer;
use crate::settings::MAX_ORDER;

/// Version of the layout and of the meaning of the numbers in it. It rises whenever a bake of the same input
/// would come out differently.
pub const SCHEMA: u32 = 1;
/// Name of the metadata entry.
const ENTRY: &str = "airglow.bake";
/// Names of the tensors.
const TRANSFER: &str = "transfer";
const VISIBILITY: &str = "visibility";

/// How coefficients are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Precision {
    /// 32 bits: exactly what was baked.
    F32,
    /// 16 bits, relative error 2⁻¹¹: half the bytes.
    F16,
}

/// Why a file could not be used. None of these is an error: the bake is made again.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Miss {
    /// There is no such file.
    #[error("no cache file yet")]
    Absent,
    /// The file cannot be read.
    #[error("the cache file cannot be read: {0}")]
    Unreadable(#[source] std::io::Error),
    /// Not a safetensors file, cut short, or damaged.
    #[error("the cache file is damaged: {0}")]
    Damaged(String),
    /// A sound safetensors file that is no bake.
    #[error("the file is not a bake cache of airglow")]
    Foreign,
    /// Written by another version.
    #[error("the cache file has schema {found}, this version writes {SCHEMA}")]
    OtherSchema {
        /// Its schema.
        found: u32,
    },
    /// Another mesh, other occluders or other settings.
    #[error("the cache file belongs to another mesh, other occluders or other settings")]
    OtherInput,
    /// Stored in the other precision.
    #[error("the cache file is stored in the other precision")]
    OtherPrecision,
}

/// Why a file could not be written. The previous file, if any, is as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CacheError {
    /// The system refused.
    #[error("cannot write the bake cache {path}: {source}; check that its folder exists and has room")]
    Write {
        /// The target.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The transfer's arrays do not have the shape it states.
    #[error("the transfer has {found} coefficients where order² · vertices = {expected}")]
    Shape {
        /// Values present.
        found: usize,
        /// Values stated.
        expected: usize,
    },
    /// The container library refused.
    #[error("cannot encode the bake cache: {0}")]
    Encode(String),
}

/// The metadata entry, as JSON.
#[derive(Serialize, Deserialize)]
struct Description {
    schema: u32,
    key: String,
    order: usize,
    vertices: usize,
    /// BLAKE3 of the tensors' bytes, transfer first.
    data: String,
}

impl Precision {
    /// Rounds vectors to what a file of this precision holds.
    pub fn round(self, transfer: &mut Transfer) {
        if self == Self::F16 {
            let vectors = transfer.coefficients.iter_mut().chain(transfer.visibility.iter_mut().flatten());
            vectors.for_each(|value| *value = f16::from_f32(*value).to_f32());
        }
    }

    fn dtype(self) -> Dtype {
        match self {
            Self::F32 => Dtype::F32,
            Self::F16 => Dtype::F16,
        }
    }

    /// Little-endian bytes.
    fn encode(self, values: &[f32]) -> Vec<u8> {
        match self {
            Self::F32 => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
            Self::F16 => values.iter().flat_map(|value| f16::from_f32(*value).to_le_bytes()).collect(),
        }
    }

    fn decode(self, bytes: &[u8]) -> Vec<f32> {
        match self {
            Self::F32 => bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect(),
            Self::F16 => {
                bytes.as_chunks().0.iter().map(|bytes| f16::from_le_bytes(*bytes).to_f32()).collect()
            }
        }
    }
}

/// Writes a bake beside `path` and renames it there; readers see the old file or the new one.
///
/// # Errors
/// [`CacheError`]; the file at `path` is then untouched.
pub fn store(
    path: &Path,
    key: &CacheKey,
    precision: Precision,
    transfer: &Transfer,
) -> Result<(), CacheError> {
    let expected = transfer.vertex_count.saturating_mul(transfer.coefficient_count());
    let vectors = std::iter::once((TRANSFER, &transfer.coefficients))
        .chain(transfer.visibility.as_ref().map(|values| (VISIBILITY, values)));
    let mut tensors = Vec::new();
    let mut hasher = blake3::Hasher::new();
    for (name, values) in vectors {
        if values.len() != expected {
            return Err(CacheError::Shape { found: values.len(), expected });
        }
        let bytes = precision.encode(values);
        hasher.update(&bytes);
        tensors.push((name, bytes));
    }
    let description = Description {
        schema: SCHEMA,
        key: key.to_hex(),
        order: transfer.order,
        vertices: transfer.vertex_count,
        data: hasher.finalize().to_hex().to_string(),
    };
    let encode = |error: &dyn std::fmt::Display| CacheError::Encode(error.to_string());
    let text = serde_json::to_string(&description).map_err(|error| encode(&error))?;
    let shape = vec![transfer.vertex_count, transfer.coefficient_count()];
    let mut views = Vec::new();
    for (name, bytes) in &tensors {
        let view =
            TensorView::new(precision.dtype(), shape.clone(), bytes).map_err(|error| encode(&error))?;
        views.push((*name, view));
    }
    let metadata = HashMap::from([(ENTRY.to_owned(), text)]);
    let bytes = safetensors::serialize(views, Some(metadata)).map_err(|error| encode(&error))?;
    write_whole(path, &bytes).map_err(|source| CacheError::Write { path: path.to_owned(), source })
}

fn write_whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Reads the bake with this key.
///
/// # Errors
/// [`Miss`] says why the file cannot be used.
pub fn load(path: &Path, key: &CacheKey, precision: Precision) -> Result<Transfer, Miss> {
    let bytes = std::fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Miss::Absent,
        _ => Miss::Unreadable(error),
    })?;
    let damaged = |error: &dyn std::fmt::Display| Miss::Damaged(error.to_string());
    let (_, header) = SafeTensors::read_metadata(&bytes).map_err(|error| damaged(&error))?;
    let text = header.metadata().as_ref().and_then(|entries| entries.get(ENTRY)).ok_or(Miss::Foreign)?;
    // The schema is read on its own: other versions may describe themselves otherwise.
    let value: serde_json::Value = serde_json::from_str(text).map_err(|error| damaged(&error))?;
    match value.get("schema").and_then(serde_json::Value::as_u64) {
        Some(schema) if schema == u64::from(SCHEMA) => {}
        Some(schema) => return Err(Miss::OtherSchema { found: u32::try_from(schema).unwrap_or(u32::MAX) }),
        None => return Err(Miss::Foreign),
    }
    let description: Description = serde_json::from_value(value).map_err(|error| damaged(&error))?;
    if description.key != key.to_hex() {
        return Err(Miss::OtherInput);
    }
    let tensors = SafeTensors::deserialize(&bytes).map_err(|error| damaged(&error))?;
    read_tensors(&tensors, &description, precision)
}

fn read_tensors(
    tensors: &SafeTensors<'_>,
    description: &Description,
    precision: Precision,
) -> Result<Transfer, Miss> {
    let damaged = |what: &str| Miss::Damaged(what.to_owned());
    if !(1..=MAX_ORDER).contains(&description.order) {
        return Err(damaged("its order is outside 1..=6"));
    }
    let shape = [description.vertices, description.order * description.order];
    let mut hasher = blake3::Hasher::new();
    let mut read = |name: &str| -> Result<Vec<f32>, Miss> {
        let tensor = tensors.tensor(name).map_err(|error| Miss::Damaged(error.to_string()))?;
        if tensor.shape() != shape {
            return Err(damaged("a tensor's shape differs from its description"));
        }
        if tensor.dtype() != precision.dtype() {
            return Err(match tensor.dtype() {
                Dtype::F32 | Dtype::F16 => Miss::OtherPrecision,
                _ => damaged("a tensor is neither f32 nor f16"),
            });
        }
        hasher.update(tensor.data());
        Ok(precision.decode(tensor.data()))
    };
    let coefficients = read(TRANSFER)?;
    let visibility = if tensors.names().contains(&VISIBILITY) { Some(read(VISIBILITY)?) } else { None };
    if hasher.finalize().to_hex().as_str() != description.data {
        return Err(damaged("its checksum does not fit its data"));
    }
    let (order, vertex_count) = (description.order, description.vertices);
    Ok(Transfer { order, vertex_count, coefficients, visibility })
}
