//! Tiles of the picture, and which lights each has: what is left out of a tile is below the bound in all of it.
//!
//! Lists are made on the host, where the bound is known in f64, and drawn as rows of an instance buffer: a lamp that
//! enters makes no dispatch, no barrier and no memory. Tiles come in the order of what they need, so that each kind is one
//! draw with a kernel of its own.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};

use crate::beam::{Beam, Region};
use crate::camera::Rays;
use crate::limits::MAX_LIGHTS;

/// Pixels along a side of a tile: a whole number of waves, and few enough tiles for the host to make lists of each frame.
pub const TILE: u32 = 64;

/// What the tiles of a draw need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// No light.
    Dark,
    /// Points that shine everywhere.
    Points,
    /// Cones, ranges and boxes, too.
    All,
}

/// In the order of their draws.
pub(crate) const KINDS: [Kind; 3] = [Kind::Dark, Kind::Points, Kind::All];

/// A tile: a row of the instance buffer of `tile.vert`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct TileConstants {
    /// Column and row.
    place: [u32; 2],
    /// A bit for each light, the lower 32 first.
    lights: [u32; 2],
}

/// Where each light of a frame may be seen, and which of them are more than points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Regions {
    pub regions: [Region; MAX_LIGHTS],
    pub count: usize,
    /// A bit for each light with a cone, a range or a box.
    pub featured: u64,
}

/// The tiles of a picture. Memory is taken once, for its size.
#[derive(Clone, Debug)]
pub(crate) struct Tiles {
    count: [u32; 2],
    /// Places from 0 to 1 along each side of a tile.
    side: [f64; 2],
    masks: Vec<u64>,
    rows: Vec<TileConstants>,
    ends: [u32; 3],
}

impl Tiles {
    /// Those of a picture of `size` pixels, without lights.
    pub fn new(size: [u32; 2]) -> Self {
        let count = size.map(|side| side.div_ceil(TILE).max(1));
        let number = count[0] as usize * count[1] as usize;
        let mut tiles = Self {
            count,
            side: size.map(|side| f64::from(TILE) / f64::from(side.max(1))),
            masks: vec![0; number],
            rows: Vec::with_capacity(number),
            ends: [0; 3],
        };
        tiles.sort(0);
        tiles
    }

    /// Gives each tile the lights that may be seen in it.
    pub fn fill(&mut self, rays: &Rays, parallel: bool, lights: &Regions) {
        let Self { count: [columns, _], side, masks, .. } = self;
        for (mask, i) in masks.iter_mut().zip(0_u32..) {
            let low = [f64::from(i % *columns) * side[0], f64::from(i / *columns) * side[1]];
            let beam = Beam::new(rays, parallel, low, [low[0] + side[0], low[1] + side[1]]);
            *mask = 0;
            for (bit, region) in lights.regions[..lights.count].iter().enumerate() {
                *mask |= u64::from(beam.meets(region)) << bit;
            }
        }
        self.sort(lights.featured);
    }

    /// The rows of all tiles, by kind.
    pub fn rows(&self) -> &[TileConstants] {
        &self.rows
    }

    /// Which rows are of a kind.
    pub fn of(&self, kind: Kind) -> Range<u32> {
        let first = if kind == Kind::Dark { 0 } else { self.ends[kind as usize - 1] };
        first..self.ends[kind as usize]
    }

    /// Pairs of a tile and a light that it has, and how many there could be with `lights`.
    pub fn pairs(&self, lights: u32) -> [u32; 2] {
        let pairs = self.masks.iter().map(|mask| mask.count_ones()).sum();
        [pairs, self.masks.len() as u32 * lights]
    }

    /// How many lights some tile has.
    pub fn present(&self) -> u32 {
        self.masks.iter().fold(0, |all, mask| all | mask).count_ones()
    }

    fn sort(&mut self, featured: u64) {
        self.rows.clear();
        let columns = self.count[0];
        for kind in KINDS {
            for (&mask, i) in self.masks.iter().zip(0_u32..) {
                let needed = match mask {
                    0 => Kind::Dark,
                    mask if mask & featured == 0 => Kind::Points,
                    _ => Kind::All,
                };
                if needed == kind {
                    let lights = [mask as u32, (mask >> 32) as u32];
                    self.rows.push(TileConstants { place: [i % columns, i / columns], lights });
                }
            }
            self.ends[kind as usize] = self.rows.len() as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::beam::Ball;
    use crate::reach::Reach;

    #[test]
    fn tiles_are_drawn_once_by_what_they_need() {
        let rays = Rays {
            start: [DVec3::ZERO; 3],
            direction: [DVec3::new(-1.0, 1.0, -1.0), 2.0 * DVec3::X, -2.0 * DVec3::Y],
        };
        let small = |x: f64| {
            let ball = Ball { center: DVec3::new(x, 0.0, -10.0), radius: 0.1 };
            Region::new(ball.center, Reach::Everywhere, [Some(ball), None, None], None)
        };
        let mut regions = [Region::default(); MAX_LIGHTS];
        regions[0] = small(-5.0);
        regions[40] = small(5.0);
        regions[1..40].fill(small(100.0));
        let mut tiles = Tiles::new([10 * TILE, 3 * TILE - 5]);
        tiles.fill(&rays, false, &Regions { regions, count: 41, featured: 1 << 40 });
        let rows = |kind| &tiles.rows()[tiles.of(kind).start as usize..tiles.of(kind).end as usize];
        let lights = |kind| rows(kind).iter().map(|row| row.lights).collect::<Vec<_>>();
        assert!(lights(Kind::Dark).iter().all(|lights| *lights == [0, 0]));
        assert!(!lights(Kind::Points).is_empty() && lights(Kind::Points).iter().all(|l| *l == [1, 0]));
        assert!(!lights(Kind::All).is_empty() && lights(Kind::All).iter().all(|l| *l == [0, 1 << 8]));
        let mut places: Vec<_> = tiles.rows().iter().map(|row| [row.place[1], row.place[0]]).collect();
        places.sort_unstable();
        assert_eq!(places, (0..30).map(|i| [i / 10, i % 10]).collect::<Vec<_>>());
        let pairs = (lights(Kind::Points).len() + lights(Kind::All).len()) as u32;
        assert_eq!(tiles.pairs(41), [pairs, 30 * 41]);
    }
}
