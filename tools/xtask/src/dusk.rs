//! Makes `assets/env/dusk_512.exr`: a clear sky after sunset over dark hills, brightest at the middle of the map, where the
//! sun went down. A painting, not a measurement.

use std::f32::consts::{PI, TAU};
use std::path::Path;

use airglow_scene::FloatImage;
use airglow_scene::image_io::write_exr;
use glam::Vec3;

use crate::error::Error;
use crate::relief::unit;

/// Texels of a row.
const WIDTH: u32 = 512;

/// Radiance overhead, around the horizon, of the wide afterglow and of the narrow one at the horizon, W/sr/m2.
const ZENITH: Vec3 = Vec3::new(0.030, 0.075, 0.24);
const HORIZON: Vec3 = Vec3::new(0.085, 0.175, 0.34);
const WIDE: Vec3 = Vec3::new(0.60, 0.27, 0.12);
const NARROW: Vec3 = Vec3::new(2.6, 0.95, 0.22);
const HILLS: Vec3 = Vec3::new(0.020, 0.021, 0.030);

/// Writes the map below `assets`.
pub fn make(assets: &Path) -> Result<(), Error> {
    let height = WIDTH / 2;
    let texel = |at: u32| {
        let (x, y) = (at % WIDTH, at / WIDTH);
        let azimuth = TAU * ((x as f32 + 0.5) / WIDTH as f32 - 0.5);
        let elevation = PI * (0.5 - (y as f32 + 0.5) / height as f32);
        // Ten bits of each number are enough, and the rest would not compress.
        radiance(azimuth, elevation).to_array().map(|value| f32::from_bits(value.to_bits() & 0xffff_e000))
    };
    let pixels = (0..WIDTH * height).map(texel).collect();
    let path = assets.join("env/dusk_512.exr");
    write_exr(&path, &FloatImage { width: WIDTH as usize, height: height as usize, pixels })
        .map_err(|error| Error::Asset { path, message: error.to_string() })
}

/// Of a direction, radians from where the sun went down and over the horizon.
fn radiance(azimuth: f32, elevation: f32) -> Vec3 {
    let degrees = elevation.to_degrees();
    let hills =
        1.2 + 3.4 * noise(azimuth, 9.0, 1) + 1.3 * noise(azimuth, 40.0, 2) + 0.6 * noise(azimuth, 130.0, 3);
    if degrees < hills {
        return HILLS * (0.6 + 0.4 * (degrees / hills).max(0.0));
    }
    let sky = sky(azimuth, degrees);
    // Streaks of cloud, lit from below.
    let streak = cloud(azimuth, degrees)
        * ((degrees - 3.0) / 6.0).clamp(0.0, 1.0)
        * (1.0 - degrees / 42.0).clamp(0.0, 1.0);
    let towards = (-(azimuth / 1.1).powi(2)).exp();
    let lit = 0.8 * sky + towards * (-degrees / 13.0).exp() * Vec3::new(1.1, 0.46, 0.26);
    sky.lerp(lit, streak)
}

/// Without clouds.
fn sky(azimuth: f32, degrees: f32) -> Vec3 {
    let clear = HORIZON.lerp(ZENITH, 1.0 - (-degrees / 26.0).exp());
    let wide = (-(azimuth / 1.25).powi(2)).exp() * (-degrees / 9.5).exp();
    let narrow = (-(azimuth / 0.75).powi(2)).exp() * (-degrees / 4.5).exp();
    clear + wide * WIDE + narrow * NARROW
}

/// How much of a streak there is, 0 to 1; streaks lie along the horizon.
fn cloud(azimuth: f32, degrees: f32) -> f32 {
    let mut sum = 0.0;
    for (octave, weight) in [(1.0, 0.5), (2.3, 0.3), (5.1, 0.2)] {
        let row = degrees * 0.42 * octave + 3.0 * noise(azimuth, 5.0, 5);
        let [low, part] = [row.floor(), row - row.floor()];
        let at = |row: f32| noise(azimuth, 14.0 * octave, 11 + row as u32);
        sum += weight * (at(low) + part * part * (3.0 - 2.0 * part) * (at(low + 1.0) - at(low)));
    }
    ((sum - 0.5) / 0.22).clamp(0.0, 1.0)
}

/// A smooth number in [0, 1] around the horizon, with so many knots.
fn noise(azimuth: f32, knots: f32, salt: u32) -> f32 {
    let knots = knots.round();
    let at = (azimuth / TAU + 0.5) * knots;
    let knot = |i: f32| unit((i.rem_euclid(knots) as u32).wrapping_mul(7919).wrapping_add(salt * 104_729));
    let part = at - at.floor();
    knot(at.floor()) + part * part * (3.0 - 2.0 * part) * (knot(at.floor() + 1.0) - knot(at.floor()))
}
