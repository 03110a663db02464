//! Projection of whole equirectangular images, constant on each texel, into spherical harmonics.

use super::EquirectBasis;
use crate::MathError;
use crate::error::check_length;
use crate::sh::coefficient_count;

/// Projects RGB images of one size; make it once for many images.
#[derive(Clone, Debug, PartialEq)]
pub struct Projector {
    basis: EquirectBasis,
}

impl Projector {
    /// Integrates the tables of a map of that size.
    ///
    /// # Errors
    /// As [`EquirectBasis::new`].
    pub fn new(order: usize, width: usize, height: usize) -> Result<Self, MathError> {
        Ok(Self { basis: EquirectBasis::new(order, width, height)? })
    }

    /// The tables, for upload to a GPU.
    #[must_use]
    pub fn basis(&self) -> &EquirectBasis {
        &self.basis
    }

    /// Coefficients of the function that is constant on each texel: `order²` of RGB, in the texels' unit
    /// (times steradians to the one half). `texels` is row-major, the first row up. Sums in f64.
    ///
    /// # Errors
    /// [`MathError::Length`] unless there are `width * height` texels; [`MathError::NonFiniteTexels`], with
    /// their count.
    pub fn project(&self, texels: &[[f32; 3]]) -> Result<Vec<[f64; 3]>, MathError> {
        let basis = &self.basis;
        check_length("the image", basis.width() * basis.height(), texels.len())?;
        check_finite(texels, basis.width())?;
        let mut map_frame = vec![[0.0; 3]; coefficient_count(basis.order())];
        let mut fourier = vec![[0.0; 3]; basis.column_stride()];
        let rows = basis.rows().chunks_exact(basis.row_stride());
        for (image_row, row) in texels.chunks_exact(basis.width()).zip(rows) {
            fourier.fill([0.0; 3]);
            let columns = basis.columns().chunks_exact(basis.column_stride());
            for (texel, column) in image_row.iter().zip(columns) {
                for (sum, factor) in fourier.iter_mut().zip(column) {
                    add_scaled(sum, *factor, texel.map(f64::from));
                }
            }
            basis.for_each_harmonic(|i, row_at, column_at| {
                add_scaled(&mut map_frame[i], row[row_at], fourier[column_at]);
            });
        }
        basis.to_convention().apply_rgb(&map_frame)
    }
}

fn add_scaled(sum: &mut [f64; 3], factor: f64, value: [f64; 3]) {
    for (s, v) in sum.iter_mut().zip(value) {
        *s += factor * v;
    }
}

fn check_finite(texels: &[[f32; 3]], width: usize) -> Result<(), MathError> {
    let mut bad = texels.iter().enumerate().filter(|(_, rgb)| !rgb.iter().all(|c| c.is_finite()));
    match bad.next() {
        None => Ok(()),
        Some((first, _)) => {
            let count = 1 + bad.count();
            Err(MathError::NonFiniteTexels { count, column: first % width, row: first / width })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sh::reconstruct;
    use crate::sphere::equirect::direction;
    use crate::testing::{assert_all_close, assert_close};
    use std::f64::consts::PI;

    fn channel(coefficients: &[[f64; 3]], c: usize) -> Vec<f64> {
        coefficients.iter().map(|rgb| rgb[c]).collect()
    }

    #[test]
    fn a_constant_image_is_its_mean_in_every_size() {
        for (width, height) in [(1, 1), (1, 8192), (8192, 1), (6, 5)] {
            let texels = vec![[1.0, 2.0, 0.5]; width * height];
            let actual = Projector::new(8, width, height).unwrap().project(&texels).unwrap();
            for (c, value) in [1.0, 2.0, 0.5].into_iter().enumerate() {
                let mut expected = vec![0.0; 64];
                expected[0] = value * (4.0 * PI).sqrt();
                assert_all_close(&format!("{width} x {height}"), &channel(&actual, c), &expected, 1e-12);
            }
        }
    }

    /// One bright texel: its coefficients are the texel's integrals, at the pole, the seam and elsewhere.
    #[test]
    fn one_texel_gives_its_integrals() {
        let (width, height) = (16, 8);
        let projector = Projector::new(6, width, height).unwrap();
        for (column, row) in [(0, 0), (15, 4), (0, 4), (9, 3), (4, 7)] {
            let mut texels = vec![[0.0; 3]; width * height];
            texels[row * width + column] = [1e5, 0.0, 1.0];
            let actual = projector.project(&texels).unwrap();
            let expected = projector.basis().texel(column, row).unwrap();
            assert_all_close("blue", &channel(&actual, 2), &expected, 1e-15);
            let scaled: Vec<f64> = expected.iter().map(|v| 1e5 * v).collect();
            assert_all_close("red", &channel(&actual, 0), &scaled, 1e-10);
        }
    }

    /// A smooth sky comes back where it was painted: catches every flip and swap of axes.
    #[test]
    fn reconstruction_shows_the_image_the_right_way_round() {
        let (width, height) = (256, 128);
        let sky = |d: glam::DVec3| 2.0 + d.x + 0.5 * d.y * d.z - 0.3 * d.z;
        let texels: Vec<[f32; 3]> = (0..width * height)
            .map(|i| {
                let (u, v) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
                [sky(direction(u / width as f64, v / height as f64)) as f32; 3]
            })
            .collect();
        let projected = channel(&Projector::new(4, width, height).unwrap().project(&texels).unwrap(), 1);
        for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.75, 0.4), (0.3, 0.9), (0.99, 0.01)] {
            let d = direction(u, v);
            assert_close("sky", reconstruct(4, &projected, d).unwrap(), sky(d), 1e-3);
        }
    }

    #[test]
    fn refuses_nan_with_a_count_and_wrong_lengths() {
        let projector = Projector::new(2, 4, 2).unwrap();
        let mut texels = vec![[1.0; 3]; 8];
        texels[6][1] = f32::NAN;
        texels[7][0] = f32::INFINITY;
        let expected = MathError::NonFiniteTexels { count: 2, column: 2, row: 1 };
        assert_eq!(projector.project(&texels), Err(expected));
        assert!(matches!(projector.project(&texels[1..]), Err(MathError::Length { .. })));
    }
}
