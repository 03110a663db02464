//! Distant light around the scene.

use std::path::PathBuf;

use glam::Quat;

/// Light that arrives from infinitely far away, as an equirectangular map.
///
/// Pixel (u, v) in [0, 1]^2, v down, shows the direction phi = 2 pi (u - 1/2), theta = pi v,
/// d = (sin theta sin phi, cos theta, -sin theta cos phi): the centre looks down -Z and u grows towards +X.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// Where it was read from.
    pub file: PathBuf,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Radiance in linear Rec. 709 RGB, W/sr/m2, rows from the top; finite, not negative, and already
    /// multiplied by the scene file's scale.
    pub pixels: Vec<[f32; 3]>,
    /// World from map: a direction d of the map stands at `rotation * d` in the world.
    pub rotation: Quat,
    /// Metres of the scene's medium that its light comes through; `None`: it is not seen through the medium.
    pub distance: Option<f32>,
}
