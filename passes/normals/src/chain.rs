//! Which levels a chain has, what each is fitted from, and what it takes: plain data.

use crate::NormalsError;
use crate::map::NormalMap;
use crate::settings::Settings;
use crate::storage::Storage;

/// Samples of a texel: each level is made from the finest that gives no more. llvmpipe ends all loops of an invocation
/// after 65535 turns together, without a word; each sample takes two a pass, and 4 per lobe while seeding.
const MOST_SAMPLES: usize = 400;
/// Steps of expectation and maximisation that stay within that with 6 lobes.
pub const MOST_ITERATIONS: usize = 32;
/// Numbers of lobes that there are kernels for, most first.
const LOBES: [usize; 4] = [6, 4, 2, 1];
/// Bytes of a normal or lobe in f32.
pub(crate) const VECTOR: u64 = 16;

/// A level of mixtures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// Its number, from 1: level 0 is the map.
    pub level: usize,
    /// Columns and rows.
    pub size: [usize; 2],
    /// The level its samples come from: 0 for normals.
    pub source: usize,
    /// What it takes in a texture, bytes.
    pub bytes: u64,
}

/// The levels of a map, finest first.
///
/// # Errors
/// [`NormalsError::Budget`] where they take more than the settings allow, with the most that does fit.
pub fn levels(map: &NormalMap, settings: &Settings) -> Result<Vec<Level>, NormalsError> {
    settings.check()?;
    let (lobes, lobe_bytes) = (settings.fit.lobes as u64, settings.storage.lobe_bytes());
    let texels = |level| map.size(level).iter().map(|&size| size as u64).product::<u64>();
    let of = |level| Level {
        level,
        size: map.size(level),
        source: source(map, level, settings.fit.lobes),
        bytes: texels(level) * lobes * lobe_bytes,
    };
    let levels: Vec<Level> = (1..map.levels()).map(of).collect();
    let bytes: u64 = levels.iter().map(|level| level.bytes).sum();
    let budget = settings.budget(map.normals().len());
    if bytes > budget {
        let texels: u64 = (1..map.levels()).map(texels).sum();
        let mend = fitting(budget, |lobes, storage| texels * lobes as u64 * storage.lobe_bytes());
        return Err(NormalsError::Budget { bytes, budget, mend });
    }
    Ok(levels)
}

/// Bytes that a build takes while it runs: the map's normals and the lobes in f32, the lobes packed, the texture.
fn build_bytes(map: &NormalMap, texels: u64, lobes: usize, storage: Storage) -> u64 {
    VECTOR * map.normals().len() as u64 + texels * lobes as u64 * (VECTOR + 2 * storage.lobe_bytes())
}

/// Refuses a build that `left` bytes of the host's budget have no room for.
///
/// # Errors
/// [`NormalsError::Budget`], with the most that does fit.
pub(crate) fn check_build(
    map: &NormalMap,
    settings: &Settings,
    left: Option<u64>,
) -> Result<(), NormalsError> {
    let texels = |level| map.size(level).iter().map(|&size| size as u64).product::<u64>();
    let texels: u64 = (1..map.levels()).map(texels).sum();
    let bytes = build_bytes(map, texels, settings.fit.lobes, settings.storage);
    let Some(budget) = left.filter(|left| bytes > *left) else { return Ok(()) };
    let mend = fitting(budget, |lobes, storage| build_bytes(map, texels, lobes, storage));
    Err(NormalsError::Budget { bytes, budget, mend })
}

/// The most that a budget holds, in words, where lobes so kept take `bytes`.
fn fitting(budget: u64, bytes: impl Fn(usize, Storage) -> u64) -> String {
    let choices = LOBES.into_iter().flat_map(|lobes| Storage::ALL.map(|storage| (lobes, storage)));
    let fitting = choices.filter(|&(lobes, storage)| bytes(lobes, storage) <= budget);
    // Of two that take the same the later: fewer lobes, finer numbers.
    match fitting.max_by_key(|&(lobes, storage)| bytes(lobes, storage)) {
        Some((lobes, storage)) => format!("set the lobes to {lobes} and the storage to {storage:?}"),
        None => {
            format!(
                "give {} bytes for 1 lobe in Storage::Octahedral8, or a smaller map",
                bytes(1, Storage::Octahedral8)
            )
        }
    }
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
        let wide = Settings { budget: Some(u64::MAX), ..Settings::default() };
        let found = levels(&map, &wide).unwrap();
        let sizes: Vec<_> = found.iter().map(|level| (level.size, level.source)).collect();
        let expected =
            [([100, 1], 0), ([50, 1], 0), ([25, 1], 0), ([12, 1], 0), ([6, 1], 0), ([3, 1], 0), ([1, 1], 0)];
        assert_eq!(sizes, expected);
        let bytes: u64 = found.iter().map(|level| level.bytes).sum();
        assert_eq!(bytes, 197 * 4 * 8);
        let within = |budget| levels(&map, &Settings { budget: Some(budget), ..Settings::default() });
        assert!(within(bytes).is_ok());
        let error = within(bytes - 1).unwrap_err().to_string();
        assert!(error.contains(&bytes.to_string()), "{error}");
        assert!(error.contains("lobes to 6 and the storage to Octahedral8"), "{error}");
        let error = within(197 * 16).unwrap_err().to_string();
        assert!(error.contains("lobes to 2 and the storage to F16"), "{error}");
        let error = within(100).unwrap_err().to_string();
        assert!(error.contains("788 bytes for 1 lobe"), "{error}");
        let square = NormalMap::from_vectors(128, 128, &[[0.0, 0.0, 1.0]; 128 * 128]).unwrap();
        let sources: Vec<_> = levels(&square, &wide).unwrap().iter().map(|level| level.source).collect();
        assert_eq!(sources, [0, 0, 0, 0, 2, 3, 4]);
        let taken = build_bytes(&square, 5461, 4, Storage::F16);
        assert_eq!(taken, 16 * 128 * 128 + 5461 * 4 * 32);
        assert!(
            check_build(&square, &wide, Some(taken)).is_ok() && check_build(&square, &wide, None).is_ok()
        );
        let error = check_build(&square, &wide, Some(taken - 1)).unwrap_err().to_string();
        assert!(error.contains("lobes to 4 and the storage to Octahedral8"), "{error}");
        let single = NormalMap::from_vectors(1, 1, &[[0.0, 0.0, 1.0]]).unwrap();
        assert_eq!(levels(&single, &wide).unwrap(), []);
    }
}
