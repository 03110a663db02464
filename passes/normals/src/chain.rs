//! Which levels a chain has, what each is fitted from, and what it takes: plain data.

use crate::NormalsError;
use crate::fit::FitSettings;
use crate::map::NormalMap;

/// Samples of a texel: each level is made from the finest that gives no more. llvmpipe ends all loops of an invocation
/// after 65535 turns together, without a word; each sample takes two a pass, and 4 per lobe while seeding.
const MOST_SAMPLES: usize = 400;
/// Steps of expectation and maximisation that stay within that with 6 lobes.
pub const MOST_ITERATIONS: usize = 32;
/// Bytes of a lobe in f32.
const LOBE_BYTES: u64 = 16;

/// A level of mixtures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// Its number, from 1: level 0 is the map.
    pub level: usize,
    /// Columns and rows.
    pub size: [usize; 2],
    /// The level its samples come from: 0 for normals.
    pub source: usize,
    /// What it takes, bytes.
    pub bytes: u64,
}

/// The levels of a map, finest first.
///
/// # Errors
/// [`NormalsError::Budget`] where they take more than `budget` bytes, with the most lobes that fit.
pub fn levels(map: &NormalMap, fit: &FitSettings, budget: u64) -> Result<Vec<Level>, NormalsError> {
    fit.check()?;
    let texels = |level| map.size(level).iter().map(|&size| size as u64).product::<u64>();
    let of = |level| Level {
        level,
        size: map.size(level),
        source: source(map, level, fit.lobes),
        bytes: texels(level) * fit.lobes as u64 * LOBE_BYTES,
    };
    let levels: Vec<Level> = (1..map.levels()).map(of).collect();
    let bytes: u64 = levels.iter().map(|level| level.bytes).sum();
    if bytes > budget {
        let fitting = (budget / (bytes / fit.lobes as u64)) as usize;
        let mend = match fitting {
            0 => format!("give {} bytes for 1 lobe, or a smaller map", bytes / fit.lobes as u64),
            _ => format!("set the lobes to {fitting}"),
        };
        return Err(NormalsError::Budget { bytes, budget, mend });
    }
    Ok(levels)
}

/// The finest level that gives a texel of `level` at most [`MOST_SAMPLES`].
fn source(map: &NormalMap, level: usize, lobes: usize) -> usize {
    let fits = |&source: &usize| {
        let columns = |axis: usize| {
            let (fine, coarse) = (map.size(source)[axis], map.size(level)[axis]);
            fine / coarse + if fine.is_multiple_of(coarse) { 0 } else { 2 }
        };
        columns(0) * columns(1) * if source == 0 { 1 } else { lobes } <= MOST_SAMPLES
    };
    (0..level).find(fits).unwrap_or(level - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_made_from_levels_below_and_refused_past_the_budget() {
        let map = NormalMap::from_vectors(200, 1, &[[0.0, 0.0, 1.0]; 200]).unwrap();
        let fit = FitSettings::default();
        let found = levels(&map, &fit, u64::MAX).unwrap();
        let sizes: Vec<_> = found.iter().map(|level| (level.size, level.source)).collect();
        let expected =
            [([100, 1], 0), ([50, 1], 0), ([25, 1], 0), ([12, 1], 0), ([6, 1], 0), ([3, 1], 0), ([1, 1], 0)];
        assert_eq!(sizes, expected);
        let bytes: u64 = found.iter().map(|level| level.bytes).sum();
        assert_eq!(bytes, 197 * 64);
        assert!(levels(&map, &fit, bytes).is_ok());
        let error = levels(&map, &fit, bytes - 1).unwrap_err().to_string();
        assert!(error.contains("set the lobes to 3") && error.contains(&bytes.to_string()), "{error}");
        let error = levels(&map, &fit, 100).unwrap_err().to_string();
        assert!(error.contains("3152 bytes for 1 lobe"), "{error}");
        let square = NormalMap::from_vectors(128, 128, &[[0.0, 0.0, 1.0]; 128 * 128]).unwrap();
        let sources: Vec<_> =
            levels(&square, &fit, u64::MAX).unwrap().iter().map(|level| level.source).collect();
        assert_eq!(sources, [0, 0, 0, 0, 2, 3, 4]);
        let single = NormalMap::from_vectors(1, 1, &[[0.0, 0.0, 1.0]]).unwrap();
        assert_eq!(levels(&single, &fit, 0).unwrap(), []);
    }
}
