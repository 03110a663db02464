//! Radiance pictures (RGBE): Ward, "Real Pixels", Graphics Gems II, 1991.

use std::io::Cursor;
use std::path::Path;

use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;

use crate::error::{SceneError, invalid};
use crate::image::{FloatImage, check_size};

/// Reads an RGBE picture, divided by the exposure its header states, as the format asks.
pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<FloatImage, SceneError> {
    let broken = |problem: String| {
        invalid(file, "Radiance image", problem, "save it again as Radiance RGBE (#?RADIANCE) or as EXR")
    };
    let decoder = HdrDecoder::new(Cursor::new(bytes)).map_err(|error| broken(error.to_string()))?;
    let meta = decoder.metadata();
    check_size(file, "Radiance image", u64::from(meta.width), u64::from(meta.height))?;
    if meta.custom_attributes.iter().any(|(key, value)| key == "FORMAT" && value.contains("xyze")) {
        return Err(broken("its pixels are XYZE and not RGBE".into()));
    }
    let exposure = meta.exposure.unwrap_or(1.0);
    if !(exposure > 0.0 && exposure.is_finite()) {
        return Err(broken(format!("its header states an exposure of {exposure}")));
    }
    let (width, height) = (meta.width as usize, meta.height as usize);
    let mut pixels = vec![[0.0_f32; 3]; width * height];
    decoder.read_image(bytemuck::cast_slice_mut(&mut pixels)).map_err(|error| broken(error.to_string()))?;
    if exposure != 1.0 {
        pixels.as_flattened_mut().iter_mut().for_each(|value| *value /= exposure);
    }
    Ok(FloatImage { width, height, pixels })
}
