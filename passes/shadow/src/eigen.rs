//! Eigenvalues and eigenvectors of small symmetric matrices, by Jacobi's rotations (Golub, Van Loan, *Matrix
//! Computations*, section 8.5): slow and accurate, and a zero is never filled in.

/// Sweeps after which the rotations end; eight are enough for matrices of this size.
const SWEEPS: usize = 40;

/// Eigenvalues, and for each its unit eigenvector, of a row-major symmetric matrix of `size` rows.
pub(crate) fn symmetric(size: usize, matrix: &[f64]) -> Vec<(f64, Vec<f64>)> {
    let mut a = matrix.to_vec();
    // Rows are the eigenvectors.
    let mut vectors = vec![0.0; size * size];
    (0..size).for_each(|i| vectors[i * size + i] = 1.0);
    let scale = a.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..size {
            for q in p + 1..size {
                if a[p * size + q].abs() > 1e-17 * scale {
                    rotate(size, &mut a, &mut vectors, p, q);
                    rotated = true;
                }
            }
        }
        if !rotated {
            break;
        }
    }
    (0..size).map(|i| (a[i * size + i], vectors[i * size..(i + 1) * size].to_vec())).collect()
}

/// Turns rows and columns p and q so that their common element vanishes.
fn rotate(size: usize, a: &mut [f64], vectors: &mut [f64], p: usize, q: usize) {
    let (app, aqq, apq) = (a[p * size + p], a[q * size + q], a[p * size + q]);
    let tau = (aqq - app) / (2.0 * apq);
    let tangent = tau.signum() / (tau.abs() + (1.0 + tau * tau).sqrt());
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let sine = tangent * cosine;
    for k in 0..size {
        let (akp, akq) = (a[k * size + p], a[k * size + q]);
        a[k * size + p] = cosine * akp - sine * akq;
        a[k * size + q] = sine * akp + cosine * akq;
    }
    for rows in [&mut *a, vectors] {
        for k in 0..size {
            let (pk, qk) = (rows[p * size + k], rows[q * size + k]);
            rows[p * size + k] = cosine * pk - sine * qk;
            rows[q * size + k] = sine * pk + cosine * qk;
        }
    }
    // Rounding leaves something there, which would be rotated for ever.
    a[p * size + q] = 0.0;
    a[q * size + p] = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gives_the_matrix_back() {
        let size = 16;
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state) / f64::from(u32::MAX) - 0.5
        };
        let mut matrix = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..=i {
                let value = random();
                (matrix[i * size + j], matrix[j * size + i]) = (value, value);
            }
        }
        let pairs = symmetric(size, &matrix);
        for i in 0..size {
            for j in 0..size {
                let back: f64 = pairs.iter().map(|(value, vector)| value * vector[i] * vector[j]).sum();
                let expected = matrix[i * size + j];
                assert!((back - expected).abs() < 1e-14, "({i}, {j}): {back} and {expected}");
            }
        }
    }

    #[test]
    fn zero_and_diagonal_matrices_stay() {
        assert!(symmetric(3, &[0.0; 9]).iter().all(|(value, _)| *value == 0.0));
        let values: Vec<f64> = symmetric(2, &[3.0, 0.0, 0.0, -1.0]).into_iter().map(|pair| pair.0).collect();
        assert_eq!(values, [3.0, -1.0]);
    }
}
