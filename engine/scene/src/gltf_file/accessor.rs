//! Byte ranges: every buffer view lies in its buffer and every accessor in its view, so that readers stay inside;
//! and the types that each use of an accessor allows (glTF 2.0, 3.6.2 and 3.7.2.1).

use std::path::Path;

use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;
use gltf::{Accessor, Document};

use super::label;
use crate::error::{SceneError, at_most, invalid};
use crate::limits::MAX_VERTICES;

const MEND: &str = "export the file again";

/// Checks the ranges of every buffer view and accessor, used or not.
pub(super) fn check_all(file: &Path, document: &Document, buffers: &[Vec<u8>]) -> Result<(), SceneError> {
    for view in document.views() {
        let available = buffers.get(view.buffer().index()).map_or(0, Vec::len);
        if view.offset().checked_add(view.length()).is_none_or(|end| end > available) {
            let (offset, length) = (view.offset(), view.length());
            let problem = format!("bytes {offset} + {length} lie outside its buffer of {available} bytes");
            return Err(invalid(file, label("buffer view", view.index(), view.name()), problem, MEND));
        }
    }
    document.accessors().try_for_each(|accessor| check(file, &accessor, buffers))
}

fn check(file: &Path, accessor: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<(), SceneError> {
    let item = label("accessor", accessor.index(), accessor.name());
    let broken = |problem: String| invalid(file, item.clone(), problem, MEND);
    if accessor.count() == 0 {
        return Err(broken("it is empty".into()));
    }
    at_most(file, &item, accessor.count() as u64, 3 * MAX_VERTICES, "elements", "simplify the mesh")?;
    if let Some(view) = accessor.view() {
        check_range(&view, accessor.offset(), accessor.count(), accessor.size()).map_err(broken)?;
    }
    if let Some(sparse) = accessor.sparse() {
        if sparse.count() == 0 || sparse.count() > accessor.count() {
            let (count, all) = (sparse.count(), accessor.count());
            return Err(broken(format!("it replaces {count} of {all} elements")));
        }
        let (indices, values) = (sparse.indices(), sparse.values());
        check_range(&indices.view(), indices.offset(), sparse.count(), indices.index_type().size())
            .map_err(broken)?;
        check_range(&values.view(), values.offset(), sparse.count(), accessor.size()).map_err(broken)?;
        check_sparse_indices(accessor, &sparse, buffers).map_err(broken)?;
    }
    Ok(())
}

/// `count` elements of `size` bytes from `offset`, at the view's stride, lie inside the view.
fn check_range(view: &View<'_>, offset: usize, count: usize, size: usize) -> Result<(), String> {
    let stride = view.stride().unwrap_or(size);
    if stride < size {
        return Err(format!("elements of {size} bytes stand every {stride} bytes"));
    }
    let last = (count - 1).checked_mul(stride).and_then(|start| start.checked_add(size));
    let end = last.and_then(|last| last.checked_add(offset));
    if end.is_none_or(|end| end > view.length()) {
        let (index, length) = (view.index(), view.length());
        return Err(format!(
            "{count} elements of {size} bytes from byte {offset} do not fit into buffer view {index} of {length} bytes"
        ));
    }
    Ok(())
}

/// The indices of replaced elements grow strictly and lie inside the accessor.
fn check_sparse_indices(
    accessor: &Accessor<'_>,
    sparse: &gltf::accessor::sparse::Sparse<'_>,
    buffers: &[Vec<u8>],
) -> Result<(), String> {
    let indices = sparse.indices();
    let view = indices.view();
    let bytes = buffers.get(view.buffer().index()).map_or(&[][..], Vec::as_slice);
    let size = indices.index_type().size();
    let start = view.offset() + indices.offset();
    let mut least = 0;
    for number in 0..sparse.count() {
        let at = start + number * view.stride().unwrap_or(size);
        let mut word = [0; 8];
        word[..size].copy_from_slice(bytes.get(at..at + size).unwrap_or(&[0; 8][..size]));
        let index = u64::from_le_bytes(word);
        if index < least || index >= accessor.count() as u64 {
            return Err(format!("replaced element {number} has index {index}, out of order or range"));
        }
        least = index + 1;
    }
    Ok(())
}

/// What an accessor is used for, and what it must be for that.
pub(super) struct Use {
    /// For messages, such as `NORMAL`.
    pub(super) name: &'static str,
    pub(super) dimensions: Dimensions,
    pub(super) types: &'static [DataType],
}

/// Checks an accessor against its use and, if given, its number of elements. `item` is what uses it.
pub(super) fn check_use(
    file: &Path,
    item: &str,
    accessor: &Accessor<'_>,
    wanted: &Use,
    count: Option<usize>,
) -> Result<(), SceneError> {
    let broken = |problem: String| {
        let item = format!("{item}, {} (accessor {})", wanted.name, accessor.index());
        Err(invalid(file, item, problem, MEND))
    };
    let (dimensions, data_type) = (accessor.dimensions(), accessor.data_type());
    if dimensions != wanted.dimensions || !wanted.types.contains(&data_type) {
        return broken(format!(
            "{dimensions:?} of {data_type:?} found, {:?} of {:?} expected",
            wanted.dimensions, wanted.types
        ));
    }
    match count {
        Some(count) if count != accessor.count() => {
            broken(format!("{} elements found, {count} expected", accessor.count()))
        }
        _ => Ok(()),
    }
}
