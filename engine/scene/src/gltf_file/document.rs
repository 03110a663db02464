//! Opens a glTF file: container, JSON and buffers, checked before any reader follows an offset.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use base64::Engine;
use serde_json::Value;

use super::uv_transform::UvTransform;
use super::{accessor, check, extensions};
use crate::error::{SceneError, at_most, invalid, unsupported};
use crate::files;
use crate::limits::MAX_FILE_BYTES;
use crate::warning::Warnings;

/// A document whose indices, trees and byte ranges are sound, with the bytes of its buffers.
pub(super) struct Document {
    pub(super) gltf: gltf::Document,
    pub(super) buffers: Vec<Vec<u8>>,
    /// Texture transform of the normal texture of each material.
    pub(super) normal_transforms: Vec<Option<UvTransform>>,
}

impl Document {
    /// The bytes of a buffer, as the readers of the gltf crate ask for them.
    pub(super) fn bytes(&self, buffer: gltf::Buffer<'_>) -> Option<&[u8]> {
        self.buffers.get(buffer.index()).map(Vec::as_slice)
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, view: &gltf::buffer::View<'_>) -> Option<&[u8]> {
        let end = view.offset().checked_add(view.length())?;
        self.bytes(view.buffer())?.get(view.offset()..end)
    }
}

/// Opens `file` and checks it.
pub(super) fn open(file: &Path, warnings: &mut Warnings<'_>) -> Result<Document, SceneError> {
    let bytes = files::read(file, MAX_FILE_BYTES)?;
    let (json, blob) = split(file, &bytes)?;
    let broken = |error: serde_json::Error| {
        invalid(file, "JSON", error.to_string(), "export the glTF file again; it may be cut short")
    };
    let value: Value = serde_json::from_slice(json).map_err(broken)?;
    let root: gltf::json::Root = serde_json::from_slice(json).map_err(broken)?;
    extensions::refuse_required(file, &root)?;
    extensions::warn(&value, warnings);
    let materials = value.get("materials").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let normal_transforms =
        materials.iter().map(UvTransform::of_normal_texture).collect::<Result<_, _>>().map_err(broken)?;
    check::structure(file, &root)?;
    let gltf = gltf::Document::from_json(root).map_err(|error| {
        invalid(file, "JSON", error.to_string(), "check the file with the Khronos glTF validator")
    })?;
    let buffers = load_buffers(file, &gltf, blob)?;
    accessor::check_all(file, &gltf, &buffers)?;
    Ok(Document { gltf, buffers, normal_transforms })
}

/// Bytes of the GLB header: magic, version, length.
const GLB_HEADER: usize = 12;

/// The JSON and the binary chunk of a GLB file; all of a `.gltf` file is JSON.
fn split<'a>(file: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), SceneError> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let broken = |problem: String| {
        invalid(file, "GLB container", problem, "export the file again; it may be cut short")
    };
    // The gltf crate subtracts the header from the stated length without looking.
    let stated =
        bytes.get(8..GLB_HEADER).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    if stated.is_none_or(|length| (length as usize) < GLB_HEADER || length as usize > bytes.len()) {
        return Err(broken(format!("{} bytes are there, {} are stated", bytes.len(), stated.unwrap_or(0))));
    }
    let glb = gltf::Glb::from_slice(bytes).map_err(|error| broken(error.to_string()))?;
    match (glb.json, glb.bin) {
        (Cow::Borrowed(json), None) => Ok((json, None)),
        (Cow::Borrowed(json), Some(Cow::Borrowed(blob))) => Ok((json, Some(blob))),
        _ => Err(broken("its chunks could not be told apart".into())),
    }
}

fn load_buffers(file: &Path, gltf: &gltf::Document, blob: Option<&[u8]>) -> Result<Vec<Vec<u8>>, SceneError> {
    let mut buffers = Vec::new();
    let mut total = 0;
    for buffer in gltf.buffers() {
        let item = super::label("buffer", buffer.index(), buffer.name());
        let mut bytes = match buffer.source() {
            gltf::buffer::Source::Uri(uri) => fetch(file, &item, uri)?,
            gltf::buffer::Source::Bin if buffer.index() == 0 => blob.unwrap_or_default().to_vec(),
            gltf::buffer::Source::Bin => Vec::new(),
        };
        if bytes.len() < buffer.length() {
            let problem = format!("{} bytes are there, {} are stated", bytes.len(), buffer.length());
            return Err(invalid(file, item, problem, "export the file again; data is missing"));
        }
        bytes.truncate(buffer.length());
        total += bytes.len() as u64;
        at_most(file, &item, total, MAX_FILE_BYTES, "bytes of all buffers", "split the file")?;
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// The bytes behind a URI: base64 data in the URI itself, or a file named relative to `file`.
pub(super) fn fetch(file: &Path, item: &str, uri: &str) -> Result<Vec<u8>, SceneError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((_, encoded)) = data.split_once(";base64,") else {
            return Err(unsupported(
                file,
                item,
                "a data URI that is not base64",
                "encode the data as base64",
            ));
        };
        return base64::engine::general_purpose::STANDARD
            .decode(encoded)
            .map_err(|error| invalid(file, item, error.to_string(), "export the file again"));
    }
    files::read(&resolve(file, item, uri)?, MAX_FILE_BYTES)
}

/// The path of a relative URI, percent-decoded.
fn resolve(file: &Path, item: &str, uri: &str) -> Result<PathBuf, SceneError> {
    const MEND: &str = "name a file relative to the glTF file";
    let decoded = percent_decode(uri)
        .ok_or_else(|| invalid(file, item, format!("the URI {uri:?} is not percent-encoded UTF-8"), MEND))?;
    if decoded.contains("://") || decoded.contains('\0') || Path::new(&decoded).has_root() {
        return Err(unsupported(file, item, format!("the URI {uri:?}"), MEND));
    }
    Ok(file.parent().unwrap_or(Path::new("")).join(decoded))
}

fn percent_decode(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let digits = std::str::from_utf8(rest.get(..2)?).ok()?;
        bytes.push(u8::from_str_radix(digits, 16).ok()?);
        rest = &rest[2..];
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_decoded_and_stay_relative() {
        let file = Path::new("models/a.gltf");
        assert_eq!(resolve(file, "image 0", "my%20wood.png").unwrap(), Path::new("models/my wood.png"));
        for bad in ["https://example.org/a.bin", "/etc/passwd", "a%2", "a%zz", "%ff", "a%00"] {
            assert!(resolve(file, "image 0", bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn data_uris_hold_base64() {
        let file = Path::new("a.gltf");
        let found = fetch(file, "buffer 0", "data:application/octet-stream;base64,AAECAw==").unwrap();
        assert_eq!(found, [0, 1, 2, 3]);
        assert!(fetch(file, "buffer 0", "data:text/plain,abc").is_err());
        assert!(fetch(file, "buffer 0", "data:;base64,A").is_err());
    }
}
