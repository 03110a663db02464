//! A safetensors file of one kind, checked from the outside in: a metadata entry that says whose it is, of which version and
//! for which input, and tensors under a checksum. It is written beside its target and renamed.

use std::collections::HashMap;
use std::io::Write;
use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde_json::{Map, Value};

use super::error::{CacheError, Miss};

/// A kind of cache file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Container {
    /// Name of the metadata entry.
    pub entry: &'static str,
    /// Version of the layout and of what the numbers mean.
    pub schema: u32,
}

/// What a tensor is made of, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// IEEE binary32.
    F32,
    /// IEEE binary16.
    F16,
    /// Unsigned, 32 bits.
    U32,
}

/// A tensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<'a> {
    /// Its name.
    pub name: &'a str,
    /// What it is made of.
    pub element: Element,
    /// Its shape, row-major.
    pub shape: Vec<usize>,
    /// Its bytes.
    pub bytes: &'a [u8],
}

/// A sound file of the right kind, version and input.
#[derive(Debug)]
pub struct Opened<'a> {
    /// What the metadata entry says, besides schema, key and checksum.
    pub description: Map<String, Value>,
    tensors: SafeTensors<'a>,
    hasher: blake3::Hasher,
}

/// BLAKE3 over a label, a schema and parts, each preceded by its length: what a file is found by.
#[must_use]
pub fn key(container: Container, parts: &[&[u8]]) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in [container.entry.as_bytes(), &container.schema.to_le_bytes()].iter().chain(parts) {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    hasher.finalize().to_hex().to_string()
}

impl Container {
    /// Writes a file; readers see the old one or the new one. Fields are read again in the order given.
    ///
    /// # Errors
    /// [`CacheError`]; the file at `path` is then untouched.
    pub fn store(
        self,
        path: &Path,
        key: &str,
        mut description: Map<String, Value>,
        fields: &[Field<'_>],
    ) -> Result<(), CacheError> {
        let encode = |error: &dyn std::fmt::Display| CacheError::Encode(error.to_string());
        let (mut hasher, mut views) = (blake3::Hasher::new(), Vec::new());
        for Field { name, element, shape, bytes } in fields {
            hasher.update(bytes);
            let view =
                TensorView::new(element.dtype(), shape.clone(), bytes).map_err(|error| encode(&error))?;
            views.push((*name, view));
        }
        description.insert("schema".to_owned(), self.schema.into());
        description.insert("key".to_owned(), key.into());
        description.insert("data".to_owned(), hasher.finalize().to_hex().as_str().into());
        let metadata = HashMap::from([(self.entry.to_owned(), Value::from(description).to_string())]);
        let bytes = safetensors::serialize(views, Some(metadata)).map_err(|error| encode(&error))?;
        write_whole(path, &bytes).map_err(|source| CacheError::Write { path: path.to_owned(), source })
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// [`Miss::Absent`] and [`Miss::Unreadable`].
    pub fn read(path: &Path) -> Result<Vec<u8>, Miss> {
        std::fs::read(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => Miss::Absent,
            _ => Miss::Unreadable(error),
        })
    }

    /// Looks whose they are, of which version, and for which input.
    ///
    /// # Errors
    /// [`Miss`] says why they cannot be used.
    pub fn open<'a>(self, bytes: &'a [u8], key: &str) -> Result<Opened<'a>, Miss> {
        let damaged = |error: &dyn std::fmt::Display| Miss::Damaged(error.to_string());
        let (_, header) = SafeTensors::read_metadata(bytes).map_err(|error| damaged(&error))?;
        let entries = header.metadata().as_ref();
        let text = entries.and_then(|entries| entries.get(self.entry)).ok_or(Miss::Foreign)?;
        // The schema is read on its own: other versions may describe themselves otherwise.
        let value: Value = serde_json::from_str(text).map_err(|error| damaged(&error))?;
        match value.get("schema").and_then(Value::as_u64) {
            Some(schema) if schema == u64::from(self.schema) => {}
            Some(found) => return Err(Miss::OtherSchema { found: u32::try_from(found).unwrap_or(u32::MAX) }),
            None => return Err(Miss::Foreign),
        }
        let Value::Object(description) = value else { return Err(Miss::Foreign) };
        if description.get("key").and_then(Value::as_str) != Some(key) {
            return Err(Miss::OtherInput);
        }
        let tensors = SafeTensors::deserialize(bytes).map_err(|error| damaged(&error))?;
        Ok(Opened { description, tensors, hasher: blake3::Hasher::new() })
    }
}

impl<'a> Opened<'a> {
    /// Whether there is a tensor of the name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.tensors.names().contains(&name)
    }

    /// The next field, of the shape that is expected: its element and bytes.
    ///
    /// # Errors
    /// [`Miss::Damaged`] unless there is such a field.
    pub fn field(&mut self, name: &str, shape: &[usize]) -> Result<(Element, &'a [u8]), Miss> {
        let damaged = |what: &str| Miss::Damaged(what.to_owned());
        let tensor = self.tensors.tensor(name).map_err(|error| Miss::Damaged(error.to_string()))?;
        if tensor.shape() != shape {
            return Err(damaged("a tensor's shape differs from its description"));
        }
        let element = match tensor.dtype() {
            Dtype::F32 => Element::F32,
            Dtype::F16 => Element::F16,
            Dtype::U32 => Element::U32,
            _ => return Err(damaged("a tensor is none of f32, f16 and u32")),
        };
        self.hasher.update(tensor.data());
        Ok((element, tensor.data()))
    }

    /// Holds all fields read against the checksum.
    ///
    /// # Errors
    /// [`Miss::Damaged`] where it does not fit.
    pub fn check(&self) -> Result<(), Miss> {
        let sum = self.description.get("data").and_then(Value::as_str);
        match sum == Some(self.hasher.finalize().to_hex().as_str()) {
            true => Ok(()),
            false => Err(Miss::Damaged("its checksum does not fit its data".to_owned())),
        }
    }
}

impl Element {
    fn dtype(self) -> Dtype {
        match self {
            Self::F32 => Dtype::F32,
            Self::F16 => Dtype::F16,
            Self::U32 => Dtype::U32,
        }
    }
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
