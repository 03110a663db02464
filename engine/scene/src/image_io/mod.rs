//! Pictures on disk: environments in, EXR and PNG in and out.

mod openexr;
mod png;
mod radiance;

use std::path::Path;

use crate::environment::Environment;
use crate::error::{SceneError, unsupported};
use crate::files;
use crate::image::FloatImage;
use crate::limits::MAX_FILE_BYTES;

pub use openexr::write_exr;
pub(crate) use png::decode_texture;
pub use png::{write_png, write_png_bytes};

/// Reads a picture as linear Rec. 709 RGB: `.exr` (channels R, G, B), `.hdr` (Radiance RGBE) or `.png` (decoded
/// from sRGB, alpha left out). Values may be anything the format holds, NaN and negative numbers included.
///
/// # Errors
/// [`SceneError`] if the file is missing, broken, too large or of another kind.
pub fn read_image(file: &Path) -> Result<FloatImage, SceneError> {
    let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    let decode = match extension.to_ascii_lowercase().as_str() {
        "exr" => openexr::decode,
        "hdr" => radiance::decode,
        "png" => png::decode,
        other => {
            return Err(unsupported(
                file,
                "file",
                format!("the file name extension {other:?}"),
                "name an .exr, .hdr or .png file",
            ));
        }
    };
    decode(file, &files::read(file, MAX_FILE_BYTES)?)
}

/// Reads an equirectangular environment from `.exr` or `.hdr`, unrotated, unscaled and in clear air.
///
/// # Errors
/// [`SceneError`] as [`read_image`], and [`SceneError::Radiance`] if a pixel is NaN, infinite or negative.
pub fn read_environment(file: &Path) -> Result<Environment, SceneError> {
    let picture = read_image(file)?;
    check_radiance(file, &picture)?;
    Ok(Environment {
        file: file.to_path_buf(),
        width: picture.width,
        height: picture.height,
        pixels: picture.pixels,
        rotation: glam::Quat::IDENTITY,
        distance: None,
    })
}

/// Refuses pixels that cannot be radiance, with their count and the first of them.
pub(crate) fn check_radiance(file: &Path, picture: &FloatImage) -> Result<(), SceneError> {
    let bad = |pixel: &[f32; 3]| pixel.iter().any(|value| !value.is_finite() || *value < 0.0);
    let Some(first) = picture.pixels.iter().position(bad) else { return Ok(()) };
    Err(SceneError::Radiance {
        file: file.to_path_buf(),
        count: picture.pixels.iter().filter(|pixel| bad(pixel)).count(),
        x: first % picture.width,
        y: first / picture.width,
        value: picture.pixels[first],
    })
}

/// Refuses to write a picture whose array does not match its sides.
fn check_complete(file: &Path, width: usize, height: usize, pixels: usize) -> Result<(), SceneError> {
    crate::image::check_size(file, "picture", width as u64, height as u64)?;
    if width * height != pixels {
        let problem = format!("{width} x {height} pixels are stated, but there are {pixels}");
        return Err(crate::error::invalid(file, "picture", problem, "pass one value for each pixel"));
    }
    Ok(())
}
