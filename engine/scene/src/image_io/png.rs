//! 8-bit pictures: PNG in and out, and the PNG and JPEG textures of glTF.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ExtendedColorType, ImageEncoder, ImageFormat, ImageReader};

use crate::error::{SceneError, invalid, unsupported};
use crate::files;
use crate::image::{FloatImage, check_size, srgb_decode};
use crate::tone;

/// A decoded texture and whether 16 bits were cut to 8.
pub(crate) struct DecodedTexture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) pixels: Vec<[u8; 4]>,
    pub(crate) was_deeper: bool,
}

/// Decodes PNG or JPEG. `admit` is asked with the size in pixels before memory is taken.
pub(crate) fn decode_texture(
    file: &Path,
    item: &str,
    bytes: &[u8],
    admit: impl FnOnce(u64) -> Result<(), SceneError>,
) -> Result<DecodedTexture, SceneError> {
    let picture = open(file, item, bytes, admit)?;
    let was_deeper = picture.color().bits_per_pixel() / u16::from(picture.color().channel_count()) > 8;
    let picture = picture.into_rgba8();
    let (width, height) = picture.dimensions();
    let pixels = picture.as_raw().as_chunks::<4>().0.to_vec();
    Ok(DecodedTexture { width, height, pixels, was_deeper })
}

/// Reads a PNG and decodes it from sRGB.
pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<FloatImage, SceneError> {
    let picture = open(file, "PNG image", bytes, |_| Ok(()))?;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let linear = |pixel: &[u16; 3]| pixel.map(|value| srgb_decode(f32::from(value) / 65535.0));
    let pixels = picture.into_rgb16().as_raw().as_chunks::<3>().0.iter().map(linear).collect();
    Ok(FloatImage { width, height, pixels })
}

fn open(
    file: &Path,
    item: &str,
    bytes: &[u8],
    admit: impl FnOnce(u64) -> Result<(), SceneError>,
) -> Result<DynamicImage, SceneError> {
    let broken = |error: image::ImageError| {
        invalid(file, item, error.to_string(), "save the image again as PNG or JPEG")
    };
    let reader = || ImageReader::new(Cursor::new(bytes)).with_guessed_format();
    let io_error = |source| SceneError::Read { file: file.to_path_buf(), source };
    match reader().map_err(io_error)?.format() {
        Some(ImageFormat::Png | ImageFormat::Jpeg) => {}
        _ => return Err(unsupported(file, item, "this image format", "save the image as PNG or JPEG")),
    }
    let (width, height) = reader().map_err(io_error)?.into_dimensions().map_err(broken)?;
    check_size(file, item, u64::from(width), u64::from(height))?;
    admit(u64::from(width) * u64::from(height))?;
    reader().map_err(io_error)?.decode().map_err(broken)
}

/// Exposes, tone-maps ([`tone::encode`]) and writes a scene-linear picture as 8-bit sRGB PNG; whole or not at all.
///
/// # Errors
/// As [`write_png_bytes`].
pub fn write_png(file: &Path, picture: &FloatImage, exposure: f32) -> Result<(), SceneError> {
    write_png_bytes(file, picture.width, picture.height, &tone::encode(picture, exposure))
}

/// Writes display-ready RGB bytes as PNG, rows from the top; whole or not at all.
///
/// # Errors
/// [`SceneError::Write`] if the file cannot be written, [`SceneError::Invalid`] if there are no pixels or fewer
/// than `width * height`.
pub fn write_png_bytes(
    file: &Path,
    width: usize,
    height: usize,
    pixels: &[[u8; 3]],
) -> Result<(), SceneError> {
    super::check_complete(file, width, height, pixels.len())?;
    let mut bytes = Vec::new();
    image::codecs::png::PngEncoder::new(&mut bytes)
        .write_image(pixels.as_flattened(), width as u32, height as u32, ExtendedColorType::Rgb8)
        .map_err(|error| invalid(file, "PNG image", error.to_string(), "check the picture's size"))?;
    files::write_atomically(file, &bytes)
}
