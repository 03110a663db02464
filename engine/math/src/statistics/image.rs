//! Errors of images in the L2 norm and in the Sobolev norm H1, which weighs displaced edges.
//!
//! Ng, Ramamoorthi, Hanrahan, "All-Frequency Shadows Using Non-linear Wavelet Lighting Approximation" (2003),
//! section 4.1.2: `|f|_H1 = (∫ f² + |grad f|²)^(1/2)`, where the relative H1 error is reported with the L2
//! energy subtracted.

use super::norms::relative;
use crate::MathError;
use crate::error::check_length;

/// Errors of an image against the true one. Lengths are in texels: one texel has area 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageError {
    /// L2 norm of the difference.
    pub l2: f64,
    /// The same over the L2 norm of the truth.
    pub relative_l2: f64,
    /// H1 norm of the difference, its L2 energy included.
    pub h1: f64,
    /// L2 norm of the difference's gradient over that of the truth's gradient: H1 without the L2 energy.
    pub relative_h1: f64,
}

/// Compares row-major images of `width` columns, summed over their channels; the gradient is the difference
/// to the next texel right and below, and the last column and row have none in that direction. Relative errors
/// are 0 for equal images and infinite for a truth of norm zero.
///
/// # Errors
/// [`MathError::Length`] unless both hold `width * height` texels.
pub fn h1_image<const CHANNELS: usize>(
    values: &[[f32; CHANNELS]],
    truth: &[[f32; CHANNELS]],
    width: usize,
    height: usize,
) -> Result<ImageError, MathError> {
    let count = width.saturating_mul(height);
    check_length("the image", count, values.len())?;
    check_length("the true image", count, truth.len())?;
    let difference =
        energies(width, height, |i, c| f64::from(values[i][c]) - f64::from(truth[i][c]), CHANNELS);
    let reference = energies(width, height, |i, c| f64::from(truth[i][c]), CHANNELS);
    let l2 = difference.value.sqrt();
    Ok(ImageError {
        l2,
        relative_l2: relative(l2, reference.value.sqrt()),
        h1: (difference.value + difference.gradient).sqrt(),
        relative_h1: relative(difference.gradient.sqrt(), reference.gradient.sqrt()),
    })
}

/// Sums of f² and of |grad f|².
struct Energies {
    value: f64,
    gradient: f64,
}

fn energies(width: usize, height: usize, f: impl Fn(usize, usize) -> f64, channels: usize) -> Energies {
    let (mut value, mut gradient) = (0.0, 0.0);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let i = y * width + x;
        for c in 0..channels {
            let here = f(i, c);
            value += here * here;
            if x + 1 < width {
                gradient += (f(i + 1, c) - here).powi(2);
            }
            if y + 1 < height {
                gradient += (f(i + width, c) - here).powi(2);
            }
        }
    }
    Energies { value, gradient }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_close;

    /// A ramp of slope a and b has gradient energy a² and b² per pair of neighbours.
    #[test]
    fn a_ramp_has_its_slope() {
        let ramp: Vec<[f32; 1]> = (0..12).map(|i| [(2 * (i % 4) + 3 * (i / 4)) as f32]).collect();
        let flat = vec![[1.0]; 12];
        let error = h1_image(&ramp, &flat, 4, 3).unwrap();
        let squares: f64 = ramp.iter().map(|v| (f64::from(v[0]) - 1.0).powi(2)).sum();
        let slopes = f64::from(3 * 3 * 4 + 4 * 2 * 9);
        assert_close("L2", error.l2, squares.sqrt(), 1e-12);
        assert_close("H1", error.h1, (squares + slopes).sqrt(), 1e-12);
        assert_close("relative L2", error.relative_l2, (squares / 12.0).sqrt(), 1e-12);
        assert_eq!(error.relative_h1, f64::INFINITY);
    }

    #[test]
    fn a_constant_offset_has_no_gradient_error() {
        let truth: Vec<[f32; 3]> = (0..6).map(|i| [i as f32, 1.0, 0.0]).collect();
        let offset: Vec<[f32; 3]> = truth.iter().map(|rgb| rgb.map(|c| c + 0.5)).collect();
        let error = h1_image(&offset, &truth, 3, 2).unwrap();
        assert_close("H1", error.h1, (18.0_f64 * 0.25).sqrt(), 1e-12);
        assert_close("relative H1", error.relative_h1, 0.0, 0.0);
    }

    #[test]
    fn a_halved_image_is_half_wrong() {
        let truth: Vec<[f32; 1]> = (0..25).map(|i| [(i * i % 7) as f32]).collect();
        let half: Vec<[f32; 1]> = truth.iter().map(|v| [0.5 * v[0]]).collect();
        let error = h1_image(&half, &truth, 5, 5).unwrap();
        assert_close("relative L2", error.relative_l2, 0.5, 1e-15);
        assert_close("relative H1", error.relative_h1, 0.5, 1e-15);
    }

    #[test]
    fn empty_and_single_texels_work_and_sizes_must_fit() {
        assert_eq!(h1_image::<3>(&[], &[], 0, 0).unwrap().h1, 0.0);
        assert_eq!(h1_image(&[[2.0]], &[[1.0]], 1, 1).unwrap().h1, 1.0);
        assert!(matches!(h1_image(&[[2.0]], &[[1.0]], 2, 1), Err(MathError::Length { .. })));
        assert!(matches!(h1_image::<1>(&[], &[], usize::MAX, 2), Err(MathError::Length { .. })));
    }
}
