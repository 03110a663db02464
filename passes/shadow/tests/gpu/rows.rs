//! Rows of coefficients: every exponential and the generated products against f64.

use airglow_shadow::bench::RowKernel;
use airglow_shadow::families::FAMILIES;
use airglow_shadow::reference::{Reference, rms};
use airglow_shadow::{Evaluator, Exponential};

use crate::{wide, with_bench};

/// Logarithms of the families' scenes.
fn rows(order: usize) -> Vec<f32> {
    let reference = Reference::new(order).unwrap();
    let scenes = FAMILIES.iter().flat_map(|family| (0..8).map(move |scene| family.scene(scene).unwrap()));
    scenes.flat_map(|caps| reference.log_visibility(&caps).unwrap()).map(|value| value as f32).collect()
}

#[test]
fn exponentials_agree_with_the_reference() {
    with_bench(|bench| {
        for order in [3, 4, 5, 6] {
            let (rows, evaluator) = (rows(order), Evaluator::new(order).unwrap());
            let methods = [
                Exponential::Adaptive,
                Exponential::ScaledSeries { degree: 2 },
                Exponential::ScaledSeries { degree: 9 },
                Exponential::Horner { degree: 4, norm: 1.0 },
                Exponential::OptimalLinear,
                Exponential::Hybrid { threshold: 0.25 },
                Exponential::Operator,
                Exponential::Series { degree: 3 },
            ];
            // Every kernel is compiled once for each order; two of them are enough where the others only repeat.
            let methods = if order == 4 { &methods[..] } else { &methods[..2] };
            for &method in methods {
                let (found, _) = bench.rows(order, RowKernel::Exponential(method), &rows, 1).unwrap();
                let mut worst = 0.0_f64;
                for (found, row) in found.chunks(order * order).zip(rows.chunks(order * order)) {
                    let truth = evaluator.exponential(method, &wide(row)).unwrap();
                    let size = rms(&truth, &vec![0.0; truth.len()]).max(1.0);
                    worst = worst.max(rms(&wide(found), &truth) / size);
                }
                println!("order {order}, {method:?}: {worst:.1e}");
                assert!(worst < 3e-4, "order {order}, {method:?}: {worst:e}");
            }
        }
    });
}

#[test]
fn generated_products_and_squares_agree_with_the_tensor() {
    with_bench(|bench| {
        for order in 3..=6 {
            let (rows, evaluator) = (rows(order), Evaluator::new(order).unwrap());
            for kernel in [RowKernel::Product(1), RowKernel::Square(1)] {
                let (found, _) = bench.rows(order, kernel, &rows, 1).unwrap();
                for (found, row) in found.chunks(order * order).zip(rows.chunks(order * order)) {
                    let truth = evaluator.product(&wide(row), &wide(row)).unwrap();
                    let size = rms(&truth, &vec![0.0; truth.len()]);
                    let error = rms(&wide(found), &truth);
                    assert!(error <= 2e-6 * size, "order {order}, {kernel:?}: {error:e} of {size:e}");
                }
            }
        }
    });
}

#[test]
fn long_and_broken_vectors_neither_overflow_nor_hang() {
    with_bench(|bench| {
        let mut rows = vec![0.0_f32; 16 * 4];
        // Norms of 50: all blocked, and a mean far below the rest.
        (0..16).for_each(|i| rows[i] = -12.5);
        rows[16] = -50.0;
        rows[32] = f32::NAN;
        rows[48 + 3] = f32::INFINITY;
        for method in [Exponential::Adaptive, Exponential::ScaledSeries { degree: 2 }] {
            let (found, _) = bench.rows(4, RowKernel::Exponential(method), &rows, 1).unwrap();
            assert!(found[..32].iter().all(|value| value.is_finite()), "{method:?}: {found:?}");
            assert!(found[16] > 0.0 && found[16] < 1e-5, "{method:?}: {}", found[16]);
        }
        assert!(bench.rows(4, RowKernel::Square(1), &rows[1..], 1).is_err());
        assert!(bench.rows(2, RowKernel::Square(1), &rows, 1).is_err());
    });
}
