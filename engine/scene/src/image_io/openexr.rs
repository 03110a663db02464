//! OpenEXR in and out: single-part or layered files with channels R, G and B, single-threaded.

use std::io::Cursor;
use std::path::Path;

use exr::image::read::read;
use exr::image::write::WritableImage;
use exr::image::{Encoding, Image, Layer, SpecificChannels};
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::header::LayerAttributes;
use exr::prelude::{ReadChannels, ReadLayers};

use crate::error::{SceneError, at_most, invalid};
use crate::files;
use crate::image::{FloatImage, check_size};
use crate::limits::MAX_IMAGE_PIXELS;

/// Reads the first layer that has channels R, G and B; others are passed over.
pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<FloatImage, SceneError> {
    let broken = |error: exr::error::Error| {
        let mend = "save it as a flat, scan-line EXR with channels R, G, B and ZIP compression";
        invalid(file, "EXR image", error.to_string(), mend)
    };
    check_header(file, bytes, broken)?;
    let create = |size: Vec2<usize>, _: &_| FloatImage {
        width: size.x(),
        height: size.y(),
        pixels: vec![[0.0; 3]; size.x() * size.y()],
    };
    let set = |picture: &mut FloatImage, at: Vec2<usize>, (r, g, b): (f32, f32, f32)| {
        picture.pixels[at.y() * picture.width + at.x()] = [r, g, b];
    };
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(create, set)
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(broken)?;
    Ok(image.layer_data.channel_data.pixels)
}

/// Checks the sizes of every layer, before any of them is read.
fn check_header(
    file: &Path,
    bytes: &[u8],
    broken: impl Fn(exr::error::Error) -> SceneError,
) -> Result<(), SceneError> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(broken)?;
    for (index, header) in meta.headers.iter().enumerate() {
        let item = format!("EXR layer {index}");
        let (width, height) = (header.layer_size.x() as u64, header.layer_size.y() as u64);
        check_size(file, &item, width, height)?;
        // One block may span the image and hold every channel at once.
        let samples = width * height * header.channels.list.len() as u64;
        at_most(file, item, samples, 4 * MAX_IMAGE_PIXELS, "samples", "leave only the channels R, G and B")?;
    }
    Ok(())
}

/// Writes scene-linear RGB as 32-bit float, scan lines, ZIP compression; whole or not at all.
///
/// # Errors
/// [`SceneError::Write`] if the file cannot be written, [`SceneError::Invalid`] if `picture` has no pixels or its
/// array is shorter than its sides say.
pub fn write_exr(file: &Path, picture: &FloatImage) -> Result<(), SceneError> {
    super::check_complete(file, picture.width, picture.height, picture.pixels.len())?;
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
        let [r, g, b] = picture.pixels[at.y() * picture.width + at.x()];
        (r, g, b)
    });
    let size = (picture.width, picture.height);
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Vec::new();
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes))
        .map_err(|error| invalid(file, "EXR image", error.to_string(), "check the picture's size"))?;
    files::write_atomically(file, &bytes)
}
