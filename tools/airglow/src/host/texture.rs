//! Textures with smaller copies of themselves, so that distant surfaces do not shimmer.

use airglow_scene::{Encoding, Image, srgb_decode, srgb_encode};

/// All levels from the image itself down to one texel, 8-bit RGBA, encoded as the image is.
pub fn mip_levels(image: &Image) -> Vec<(u32, u32, Vec<[u8; 4]>)> {
    let mut levels = vec![(image.width, image.height, image.pixels.clone())];
    while let Some((width, height, pixels)) = levels.last()
        && (*width > 1 || *height > 1)
    {
        let smaller = halved(*width as usize, *height as usize, pixels, image.encoding);
        levels.push(((width / 2).max(1), (height / 2).max(1), smaller));
    }
    levels
}

/// Averages two by two texels of light, not of code values; an odd last row or column is left out.
fn halved(width: usize, height: usize, pixels: &[[u8; 4]], encoding: Encoding) -> Vec<[u8; 4]> {
    let mut smaller = Vec::new();
    for y in 0..(height / 2).max(1) {
        for x in 0..(width / 2).max(1) {
            let columns = [2 * x, (2 * x + 1).min(width - 1)];
            let rows = [2 * y, (2 * y + 1).min(height - 1)];
            let mut sum = [0.0; 4];
            for texel in rows.into_iter().flat_map(|row| columns.map(|column| pixels[row * width + column])) {
                let linear = decode(texel, encoding);
                sum = [0, 1, 2, 3].map(|c| sum[c] + 0.25 * linear[c]);
            }
            smaller.push(encode(sum, encoding));
        }
    }
    smaller
}

fn decode(texel: [u8; 4], encoding: Encoding) -> [f32; 4] {
    let [r, g, b, a] = texel.map(|value| f32::from(value) / 255.0);
    match encoding {
        Encoding::Srgb => [srgb_decode(r), srgb_decode(g), srgb_decode(b), a],
        Encoding::Linear => [r, g, b, a],
    }
}

fn encode(linear: [f32; 4], encoding: Encoding) -> [u8; 4] {
    let [r, g, b, a] = linear;
    let values = match encoding {
        Encoding::Srgb => [srgb_encode(r), srgb_encode(g), srgb_encode(b), a],
        Encoding::Linear => linear,
    };
    values.map(|value| (255.0 * value).round().clamp(0.0, 255.0) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_halve_down_to_one_texel_and_keep_the_light() {
        // Half black, half white: the mean light is 0.5, which sRGB encodes as 188.
        let pixels = (0..8 * 3).map(|i| if i % 2 == 0 { [0, 0, 0, 255] } else { [255; 4] }).collect();
        let image = Image { name: String::new(), width: 8, height: 3, encoding: Encoding::Srgb, pixels };
        let levels = mip_levels(&image);
        let sizes: Vec<_> = levels.iter().map(|(width, height, _)| (*width, *height)).collect();
        assert_eq!(sizes, [(8, 3), (4, 1), (2, 1), (1, 1)]);
        for (width, height, pixels) in &levels[1..] {
            assert_eq!(pixels.len(), (width * height) as usize);
            assert!(pixels.iter().all(|&pixel| pixel == [188, 188, 188, 255]), "{pixels:?}");
        }
    }
}
