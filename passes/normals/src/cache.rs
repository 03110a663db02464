//! Chains kept in files: one map, one safetensors file, found by a key over all that the chain depends on.
//!
//! A tensor `level1`, `level2`, … for each level, `[lobes, rows, columns, 4]`, f16, signed or unsigned bytes, as the texture takes them;
//! the metadata entry `airglow.normals` has schema, key and checksum. A file is written beside its target and renamed, so
//! that it is whole or absent; whatever cannot be used, for a reason that is told, is built again.

use std::collections::HashMap;
use std::io::Write;
use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde::{Deserialize, Serialize};

pub use crate::error::StoreError;

use crate::chain::{self, Level};
use crate::map::NormalMap;
use crate::settings::Settings;
use crate::storage::Storage;

/// Version of the layout and of the numbers in it. It rises whenever the same map would come out differently.
pub const SCHEMA: u32 = 2;
const ENTRY: &str = "airglow.normals";

/// BLAKE3 of the schema, the settings and the map. Equal keys mean equal chains on one driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ChainKey(blake3::Hash);

/// The levels of a map as a texture takes them, finest first.
#[derive(Clone, Debug, PartialEq)]
pub struct PackedChain {
    /// Bytes of each level, lobe by lobe, row by row.
    pub levels: Vec<Vec<u8>>,
}

/// Why a file could not be used. None of these is an error: the chain is built again.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Miss {
    /// There is no such file, or it cannot be read.
    #[error("the file of the chain cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// Not a safetensors file, cut short, or damaged.
    #[error("the file of the chain is damaged: {0}")]
    Damaged(String),
    /// Of another map, other settings or another version.
    #[error("the file is of another map, other settings or another version")]
    Other,
}

#[derive(Serialize, Deserialize)]
struct Description {
    schema: u32,
    key: String,
    /// BLAKE3 of the tensors' bytes, finest level first.
    data: String,
}

impl ChainKey {
    /// Hashes a map and the settings of its chain; the budget does not count, it changes no number.
    #[must_use]
    pub fn new(map: &NormalMap, settings: &Settings) -> Self {
        let mut hasher = blake3::Hasher::new();
        let [width, height] = map.size(0);
        let storage = settings.storage.format().as_raw() as u64;
        let numbers = [u64::from(SCHEMA), width as u64, height as u64, settings.fit.lobes as u64, storage];
        hasher.update(b"airglow normals");
        numbers.iter().for_each(|number| {
            hasher.update(&number.to_le_bytes());
        });
        hasher.update(&(settings.fit.iterations as u64).to_le_bytes());
        hasher.update(&settings.fit.sharpest.to_le_bytes());
        for normal in map.normals() {
            hasher.update(bytemuck::cast_slice(&normal.to_array()));
        }
        Self(hasher.finalize())
    }

    /// The hash as 64 hexadecimal digits: a good file name.
    #[must_use]
    pub fn to_hex(&self) -> String {
        self.0.to_hex().to_string()
    }
}

/// Writes the chain of a map beside `path` and renames it there; readers see the old file or the new one.
///
/// # Errors
/// [`StoreError`].
pub fn store(
    path: &Path,
    map: &NormalMap,
    settings: &Settings,
    chain: &PackedChain,
) -> Result<(), StoreError> {
    let levels = chain::levels(map, settings)?;
    if levels.len() != chain.levels.len()
        || levels.iter().zip(&chain.levels).any(|(level, bytes)| level.bytes != bytes.len() as u64)
    {
        return Err(StoreError::Shape);
    }
    let encode = |error: &dyn std::fmt::Display| StoreError::Encode(error.to_string());
    let description = Description {
        schema: SCHEMA,
        key: ChainKey::new(map, settings).to_hex(),
        data: checksum(chain.levels.iter().map(Vec::as_slice)),
    };
    let text = serde_json::to_string(&description).map_err(|error| encode(&error))?;
    let mut views = Vec::new();
    for (level, bytes) in levels.iter().zip(&chain.levels) {
        let view = TensorView::new(dtype(settings.storage), shape(level, settings), bytes)
            .map_err(|error| encode(&error))?;
        views.push((name(level), view));
    }
    let metadata = HashMap::from([(ENTRY.to_owned(), text)]);
    let bytes = safetensors::serialize(views, Some(metadata)).map_err(|error| encode(&error))?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let write = || {
        let mut file = tempfile::NamedTempFile::new_in(folder)?;
        file.write_all(&bytes)?;
        file.as_file().sync_all()?;
        file.persist(path).map(drop).map_err(|error| error.error)
    };
    write().map_err(|source| StoreError::Write { path: path.to_owned(), source })
}

/// Reads the chain of a map.
///
/// # Errors
/// [`Miss`] says why the file cannot be used.
pub fn load(path: &Path, map: &NormalMap, settings: &Settings) -> Result<PackedChain, Miss> {
    let bytes = std::fs::read(path)?;
    let damaged = |error: &dyn std::fmt::Display| Miss::Damaged(error.to_string());
    let (_, header) = SafeTensors::read_metadata(&bytes).map_err(|error| damaged(&error))?;
    let text = header.metadata().as_ref().and_then(|entries| entries.get(ENTRY)).ok_or(Miss::Other)?;
    let description: Description = serde_json::from_str(text).map_err(|error| damaged(&error))?;
    let levels = chain::levels(map, settings).map_err(|_| Miss::Other)?;
    if description.schema != SCHEMA || description.key != ChainKey::new(map, settings).to_hex() {
        return Err(Miss::Other);
    }
    let tensors = SafeTensors::deserialize(&bytes).map_err(|error| damaged(&error))?;
    let mut found = Vec::new();
    for level in &levels {
        let tensor = tensors.tensor(&name(level)).map_err(|error| damaged(&error))?;
        if tensor.shape() != shape(level, settings) || tensor.dtype() != dtype(settings.storage) {
            return Err(Miss::Damaged("a level has another shape than its map gives it".to_owned()));
        }
        found.push(tensor.data().to_vec());
    }
    if checksum(found.iter().map(Vec::as_slice)) != description.data {
        return Err(Miss::Damaged("its checksum does not fit its data".to_owned()));
    }
    Ok(PackedChain { levels: found })
}

fn name(level: &Level) -> String {
    format!("level{}", level.level)
}

fn shape(level: &Level, settings: &Settings) -> Vec<usize> {
    vec![settings.fit.lobes, level.size[1], level.size[0], 4]
}

fn dtype(storage: Storage) -> Dtype {
    match storage {
        Storage::F16 => Dtype::F16,
        Storage::Snorm8 => Dtype::I8,
        Storage::Octahedral8 => Dtype::U8,
    }
}

fn checksum<'a>(levels: impl Iterator<Item = &'a [u8]>) -> String {
    let mut hasher = blake3::Hasher::new();
    levels.for_each(|bytes| {
        hasher.update(bytes);
    });
    hasher.finalize().to_hex().to_string()
}
