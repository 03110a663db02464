//! LDR-FLIP: the difference an observer sees when two images are alternated at the same place.
//!
//! Pontus Andersson, Jim Nilsson, Tomas Akenine-Möller, Magnus Oskarsson, Kalle Åström, Mark D. Fairchild:
//! "FLIP: A Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and
//! Interactive Techniques 3(2), 2020. Section numbers below are the paper's. The filters are Gaussians and
//! their derivatives, so all of them run as two one-dimensional passes with the border pixel repeated.

use std::sync::LazyLock;

use airglow_scene::FloatImage;

use super::picture;

/// The paper's default observer: 0.7 m from a display 0.7 m and 3840 pixels wide.
pub const PIXELS_PER_DEGREE: f32 = 67.020_64;

const COLOUR_EXPONENT: f32 = 0.7; // q_c, section 4.1.3
const COLOUR_BREAK: f32 = 0.4; // p_c
const COLOUR_BREAK_VALUE: f32 = 0.95; // p_t
const FEATURE_EXPONENT: f32 = 0.5; // q_f, section 4.2
const FEATURE_WIDTH: f32 = 0.082; // w, degrees of visual angle an edge covers

/// The two Gaussians (a, b) of each channel's contrast sensitivity, section 4.1.1.
const ACHROMATIC: [(f32, f32); 2] = [(1.0, 0.0047), (0.0, 1e-5)];
const RED_GREEN: [(f32, f32); 2] = [(1.0, 0.0053), (0.0, 1e-5)];
const BLUE_YELLOW: [(f32, f32); 2] = [(34.1, 0.04), (13.5, 0.025)];
const WIDEST: f32 = 0.04; // the largest b above: one radius serves all channels

/// The difference of each pixel, 0 (none seen) to 1, row by row. Both pictures hold *linear* colours in
/// [0, 1]; values outside are clamped. `None` if their sizes differ.
pub fn flip(reference: &FloatImage, test: &FloatImage, pixels_per_degree: f32) -> Option<Vec<f32>> {
    if reference.width != test.width || reference.height != test.height {
        return None;
    }
    let reference = picture::map(reference, opponent);
    let test = picture::map(test, opponent);
    let colour = colour_difference(&reference, &test, pixels_per_degree);
    let feature = feature_difference(&reference, &test, pixels_per_degree);
    Some(colour.iter().zip(&feature).map(|(&colour, &feature)| colour.powf(1.0 - feature)).collect())
}

/// Section 4.1: filter by what the eye resolves, then HyAB distance in Hunt-adjusted L*a*b*, redistributed.
fn colour_difference(reference: &FloatImage, test: &FloatImage, pixels_per_degree: f32) -> Vec<f32> {
    let perceived =
        |picture: &FloatImage| picture::map(&filter_by_sensitivity(picture, pixels_per_degree), perceptual);
    let (reference, test) = (perceived(reference), perceived(test));
    let green = perceptual(opponent([0.0, 1.0, 0.0]));
    let blue = perceptual(opponent([0.0, 0.0, 1.0]));
    let largest = hyab(green, blue).powf(COLOUR_EXPONENT);
    let break_point = COLOUR_BREAK * largest;
    let redistribute = |distance: f32| {
        if distance < break_point {
            COLOUR_BREAK_VALUE / break_point * distance
        } else {
            COLOUR_BREAK_VALUE
                + (distance - break_point) / (largest - break_point) * (1.0 - COLOUR_BREAK_VALUE)
        }
    };
    let pairs = reference.pixels.iter().zip(&test.pixels);
    pairs.map(|(&a, &b)| redistribute(hyab(a, b).powf(COLOUR_EXPONENT)).clamp(0.0, 1.0)).collect()
}

/// Section 4.2: the difference in strength of edges and points of the achromatic channel.
fn feature_difference(reference: &FloatImage, test: &FloatImage, pixels_per_degree: f32) -> Vec<f32> {
    let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let radius = (3.0 * deviation).ceil() as i32;
    let gaussian = |x: i32| (-(x * x) as f32 / (2.0 * deviation * deviation)).exp();
    let smooth = normalised(taps(radius, gaussian));
    let edge = signed_normalised(taps(radius, |x| -(x as f32) * gaussian(x)));
    let point =
        signed_normalised(taps(radius, |x| ((x * x) as f32 / (deviation * deviation) - 1.0) * gaussian(x)));
    let strength = |picture: &FloatImage, derivative: &[f32]| -> Vec<f32> {
        let achromatic = picture::map(picture, |p| [(p[0] + 16.0) / 116.0, 0.0, 0.0]);
        let across = filter(&achromatic, derivative, &smooth);
        let down = filter(&achromatic, &smooth, derivative);
        across.pixels.iter().zip(&down.pixels).map(|(a, b)| a[0].hypot(b[0])).collect()
    };
    let change = |kernel: &[f32]| -> Vec<f32> {
        let pairs = strength(reference, kernel).into_iter().zip(strength(test, kernel));
        pairs.map(|(a, b)| (a - b).abs()).collect()
    };
    let larger = change(&edge).into_iter().zip(change(&point)).map(|(edge, point)| edge.max(point));
    larger
        .map(|change| (std::f32::consts::FRAC_1_SQRT_2 * change).powf(FEATURE_EXPONENT).clamp(0.0, 1.0))
        .collect()
}

/// Section 4.1.1: each opponent channel convolved with its contrast sensitivity in space.
fn filter_by_sensitivity(picture: &FloatImage, pixels_per_degree: f32) -> FloatImage {
    let pi = std::f32::consts::PI;
    let radius = (3.0 * (WIDEST / (2.0 * pi * pi)).sqrt() * pixels_per_degree).ceil() as i32;
    let mut filtered = picture::from_fn(picture.width, picture.height, |_, _| [0.0; 3]);
    for (channel, gaussians) in [ACHROMATIC, RED_GREEN, BLUE_YELLOW].into_iter().enumerate() {
        let kernels = gaussians.map(|(a, b)| {
            let taps = taps(radius, |x| (-(pi * x as f32 / pixels_per_degree).powi(2) / b).exp());
            let sum: f32 = taps.iter().sum();
            (a * (pi / b).sqrt() * sum * sum, normalised(taps))
        });
        let total: f32 = kernels.iter().map(|(weight, _)| weight).sum();
        for (weight, kernel) in kernels.iter().filter(|(weight, _)| *weight > 0.0) {
            let only = picture::map(picture, |p| [p[channel], 0.0, 0.0]);
            let part = filter(&only, kernel, kernel);
            for (sum, value) in filtered.pixels.iter_mut().zip(&part.pixels) {
                sum[channel] += weight / total * value[0];
            }
        }
    }
    filtered
}

fn taps(radius: i32, value: impl Fn(i32) -> f32) -> Vec<f32> {
    (-radius..=radius).map(value).collect()
}

fn normalised(taps: Vec<f32>) -> Vec<f32> {
    let sum: f32 = taps.iter().sum();
    taps.into_iter().map(|tap| tap / sum).collect()
}

/// Positive taps sum to 1 and negative ones to -1, so that a perfect edge or point has strength 1.
fn signed_normalised(taps: Vec<f32>) -> Vec<f32> {
    let positive: f32 = taps.iter().filter(|tap| **tap > 0.0).sum();
    let negative: f32 = -taps.iter().filter(|tap| **tap < 0.0).sum::<f32>();
    taps.into_iter().map(|tap| if tap > 0.0 { tap / positive } else { tap / negative }).collect()
}

/// Correlates the first channel with `across` along rows and `down` along columns, border repeated.
fn filter(picture: &FloatImage, across: &[f32], down: &[f32]) -> FloatImage {
    let (width, height) = (picture.width, picture.height);
    let sum = |taps: &[f32], position: usize, last: usize, value: &dyn Fn(usize) -> f32| -> f32 {
        let radius = taps.len() / 2;
        let at = |tap: usize| (position + tap).saturating_sub(radius).min(last);
        taps.iter().enumerate().map(|(tap, weight)| weight * value(at(tap))).sum()
    };
    let rows = picture::from_fn(width, height, |x, y| {
        [sum(across, x, width - 1, &|x| picture.pixels[y * width + x][0]), 0.0, 0.0]
    });
    picture::from_fn(width, height, |x, y| {
        [sum(down, y, height - 1, &|y| rows.pixels[y * width + x][0]), 0.0, 0.0]
    })
}

/// XYZ of each linear Rec. 709 primary at full strength (chromaticities and D65 of the recommendation).
const TO_XYZ: [[f32; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// Rows and columns swap on the way into glam and back, and the inverse of a transpose is the transpose of
/// the inverse.
static FROM_XYZ: LazyLock<[[f32; 3]; 3]> =
    LazyLock::new(|| glam::Mat3::from_cols_array_2d(&TO_XYZ).inverse().to_cols_array_2d());

fn multiply(matrix: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|row| matrix[row][0] * v[0] + matrix[row][1] * v[1] + matrix[row][2] * v[2])
}

fn white() -> [f32; 3] {
    multiply(&TO_XYZ, [1.0; 3])
}

/// Linear Rec. 709 to the opponent space Y_y C_x C_z, section 4.1.1.
fn opponent(rgb: [f32; 3]) -> [f32; 3] {
    let (xyz, white) = (multiply(&TO_XYZ, rgb.map(|c| c.clamp(0.0, 1.0))), white());
    let [x, y, z] = [0, 1, 2].map(|i| xyz[i] / white[i]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Y_y C_x C_z through the display's gamut to L*a*b* with chroma weighted by lightness (Hunt), 4.1.2.
fn perceptual(opponent: [f32; 3]) -> [f32; 3] {
    let white = white();
    let y = (opponent[0] + 16.0) / 116.0;
    let xyz = [white[0] * (y + opponent[1] / 500.0), white[1] * y, white[2] * (y - opponent[2] / 200.0)];
    let shown = multiply(&FROM_XYZ, xyz).map(|c| c.clamp(0.0, 1.0));
    let xyz = multiply(&TO_XYZ, shown);
    let [x, y, z] = [0, 1, 2].map(|i| lightness(xyz[i] / white[i]));
    let l = 116.0 * y - 16.0;
    [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
}

/// The cube root of CIE 1976 with its linear foot.
fn lightness(t: f32) -> f32 {
    const DELTA: f32 = 6.0 / 29.0;
    if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
}

/// City-block in lightness plus Euclid in chroma: large differences stay in proportion, section 4.1.3.
fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}
