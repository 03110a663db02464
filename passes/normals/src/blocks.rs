//! Octahedral lobes as block-compressed textures, which an asset pipeline makes ahead: two BC5 layers a lobe, axis and then
//! width and weight, 2 bytes a lobe and texel.
//!
//! A block of 4 x 4 texels has for each channel two ends and, for each texel, one of eight steps between them (Khronos Data
//! Format Specification 1.3, section 19.1). The ends are those of the values, moved by least squares of the steps chosen.

use crate::NormalsError;

/// Texels along each side of a block.
pub const SIDE: usize = 4;
/// Bytes of a block of two channels.
pub const BLOCK_BYTES: usize = 16;
/// Steps between the ends, both of them counted.
const STEPS: usize = 8;

/// The blocks of a layer of two channels, row by row; at the borders the last texels are repeated.
///
/// # Errors
/// [`NormalsError::Size`] unless there are `width * height` texels.
pub fn encode(width: usize, height: usize, texels: &[[u8; 2]]) -> Result<Vec<u8>, NormalsError> {
    if width == 0 || height == 0 || texels.len() != width.saturating_mul(height) {
        let mend = "give width times height texels, at least one";
        return Err(NormalsError::Size { width, height, texels: texels.len(), mend });
    }
    let mut bytes = Vec::with_capacity(width.div_ceil(SIDE) * height.div_ceil(SIDE) * BLOCK_BYTES);
    for y in (0..height).step_by(SIDE) {
        for x in (0..width).step_by(SIDE) {
            let texel = |i: usize| {
                let (column, row) = ((x + i % SIDE).min(width - 1), (y + i / SIDE).min(height - 1));
                texels[row * width + column]
            };
            for channel in 0..2 {
                bytes.extend(channel_block(&std::array::from_fn(|i| texel(i)[channel])));
            }
        }
    }
    Ok(bytes)
}

/// The texels that hardware reads of such blocks.
///
/// # Errors
/// [`NormalsError::Size`] unless the blocks are those of `width * height` texels.
pub fn decode(width: usize, height: usize, blocks: &[u8]) -> Result<Vec<[f64; 2]>, NormalsError> {
    let columns = width.div_ceil(SIDE);
    if blocks.len() != columns * height.div_ceil(SIDE) * BLOCK_BYTES {
        let mend = "give the blocks of its texels";
        return Err(NormalsError::Size { width, height, texels: blocks.len(), mend });
    }
    let texel = |at: usize| {
        let (x, y) = (at % width, at / width);
        let block = &blocks[(y / SIDE * columns + x / SIDE) * BLOCK_BYTES..][..BLOCK_BYTES];
        let within = y % SIDE * SIDE + x % SIDE;
        [0, 1].map(|channel| value(&block[channel * BLOCK_BYTES / 2..], within))
    };
    Ok((0..width * height).map(texel).collect())
}

/// The value of a texel of a channel's block, 0 to 1.
fn value(block: &[u8], texel: usize) -> f64 {
    let bits = block[2..8].iter().rev().fold(0_u64, |bits, &byte| bits << 8 | u64::from(byte));
    let index = (bits >> (3 * texel) & 7) as usize;
    let ends = [block[0], block[1]].map(|end| f64::from(end) / 255.0);
    if block[0] > block[1] {
        return ends[0] + (ends[1] - ends[0]) * step_of(index) / (STEPS - 1) as f64;
    }
    match index {
        6 => 0.0,
        7 => 1.0,
        _ => ends[0] + (ends[1] - ends[0]) * [0.0, 5.0, 1.0, 2.0, 3.0, 4.0][index] / 5.0,
    }
}

/// How many steps from the first end the code lies: 0 and 1 are the ends themselves.
fn step_of(index: usize) -> f64 {
    [0, 7, 1, 2, 3, 4, 5, 6][index] as f64
}

/// One channel in eight bytes: the larger end, the smaller, three bits a texel.
fn channel_block(values: &[u8; SIDE * SIDE]) -> [u8; BLOCK_BYTES / 2] {
    let (low, high) = values.iter().fold((u8::MAX, 0), |(low, high), &v| (low.min(v), high.max(v)));
    let mut block = [high, low, 0, 0, 0, 0, 0, 0];
    if high == low {
        return block;
    }
    let first = steps(values, [high, low]);
    let ends = fitted(values, &first).filter(|[high, low]| high > low);
    let moved = ends.map(|ends| (ends, steps(values, ends)));
    let error = |ends: [u8; 2], steps: &[u8; SIDE * SIDE]| -> f64 {
        let squared = |(value, step): (&u8, &u8)| (f64::from(*value) - between(ends, *step)).powi(2);
        values.iter().zip(steps).map(squared).sum()
    };
    let (ends, steps) = moved
        .filter(|(ends, steps)| error(*ends, steps) < error([high, low], &first))
        .unwrap_or(([high, low], first));
    block[..2].copy_from_slice(&ends);
    let code = |step: u8| {
        if step == 0 {
            0
        } else if step == 7 {
            1
        } else {
            u64::from(step) + 1
        }
    };
    let bits = (0..).zip(steps).fold(0_u64, |bits, (at, step)| bits | code(step) << (3 * at));
    block[2..].copy_from_slice(&bits.to_le_bytes()[..6]);
    block
}

/// What a step between two ends is.
fn between([high, low]: [u8; 2], step: u8) -> f64 {
    f64::from(high) + (f64::from(low) - f64::from(high)) * f64::from(step) / (STEPS - 1) as f64
}

/// The nearest step of each value.
fn steps(values: &[u8; SIDE * SIDE], [high, low]: [u8; 2]) -> [u8; SIDE * SIDE] {
    let span = f64::from(high) - f64::from(low);
    values.map(|value| ((f64::from(high) - f64::from(value)) / span * 7.0).round().clamp(0.0, 7.0) as u8)
}

/// The ends of least squares for steps that are kept; none where all steps are the same.
fn fitted(values: &[u8; SIDE * SIDE], steps: &[u8; SIDE * SIDE]) -> Option<[u8; 2]> {
    let [mut aa, mut ab, mut bb, mut av, mut bv] = [0.0; 5];
    for (value, step) in values.iter().zip(steps) {
        let b = f64::from(*step) / (STEPS - 1) as f64;
        let (a, value) = (1.0 - b, f64::from(*value));
        (aa, ab, bb, av, bv) = (aa + a * a, ab + a * b, bb + b * b, av + a * value, bv + b * value);
    }
    let determinant = aa * bb - ab * ab;
    let end = |value: f64| (value / determinant).round().clamp(0.0, 255.0) as u8;
    (determinant > 1e-6).then(|| [end(av * bb - bv * ab), end(bv * aa - av * ab)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_hold_ramps_and_flats() {
        let texels: Vec<[u8; 2]> = (0..6 * 5).map(|at| [10 + 7 * (at % 6) as u8, 200]).collect();
        let blocks = encode(6, 5, &texels).unwrap();
        assert_eq!(blocks.len(), 4 * BLOCK_BYTES);
        for (found, texel) in decode(6, 5, &blocks).unwrap().iter().zip(&texels) {
            let expected = texel.map(|value| f64::from(value) / 255.0);
            let error = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
            assert!(error < 2.5 / 255.0, "{found:?} is not {expected:?}");
        }
        assert!(
            encode(6, 5, &texels[1..]).is_err() && encode(0, 5, &[]).is_err() && decode(6, 5, &[]).is_err()
        );
        // The mode of six steps, which this encoder never writes, as hardware reads it.
        assert_eq!(value(&[0, 255, 0b111_110, 0, 0, 0, 0, 0], 0), 0.0);
        assert_eq!(value(&[0, 255, 0b111_110, 0, 0, 0, 0, 0], 1), 1.0);
    }
}
