//! Our FLIP against the authors' own implementation, and against values that follow from its definition.

use super::flip::{PIXELS_PER_DEGREE, flip};
use airglow_scene::{FloatImage, srgb_decode};

use super::picture;

/// A picture of smooth gradients, edges and single bright points; `shift` moves and tints it.
fn pattern(width: usize, height: usize, shift: usize) -> Vec<[u8; 3]> {
    let mut bytes = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let moved = x + shift;
            let square = (moved / 9 + y / 7).is_multiple_of(2);
            let point = moved % 23 == 5 && y % 19 == 3;
            let red = if point { 255 } else { (moved * 255 / (width + 8)).min(255) as u8 };
            let green = if square { 200 } else { (y * 200 / height) as u8 };
            let blue = if point { 255 } else { ((x * y) % 256 / (1 + shift)) as u8 };
            bytes.push([red, green, blue]);
        }
    }
    bytes
}

fn linear(width: usize, height: usize, bytes: &[[u8; 3]]) -> FloatImage {
    let pixels = bytes.iter().map(|p| p.map(|c| srgb_decode(f32::from(c) / 255.0))).collect();
    FloatImage { width, height, pixels }
}

fn authors(width: usize, height: usize, reference: &[[u8; 3]], test: &[[u8; 3]], ppd: f32) -> Vec<f32> {
    let image =
        |bytes: &[[u8; 3]]| nv_flip::FlipImageRgb8::with_data(width as u32, height as u32, &bytes.concat());
    nv_flip::flip(image(reference), image(test), ppd).to_vec()
}

#[test]
fn agrees_with_the_authors_implementation_pixel_by_pixel() {
    let (width, height) = (96, 64);
    let (reference, test) = (pattern(width, height, 0), pattern(width, height, 3));
    for ppd in [PIXELS_PER_DEGREE, 30.0] {
        let truth = authors(width, height, &reference, &test, ppd);
        let ours = flip(&linear(width, height, &reference), &linear(width, height, &test), ppd).unwrap();
        let worst = ours.iter().zip(&truth).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
        println!(
            "ppd {ppd}: mean {} (authors {}), worst pixel difference {worst}",
            mean(&ours),
            mean(&truth)
        );
        assert!(mean(&truth) > 0.05, "the pictures must differ for the test to mean anything");
        // The authors' f32 filters sum in another order and tabulate the colour transforms.
        assert!(worst < 2e-3, "worst pixel difference {worst}");
        assert!((mean(&ours) - mean(&truth)).abs() < 1e-4, "{} {}", mean(&ours), mean(&truth));
    }
}

#[test]
fn equal_pictures_differ_nowhere_and_black_from_white_everywhere() {
    let black = picture::from_fn(16, 16, |_, _| [0.0; 3]);
    let white = picture::map(&black, |_| [1.0; 3]);
    assert!(flip(&white, &white, PIXELS_PER_DEGREE).unwrap().iter().all(|&d| d == 0.0));
    let largest = flip(&black, &white, PIXELS_PER_DEGREE).unwrap();
    // Both are flat, so no feature adds: the redistributed HyAB distance of 100 in lightness alone.
    assert!(largest.iter().all(|&d| (0.9..1.0).contains(&d)), "{}", largest[0]);
}

#[test]
fn sizes_must_agree() {
    let small = picture::from_fn(2, 2, |_, _| [0.0; 3]);
    let wide = picture::from_fn(3, 2, |_, _| [0.0; 3]);
    assert!(flip(&small, &wide, PIXELS_PER_DEGREE).is_none());
}
