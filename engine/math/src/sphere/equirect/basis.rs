//! The spherical-harmonic basis integrated exactly over every texel of an equirectangular map.
//!
//! In the frame whose polar axis is the map's up axis a texel is a rectangle in (theta, phi), so the integral
//! splits into one number per row and one per column; a constant rotation then leads to the convention's
//! frame. Column integrals are closed forms; row integrals are Gauss-Legendre sums in theta whose order makes
//! them exact to rounding, because the integrand is a trigonometric polynomial of degree at most 8.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DQuat, DVec3};

use super::check_size;
use crate::MathError;
use crate::quadrature::gauss_legendre;
use crate::sh::rotation::Rotation;
use crate::sh::{check_order, coefficient_count, evaluate, index};

/// Points per row: more than enough for a map of one row, where the integrand turns four times.
const ROW_POINTS: usize = 24;

/// Separable tables of texel integrals, for the CPU and for upload to a GPU.
///
/// With `theta`, `phi` the map's angles, the **map frame** has its polar axis on +Y and its azimuth
/// `-phi` counted from -Z: a direction `d` of the convention has the map-frame components
/// `(-d.z, -d.x, d.y)`. The integral of map-frame harmonic (l, m) over texel (column, row) is
/// `row(row)[row_index(l, |m|)] * column(column)[order - 1 + m]`. Coefficients summed so are map-frame
/// coefficients; [`EquirectBasis::to_convention`] turns them into those of the convention.
#[derive(Clone, Debug, PartialEq)]
pub struct EquirectBasis {
    order: usize,
    width: usize,
    height: usize,
    rows: Vec<f64>,
    columns: Vec<f64>,
    to_convention: Rotation,
}

impl EquirectBasis {
    /// Integrates the tables of a map of that size.
    ///
    /// # Errors
    /// [`MathError::Order`]; [`MathError::Size`] unless both sides are 1 to [`super::MAX_SIDE`].
    pub fn new(order: usize, width: usize, height: usize) -> Result<Self, MathError> {
        check_order(order)?;
        check_size(width, height)?;
        let rows = row_table(order, height)?;
        let columns = column_table(order, width);
        let to_convention = Rotation::from_quaternion(order, map_frame())?;
        Ok(Self { order, width, height, rows, columns, to_convention })
    }

    /// The order given at creation.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// Columns of the map.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows of the map.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Values per row: `order (order + 1) / 2`, at [`row_index`](Self::row_index).
    #[must_use]
    pub fn row_stride(&self) -> usize {
        self.order * (self.order + 1) / 2
    }

    /// Values per column: `2 order - 1`, for m from `-(order - 1)` to `order - 1`.
    #[must_use]
    pub fn column_stride(&self) -> usize {
        2 * self.order - 1
    }

    /// Where in a row the value of band l and degree m >= 0 stands: `l(l+1)/2 + m`.
    #[must_use]
    pub const fn row_index(l: usize, m: usize) -> usize {
        l * (l + 1) / 2 + m
    }

    /// All rows, from the first (v = 0): integrals over theta of `sin theta` times the normalised Legendre
    /// function, sign and the real basis' sqrt(2) included.
    #[must_use]
    pub fn rows(&self) -> &[f64] {
        &self.rows
    }

    /// All columns, from the first (u = 0): for m >= 0 the integral over the column of `cos(m phi)`, for
    /// m < 0 that of `-sin(|m| phi)`, in radians.
    #[must_use]
    pub fn columns(&self) -> &[f64] {
        &self.columns
    }

    /// The rotation from map-frame coefficients to those of the convention, the same for every map.
    #[must_use]
    pub fn to_convention(&self) -> &Rotation {
        &self.to_convention
    }

    /// The convention's basis integrated over one texel: `order²` values in steradians.
    ///
    /// # Errors
    /// [`MathError::Index`] for a texel outside the map.
    pub fn texel(&self, column: usize, row: usize) -> Result<Vec<f64>, MathError> {
        let inside = |what, index: usize, count| match index < count {
            true => Ok(index),
            false => Err(MathError::Index { what, index, count }),
        };
        let column = inside("column", column, self.width)? * self.column_stride();
        let row = inside("row", row, self.height)? * self.row_stride();
        let mut map_frame = vec![0.0; coefficient_count(self.order)];
        self.for_each_harmonic(|i, row_at, column_at| {
            map_frame[i] = self.rows[row + row_at] * self.columns[column + column_at];
        });
        let mut texel = vec![0.0; map_frame.len()];
        self.to_convention.apply(&map_frame, &mut texel)?;
        Ok(texel)
    }

    /// Calls `visit` with each harmonic's index and its places in a row and in a column.
    pub(super) fn for_each_harmonic(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for l in 0..self.order {
            for m in 0..=2 * l {
                // m counts from -l here.
                visit(l * l + m, Self::row_index(l, m.abs_diff(l)), self.order - 1 + m - l);
            }
        }
    }
}

/// Turns the map frame's axes into the convention's: z to +Y, x to -Z, y to -X.
fn map_frame() -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(DVec3::NEG_Z, DVec3::NEG_X, DVec3::Y))
}

fn row_table(order: usize, height: usize) -> Result<Vec<f64>, MathError> {
    let rule = gauss_legendre(ROW_POINTS)?;
    let half = FRAC_PI_2 / height as f64;
    let mut basis = vec![0.0; coefficient_count(order)];
    let stride = EquirectBasis::row_index(order, 0);
    let mut rows = vec![0.0; height * stride];
    for (row, values) in rows.chunks_exact_mut(stride).enumerate() {
        let middle = (2 * row + 1) as f64 * half;
        for (node, weight) in &rule {
            let (sine, cosine) = (middle + half * node).sin_cos();
            // At azimuth 0 the harmonic of m >= 0 is its Legendre function.
            evaluate(order, DVec3::new(sine, 0.0, cosine), &mut basis)?;
            for l in 0..order {
                for m in 0..=l {
                    values[EquirectBasis::row_index(l, m)] +=
                        weight * half * sine * basis[index(l, m as isize)];
                }
            }
        }
    }
    Ok(rows)
}

fn column_table(order: usize, width: usize) -> Vec<f64> {
    let half = PI / width as f64;
    let mut columns = Vec::with_capacity(width * (2 * order - 1));
    for column in 0..width {
        let azimuth = -((2 * column + 1) as f64 * half - PI);
        for place in 0..2 * order - 1 {
            let m = place.abs_diff(order - 1) as f64;
            // The integral of cos or sin(m x) over 2 half about the middle: that of the middle times this.
            let extent = if m == 0.0 { TAU / width as f64 } else { 2.0 / m * (m * half).sin() };
            let (sine, cosine) = (m * azimuth).sin_cos();
            columns.push(extent * if place < order - 1 { sine } else { cosine });
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::equirect::{direction, texel_solid_angle};
    use crate::testing::{assert_all_close, assert_close};

    /// The texel's integral by a two-dimensional rule in the map's own parameters.
    fn by_quadrature(order: usize, [width, height]: [usize; 2], [column, row]: [usize; 2]) -> Vec<f64> {
        let rule = gauss_legendre(40).unwrap();
        let mut sums = vec![0.0; order * order];
        let mut basis = sums.clone();
        for (a, weight_u) in &rule {
            for (b, weight_v) in &rule {
                let u = (column as f64 + 0.5 + 0.5 * a) / width as f64;
                let v = (row as f64 + 0.5 + 0.5 * b) / height as f64;
                evaluate(order, direction(u, v), &mut basis).unwrap();
                let area = TAU * PI / (4 * width * height) as f64 * (PI * v).sin();
                for (sum, y) in sums.iter_mut().zip(&basis) {
                    *sum += weight_u * weight_v * area * y;
                }
            }
        }
        sums
    }

    #[test]
    fn texels_agree_with_quadrature() {
        for (size, texels) in [
            ([1, 1], vec![[0, 0]]),
            ([1, 3], vec![[0, 0], [0, 2]]),
            ([5, 1], vec![[0, 0], [3, 0]]),
            ([16, 8], vec![[0, 0], [7, 3], [8, 3], [15, 7], [11, 2]]),
        ] {
            let basis = EquirectBasis::new(8, size[0], size[1]).unwrap();
            for texel in texels {
                let actual = basis.texel(texel[0], texel[1]).unwrap();
                assert_all_close(
                    &format!("{size:?} {texel:?}"),
                    &actual,
                    &by_quadrature(8, size, texel),
                    1e-13,
                );
            }
        }
    }

    /// Row integrals in z, where they are antiderivatives: ∫ P_0 = z, ∫ P_2 = (z³ - z)/2, and m = 1, l = 1 in
    /// theta: ∫ sin² = (theta - sin theta cos theta)/2.
    #[test]
    fn rows_agree_with_antiderivatives_at_every_height() {
        for height in [1, 2, 33, 8192] {
            let basis = EquirectBasis::new(3, 1, height).unwrap();
            for row in [0, height / 3, height - 1] {
                let angles = [row, row + 1].map(|edge| PI * edge as f64 / height as f64);
                let values = &basis.rows()[row * basis.row_stride()..][..basis.row_stride()];
                let between = |f: fn(f64) -> f64| f(angles[1]) - f(angles[0]);
                let at = |l, m| values[EquirectBasis::row_index(l, m)];
                let what = format!("row {row} of {height}");
                assert_close(&what, at(0, 0), (0.25 / PI).sqrt() * between(|t| -t.cos()), 1e-15);
                let quadratic = between(|t| -0.5 * (t.cos().powi(3) - t.cos()));
                assert_close(&what, at(2, 0), (1.25 / PI).sqrt() * quadratic, 1e-15);
                let linear = between(|t| 0.5 * (t - t.sin() * t.cos()));
                assert_close(&what, at(1, 1), -(0.75 / PI).sqrt() * linear, 1e-15);
            }
        }
    }

    /// Relative to the closed form, which cancels nowhere: thin rows lose nothing, not even at the poles.
    #[test]
    fn the_constant_harmonic_gives_the_solid_angle() {
        for (width, height) in [(12, 6), (1, 8192), (3, 65_536)] {
            let basis = EquirectBasis::new(1, width, height).unwrap();
            for row in [0, 1, height / 2, height - 1] {
                let solid_angle = basis.texel(width - 1, row).unwrap()[0] * (4.0 * PI).sqrt();
                let expected = texel_solid_angle(width, height, row).unwrap();
                assert_close("solid angle over its closed form", solid_angle / expected, 1.0, 1e-12);
            }
        }
    }

    #[test]
    fn texels_sum_to_the_sphere() {
        for (width, height) in [(1, 1), (1, 64), (64, 1), (10, 7)] {
            let basis = EquirectBasis::new(8, width, height).unwrap();
            let mut sums = vec![0.0; 64];
            for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
                for (sum, value) in sums.iter_mut().zip(basis.texel(column, row).unwrap()) {
                    *sum += value;
                }
            }
            let mut expected = vec![0.0; 64];
            expected[0] = (4.0 * PI).sqrt();
            assert_all_close(&format!("{width} x {height}"), &sums, &expected, 1e-13);
        }
    }

    #[test]
    fn refuses_other_orders_sizes_and_texels() {
        assert_eq!(EquirectBasis::new(0, 2, 2), Err(MathError::Order { order: 0 }));
        assert_eq!(EquirectBasis::new(9, 2, 2), Err(MathError::Order { order: 9 }));
        assert!(matches!(EquirectBasis::new(2, 0, 2), Err(MathError::Size { .. })));
        let basis = EquirectBasis::new(2, 2, 2).unwrap();
        assert!(matches!(basis.texel(2, 0), Err(MathError::Index { .. })));
        assert!(matches!(basis.texel(0, 2), Err(MathError::Index { .. })));
    }
}
