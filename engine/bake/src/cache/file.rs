//! The cache file of a bake.

use std::path::Path;

use half::f16;
use serde_json::{Map, Value};

use super::container::{Container, Element, Field, Opened};
use super::error::{CacheError, Miss};
use super::key::{CacheKey, SCHEMA};
use crate::Transfer;
use crate::settings::MAX_ORDER;

const CONTAINER: Container = Container { entry: "airglow.bake", schema: SCHEMA };
/// Names of the tensors.
const TRANSFER: &str = "transfer";
const VISIBILITY: &str = "visibility";
/// Names of what the metadata entry says.
const ORDER: &str = "order";
const VERTICES: &str = "vertices";

/// How coefficients are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Precision {
    /// 32 bits: exactly what was baked.
    F32,
    /// 16 bits, relative error 2⁻¹¹: half the bytes.
    F16,
}

impl Precision {
    /// Rounds vectors to what a file of this precision holds.
    pub fn round(self, transfer: &mut Transfer) {
        if self == Self::F16 {
            let vectors = transfer.coefficients.iter_mut().chain(transfer.visibility.iter_mut().flatten());
            vectors.for_each(|value| *value = f16::from_f32(*value).to_f32());
        }
    }

    fn element(self) -> Element {
        match self {
            Self::F32 => Element::F32,
            Self::F16 => Element::F16,
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
    for (name, values) in vectors {
        if values.len() != expected {
            return Err(CacheError::Shape { found: values.len(), expected });
        }
        tensors.push((name, precision.encode(values)));
    }
    let shape = vec![transfer.vertex_count, transfer.coefficient_count()];
    let fields: Vec<_> = tensors
        .iter()
        .map(|(name, bytes)| Field { name, element: precision.element(), shape: shape.clone(), bytes })
        .collect();
    let mut description = Map::new();
    description.insert(ORDER.to_owned(), transfer.order.into());
    description.insert(VERTICES.to_owned(), transfer.vertex_count.into());
    CONTAINER.store(path, &key.to_hex(), description, &fields)
}

/// Reads the bake with this key.
///
/// # Errors
/// [`Miss`] says why the file cannot be used.
pub fn load(path: &Path, key: &CacheKey, precision: Precision) -> Result<Transfer, Miss> {
    let bytes = Container::read(path)?;
    read_tensors(CONTAINER.open(&bytes, &key.to_hex())?, precision)
}

fn read_tensors(mut file: Opened<'_>, precision: Precision) -> Result<Transfer, Miss> {
    let number =
        |name: &str| file.description.get(name).and_then(Value::as_u64).map(|number| number as usize);
    let (Some(order), Some(vertex_count)) = (number(ORDER), number(VERTICES)) else {
        return Err(Miss::Damaged("its order or its number of vertices is missing".to_owned()));
    };
    if !(1..=MAX_ORDER).contains(&order) {
        return Err(Miss::Damaged("its order is outside 1..=6".to_owned()));
    }
    let shape = [vertex_count, order * order];
    let read = |file: &mut Opened<'_>, name: &str| match file.field(name, &shape)? {
        (element, bytes) if element == precision.element() => Ok(precision.decode(bytes)),
        (Element::F32 | Element::F16, _) => Err(Miss::OtherPrecision),
        (Element::U32, _) => Err(Miss::Damaged("a tensor is neither f32 nor f16".to_owned())),
    };
    let coefficients = read(&mut file, TRANSFER)?;
    let seen = file.has(VISIBILITY);
    let visibility = if seen { Some(read(&mut file, VISIBILITY)?) } else { None };
    file.check()?;
    Ok(Transfer { order, vertex_count, coefficients, visibility })
}
