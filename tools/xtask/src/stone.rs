//! Maps of cut stone: slabs of a paving, each with the grooves of the chisel its own way, and blocks of a wall in courses.

use std::path::Path;

use glam::{Vec2, Vec3};
use image::{Rgb, RgbImage};

use crate::error::Error;
use crate::relief::{unit, write_map};

/// Texels of a side of the paving's map, slabs along it, and texels of a groove.
const PAVING: u32 = 512;
const SLABS: u32 = 8;
const GROOVE: u32 = 8;
/// The same of the wall: courses along its height, half as many blocks in each.
const WALL: u32 = 256;
const COURSES: u32 = 4;

/// Writes normals below `normalmap` and colours below `texture`.
pub fn make(assets: &Path) -> Result<(), Error> {
    write_map(&assets.join("normalmap/paving.png"), PAVING, paving_slope)?;
    write_map(&assets.join("normalmap/masonry.png"), WALL, wall_slope)?;
    let folder = assets.join("texture");
    std::fs::create_dir_all(&folder).map_err(|source| Error::io(&folder, source))?;
    write_colours(&folder.join("paving.png"), PAVING / 2, |x, y| paving_colour(2 * x, 2 * y))?;
    write_colours(&folder.join("masonry.png"), WALL, wall_colour)
}

/// A cut stone: a number of its own, and where in it a texel lies, 0 to 1 each way, with its size in texels.
struct Cut {
    number: u32,
    place: Vec2,
    size: Vec2,
}

impl Cut {
    /// Texels to the nearest edge, and the way to it.
    fn edge(&self) -> (f32, Vec2) {
        let from = self.size * self.place.min(1.0 - self.place);
        let towards = (self.place - 0.5).signum();
        if from.x < from.y {
            (from.x, Vec2::new(towards.x, 0.0))
        } else {
            (from.y, Vec2::new(0.0, towards.y))
        }
    }

    /// A number of the stone's own in [0, 1).
    fn random(&self, salt: u32) -> f32 {
        unit(self.number.wrapping_mul(31).wrapping_add(977 * salt + 7))
    }

    /// The slope of its worn edge, and of the stone that lies askew.
    fn laid(&self, wear: f32, askew: f32) -> Vec2 {
        let (distance, towards) = self.edge();
        let round = (1.0 - distance / wear).max(0.0);
        let lean = Vec2::new(self.random(1), self.random(2)) - 0.5;
        askew * lean - 1.1 * round * towards
    }

    /// Shade of the stone, darker in the joint.
    fn shade(&self, joint: f32) -> Vec3 {
        let (distance, _) = self.edge();
        let warm = 0.12 * (self.random(4) - 0.5);
        let stone = (0.78 + 0.36 * (self.random(3) - 0.5)) * Vec3::new(1.0 + warm, 1.0, 1.0 - warm);
        stone * if distance < joint { 0.35 } else { 1.0 }
    }
}

fn slab(x: u32, y: u32) -> Cut {
    let size = PAVING / SLABS;
    let place = Vec2::new((x % size) as f32 + 0.5, (y % size) as f32 + 0.5) / size as f32;
    Cut { number: y / size * SLABS + x / size, place, size: Vec2::splat(size as f32) }
}

fn block(x: u32, y: u32) -> Cut {
    let (height, width) = (WALL / COURSES, 2 * WALL / COURSES);
    let course = y / height;
    let x = (x + course % 2 * width / 2 + (course / 2) * width / 4) % WALL;
    let place = Vec2::new((x % width) as f32 + 0.5, (y % height) as f32 + 0.5);
    let size = Vec2::new(width as f32, height as f32);
    Cut { number: 64 + course * 8 + x / width, place: place / size, size }
}

/// Slope along x and, upwards, y.
fn paving_slope(x: u32, y: u32) -> Vec2 {
    let slab = slab(x, y);
    let side = |i: u32| if i % GROOVE < GROOVE / 2 { 0.34 } else { -0.34 };
    let depth = 0.55 + 0.45 * slab.random(6);
    let grooves = if slab.random(5) < 0.5 { Vec2::new(side(x), 0.0) } else { Vec2::new(0.0, side(y)) };
    let (distance, _) = slab.edge();
    let laid = slab.laid(3.0, 0.05);
    let slope = laid + if distance > 3.0 { depth * grooves } else { Vec2::ZERO };
    Vec2::new(slope.x, -slope.y)
}

fn wall_slope(x: u32, y: u32) -> Vec2 {
    let slope = block(x, y).laid(4.0, 0.16) + 0.12 * (Vec2::new(smooth(x, y, 11), smooth(x, y, 12)) - 0.5);
    Vec2::new(slope.x, -slope.y)
}

fn paving_colour(x: u32, y: u32) -> Vec3 {
    slab(x, y).shade(1.5) * (0.86 + 0.28 * smooth(x, y, 13))
}

fn wall_colour(x: u32, y: u32) -> Vec3 {
    block(x, y).shade(1.5) * (0.85 + 0.3 * smooth(x, y, 14))
}

/// A smooth number in [0, 1] without pattern, which repeats with the maps.
fn smooth(x: u32, y: u32, salt: u32) -> f32 {
    let octave = |cell: u32| {
        let corner = |i: u32, j: u32| {
            let [i, j] = [i, j].map(|i| i % (WALL / cell));
            unit(i.wrapping_mul(7919).wrapping_add(j.wrapping_mul(104_729)).wrapping_add(salt * 523 + cell))
        };
        let blend = |i: u32| {
            let t = (i % cell) as f32 / cell as f32;
            t * t * (3.0 - 2.0 * t)
        };
        let (i, j, s, t) = (x / cell, y / cell, blend(x), blend(y));
        let row = |j: u32| corner(i, j) + s * (corner(i + 1, j) - corner(i, j));
        row(j) + t * (row(j + 1) - row(j))
    };
    0.6 * octave(64) + 0.4 * octave(16)
}

/// sRGB bytes of linear colours.
fn write_colours(path: &Path, size: u32, colour: impl Fn(u32, u32) -> Vec3) -> Result<(), Error> {
    let encode = |value: f32| (255.0 * value.clamp(0.0, 1.0).powf(1.0 / 2.2) + 0.5) as u8;
    let refused = |message: String| Error::Asset { path: path.to_owned(), message };
    RgbImage::from_fn(size, size, |x, y| Rgb(colour(x, y).to_array().map(encode)))
        .save(path)
        .map_err(|error| refused(error.to_string()))
}
