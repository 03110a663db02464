//! The rows of `airglow eval`: the GPU's projection, rotation and product against the f64 reference.

use crate::host::{Numbers, length, with_bench};
use airglow_relight::Texels;
use airglow_relight::eval::{ProductRow, RotateRow, environment_sh, sh_product, sh_rotate};
use glam::{DQuat, DVec3};

/// Relative L2 distance of two vectors.
fn distance(actual: &[f64], reference: &[f64]) -> f64 {
    length(actual.iter().zip(reference).map(|(a, r)| a - r)) / length(reference.iter().copied())
}

#[test]
fn rotations_agree_with_the_reference() {
    with_bench(|bench| {
        let mut numbers = Numbers::new(1);
        let mut rows = Vec::new();
        for order in 1..=6 {
            for _ in 0..40 {
                let f = (0..order * order).map(|_| numbers.next()).collect();
                let q = DQuat::from_xyzw(numbers.next(), numbers.next(), numbers.next(), numbers.next());
                rows.push(RotateRow { order, f, rotation: q * 3.0 });
            }
        }
        let results = sh_rotate(bench, &rows).unwrap();
        for (row, result) in rows.iter().zip(&results) {
            let result = result.as_ref().unwrap();
            let error = distance(&result.values, &result.reference);
            assert!(error < 2e-6, "order {} {}: {error}\n{result:?}", row.order, row.rotation);
        }
    });
}

#[test]
fn refused_rows_leave_the_others() {
    with_bench(|bench| {
        let row =
            |order, x| RotateRow { order, f: vec![1.0; 4], rotation: DQuat::from_xyzw(x, 0.0, 0.0, 0.0) };
        let results = sh_rotate(bench, &[row(2, 0.0), row(2, 1.0), row(7, 1.0), row(3, 1.0)]).unwrap();
        assert!(results[0].as_ref().unwrap_err().to_string().contains("quaternion"));
        assert!(results[1].is_ok());
        assert!(results[2].as_ref().unwrap_err().to_string().contains("order 7"));
        assert!(results[3].as_ref().unwrap_err().to_string().contains("9 are needed"));
    });
}

#[test]
fn products_agree_with_the_reference() {
    with_bench(|bench| {
        let mut numbers = Numbers::new(2);
        let mut rows = Vec::new();
        for order in 1..=6 {
            for _ in 0..20 {
                let mut vector = || (0..order * order).map(|_| numbers.next()).collect::<Vec<f64>>();
                rows.push(ProductRow { order, f: vector(), g: vector() });
            }
        }
        for (row, result) in rows.iter().zip(sh_product(bench, &rows).unwrap()) {
            let result = result.unwrap();
            let scale = length(row.f.iter().copied()) * length(row.g.iter().copied());
            let error = length(result.values.iter().zip(&result.reference).map(|(a, r)| a - r)) / scale;
            assert!(error < 1e-6, "order {}: {error}\n{result:?}", row.order);
        }
    });
}

/// A texel of 1e5 in a dim map, if there is one.
type Peak = Option<(u32, u32)>;

/// Sizes and peaks.
const MAPS: [(u32, u32, Peak); 9] = [
    (1, 1, None),
    (8192, 1, None),
    (1, 8192, None),
    (64, 32, None),
    (300, 77, None),
    (64, 32, Some((10, 0))),
    (64, 32, Some((0, 16))),
    (64, 32, Some((40, 31))),
    (64, 32, Some((24, 11))),
];

#[test]
fn environments_agree_with_the_reference() {
    with_bench(|bench| {
        let mut numbers = Numbers::new(3);
        for (width, height, peak) in MAPS {
            let count = (width * height) as usize;
            let mut texels: Vec<[f32; 3]> =
                numbers.rgb(count).into_iter().map(|rgb| rgb.map(|c| c + 1.0)).collect();
            if let Some((x, y)) = peak {
                texels[(y * width + x) as usize] = [1e5, 8e4, 5e4];
            }
            let texels = Texels { width, height, rgb: &texels };
            for (order, row) in (1..).zip(environment_sh(bench, &[1, 2, 3, 4, 5, 6], &texels).unwrap()) {
                let row = row.unwrap();
                let pairs = || row.values.iter().flatten().zip(row.reference.iter().flatten());
                let error = length(pairs().map(|(a, r)| a - r)) / length(pairs().map(|(_, r)| *r));
                println!("{width} x {height} {peak:?} order {order}: {error:.2e}");
                assert!(error < 1e-5, "{width} x {height}, peak {peak:?}, order {order}: {error}");
            }
        }
    });
}

#[test]
fn a_constant_environment_is_its_first_coefficient() {
    with_bench(|bench| {
        let texels = vec![[2.0, 1.0, 0.5]; 512 * 256];
        let texels = Texels { width: 512, height: 256, rgb: &texels };
        let row = environment_sh(bench, &[4], &texels).unwrap().remove(0).unwrap();
        let expected = 2.0 * (4.0 * std::f64::consts::PI).sqrt();
        assert!((row.values[0][0] / expected - 1.0).abs() < 2e-6, "{} and {expected}", row.values[0][0]);
        let rest = length(row.values[1..].iter().flatten().copied());
        assert!(rest < 1e-5 * expected, "{rest}");
    });
}

#[test]
fn a_peak_lies_where_the_map_puts_it() {
    with_bench(|bench| {
        // A quarter right of the centre and level: +X. Y_1,1 = -sqrt(3/4pi) x.
        let mut texels = vec![[0.0; 3]; 64 * 32];
        for row in 15..17 {
            for column in 47..49 {
                texels[row * 64 + column] = [1.0; 3];
            }
        }
        let texels = Texels { width: 64, height: 32, rgb: &texels };
        let row = environment_sh(bench, &[2], &texels).unwrap().remove(0).unwrap();
        let band: Vec<f64> = row.values[1..].iter().map(|rgb| rgb[0]).collect();
        let direction = DVec3::new(-band[2], -band[0], band[1]).normalize();
        assert!(direction.distance(DVec3::X) < 1e-5, "{direction}");
    });
}

#[test]
fn bad_texels_are_refused_with_a_count() {
    with_bench(|bench| {
        let mut texels = vec![[1.0; 3]; 8];
        texels[3][0] = f32::NAN;
        texels[6][2] = f32::NAN;
        let texels = Texels { width: 4, height: 2, rgb: &texels };
        let message = environment_sh(bench, &[2], &texels).unwrap_err().to_string();
        assert!(message.contains("2 of the texels"), "{message}");
    });
}
