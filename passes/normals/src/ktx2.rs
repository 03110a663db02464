//! Chains in KTX 2.0 files (Khronos, version 2.0.4), as asset pipelines and engines exchange textures: an array of BC5
//! layers, axis and then width and weight of each lobe, from level 1 of the map on.

use crate::NormalsError;
use crate::blocks::{self, BLOCK_BYTES};
use crate::cache::PackedChain;
use crate::chain::Level;

const IDENTIFIER: [u8; 12] = [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, b'\r', b'\n', 0x1a, b'\n'];
/// `VK_FORMAT_BC5_UNORM_BLOCK`.
const FORMAT: u32 = 141;
/// Bytes of header and index.
const HEADER: usize = 80;
/// Bytes of an entry of the index of levels.
const ENTRY: usize = 24;
/// `KHR_DF_MODEL_BC5`, no primaries, linear, no flags; blocks of 4 x 4 texels in 16 bytes.
const DESCRIPTION: [u8; 16] = [132, 0, 1, 0, 3, 3, 0, 0, BLOCK_BYTES as u8, 0, 0, 0, 0, 0, 0, 0];

/// Bytes of the blocks of each level, layer by layer.
///
/// # Errors
/// [`NormalsError::Chain`] for a chain that is not of these levels in [`Storage::Octahedral8`](crate::Storage::Octahedral8).
pub fn compressed(levels: &[Level], lobes: usize, chain: &PackedChain) -> Result<Vec<Vec<u8>>, NormalsError> {
    if levels.len() != chain.levels.len() {
        return Err(NormalsError::Chain);
    }
    let of_level = |(level, bytes): (&Level, &Vec<u8>)| {
        let texels = level.size[0] * level.size[1];
        let (packed, rest) = bytes.as_chunks::<4>();
        if packed.len() != texels * lobes || !rest.is_empty() {
            return Err(NormalsError::Chain);
        }
        let mut all = Vec::new();
        for lobe in packed.chunks(texels) {
            for pair in [0, 2] {
                let two: Vec<[u8; 2]> = lobe.iter().map(|four| [four[pair], four[pair + 1]]).collect();
                all.extend(blocks::encode(level.size[0], level.size[1], &two)?);
            }
        }
        Ok(all)
    };
    levels.iter().zip(&chain.levels).map(of_level).collect()
}

/// The file of compressed levels, finest first, of so many layers.
///
/// # Errors
/// [`NormalsError::Chain`] for no level.
pub fn file(size: [usize; 2], layers: usize, levels: &[Vec<u8>]) -> Result<Vec<u8>, NormalsError> {
    if levels.is_empty() {
        return Err(NormalsError::Chain);
    }
    let samples = [0_u16, 64].into_iter().zip(0_u8..).flat_map(sample);
    let basic: Vec<u8> = [[0; 4], 2_u32.to_le_bytes()].concat();
    let mut description: Vec<u8> = basic.into_iter().chain(DESCRIPTION).chain(samples).collect();
    let block_size = description.len() as u16;
    description[6..8].copy_from_slice(&block_size.to_le_bytes());
    let begin = HEADER + ENTRY * levels.len();
    let total = description.len() + 4;
    let numbers = [FORMAT, 1, size[0] as u32, size[1] as u32, 0, layers as u32, 1, levels.len() as u32, 0];
    let index = [begin as u32, total as u32, 0, 0, 0, 0, 0, 0];
    let mut bytes = IDENTIFIER.to_vec();
    bytes.extend(numbers.into_iter().chain(index).flat_map(u32::to_le_bytes));
    // Levels lie in the file from the coarsest to the finest.
    let mut offset = (begin + total).next_multiple_of(BLOCK_BYTES);
    let mut offsets = vec![0; levels.len()];
    for (place, level) in offsets.iter_mut().zip(levels).rev() {
        *place = offset;
        offset += level.len();
    }
    for (offset, level) in offsets.iter().zip(levels) {
        bytes.extend([*offset, level.len(), level.len()].into_iter().flat_map(|n| (n as u64).to_le_bytes()));
    }
    bytes.extend((total as u32).to_le_bytes());
    bytes.extend(description);
    bytes.resize(bytes.len().next_multiple_of(BLOCK_BYTES), 0);
    levels.iter().rev().for_each(|level| bytes.extend(level));
    Ok(bytes)
}

/// A channel of the description: where its 64 bits begin, which it is, from 0 to the largest number.
fn sample((offset, channel): (u16, u8)) -> impl Iterator<Item = u8> {
    let [low, high] = offset.to_le_bytes();
    let [lower, upper] = [0_u32, u32::MAX].map(u32::to_le_bytes);
    [[low, high, 63, channel], [0; 4], lower, upper].into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_where_the_index_says() {
        let levels = [vec![7_u8; 64], vec![9; 16]];
        let bytes = file([8, 8], 2, &levels).unwrap();
        let number = |at: usize| u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i])) as usize;
        for (i, level) in levels.iter().enumerate() {
            let (offset, length) = (number(HEADER + ENTRY * i), number(HEADER + ENTRY * i + 8));
            assert_eq!(&bytes[offset..offset + length], &level[..]);
            assert!(offset.is_multiple_of(BLOCK_BYTES));
        }
        let word = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
        let description = word(48) as usize;
        assert_eq!(word(description), word(52), "the description's size stands twice");
        assert_eq!(word(description) as usize, 4 + 24 + 2 * 16);
        assert_eq!((word(12), word(20), word(24), word(32), word(40)), (FORMAT, 8, 8, 2, 2));
        assert!(file([8, 8], 2, &[]).is_err());
    }
}
