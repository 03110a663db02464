//! A linear octree of spheres: which of them hold a point.
//!
//! Sun 2005, section 3.3.5. A cell is named by its location code: three bits a level below a leading one, the sentinel,
//! which tells levels apart. Instead of a hash table the codes lie sorted in one array, which a device can search.

use glam::{DVec3, UVec3};

/// Levels below the root: with the sentinel, 31 bits.
pub const LEVELS: u32 = 10;

/// Spheres by the cells they meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Octree {
    low: DVec3,
    side: f64,
    /// Location code of a cell and number of a sphere that meets it, sorted.
    entries: Vec<(u32, u32)>,
    /// Whether any sphere lies at a level.
    occupied: [bool; LEVELS as usize + 1],
}

impl Octree {
    /// Takes in spheres of centre and radius, finite, radius zero or more.
    #[must_use]
    pub fn new(spheres: &[(DVec3, f64)]) -> Self {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (centre, radius) in spheres {
            (low, high) = (low.min(*centre - *radius), high.max(*centre + *radius));
        }
        let side = if spheres.is_empty() { 0.0 } else { (high - low).max_element() };
        let mut tree = Self { low, side, entries: Vec::new(), occupied: [false; LEVELS as usize + 1] };
        for (number, (centre, radius)) in spheres.iter().enumerate() {
            tree.insert(number as u32, *centre, *radius);
        }
        tree.entries.sort_unstable();
        tree
    }

    /// Calls `visit` with the number of each sphere whose cell holds `point`: all that hold the point, and some more.
    pub fn near(&self, point: DVec3, mut visit: impl FnMut(usize)) {
        let finest = code(self.cell(point, LEVELS), LEVELS);
        for level in (0..=LEVELS).filter(|level| self.occupied[*level as usize]) {
            // Three bits fewer name the cell one level up.
            let code = finest >> (3 * (LEVELS - level));
            let begin = self.entries.partition_point(|entry| entry.0 < code);
            let cell = self.entries[begin..].iter().take_while(|entry| entry.0 == code);
            cell.for_each(|(_, number)| visit(*number as usize));
        }
    }

    /// Number of (cell, sphere) pairs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether it holds no sphere.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Puts a sphere into the cells it meets at the level whose cells are two to four radii wide: eight at most, but
    /// for rounding.
    fn insert(&mut self, number: u32, centre: DVec3, radius: f64) {
        let level = (self.side / radius).log2().floor() - 1.0; // infinite for a point, NaN if all is one point
        let level = if level.is_nan() { 0 } else { level.clamp(0.0, f64::from(LEVELS)) as u32 };
        let (first, last) = (self.cell(centre - radius, level), self.cell(centre + radius, level));
        for z in first.z..=last.z {
            for y in first.y..=last.y {
                for x in first.x..=last.x {
                    self.entries.push((code(UVec3::new(x, y, z), level), number));
                }
            }
        }
        self.occupied[level as usize] = true;
    }

    /// The cell of a level that holds a point; the nearest one for a point outside.
    fn cell(&self, point: DVec3, level: u32) -> UVec3 {
        let cells = f64::from(1_u32 << level);
        // Cells of a coarser level must be those of the finest, shifted, so all are found by the finest.
        let finest = f64::from(1_u32 << LEVELS);
        let place = (point - self.low) / self.side * finest;
        let index = |x: f64| (x.max(0.0) as u32).min((1 << LEVELS) - 1) >> (LEVELS - level);
        debug_assert!(cells >= 1.0);
        UVec3::new(index(place.x), index(place.y), index(place.z))
    }
}

/// The location code: the sentinel, then the bits of z, y and x, level by level.
fn code(cell: UVec3, level: u32) -> u32 {
    (0..level).rev().fold(1, |code, bit| {
        let [x, y, z] = cell.to_array().map(|index| index >> bit & 1);
        code << 3 | z << 2 | y << 1 | x
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn codes_carry_a_sentinel() {
        assert_eq!(code(UVec3::ZERO, 0), 0b1);
        assert_eq!(code(UVec3::ZERO, 1), 0b1000);
        assert_eq!(code(UVec3::ZERO, 2), 0b100_0000);
        assert_eq!(code(UVec3::new(3, 1, 2), 2), 0b1_101_011);
        assert_eq!(code(UVec3::splat(1023), LEVELS), u32::MAX >> 1);
    }

    fn vector() -> impl Strategy<Value = DVec3> {
        (-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        /// Every sphere that holds a point is visited once, and no cell lists too many of the small ones.
        #[test]
        fn finds_what_holds_a_point(
            spheres in proptest::collection::vec((vector(), 1e-4..2.0_f64), 1..60), points in proptest::collection::vec(vector(), 20)
        ) {
            let tree = Octree::new(&spheres);
            prop_assert!(tree.len() <= 8 * spheres.len());
            let inside = spheres.iter().map(|(centre, radius)| *centre + 0.5 * *radius);
            for point in points.into_iter().chain(inside) {
                let mut found = Vec::new();
                tree.near(point, |number| found.push(number));
                found.sort_unstable();
                let unique = found.len();
                found.dedup();
                prop_assert_eq!(found.len(), unique);
                for (number, (centre, radius)) in spheres.iter().enumerate() {
                    prop_assert!(centre.distance(point) > *radius || found.contains(&number), "{point} {centre} {radius}");
                }
            }
        }
    }

    #[test]
    fn points_are_spheres_and_nothing_is_found_in_nothing() {
        let mut found = Vec::new();
        Octree::new(&[(DVec3::ONE, 0.0), (DVec3::ONE, 0.0)]).near(DVec3::ONE, |number| found.push(number));
        assert_eq!(found, [0, 1]);
        Octree::new(&[]).near(DVec3::ONE, |_| panic!("a sphere in an empty tree"));
    }
}
