//! Extreme rotations and products.

use glam::DQuat;

use super::{Outcome, Reproduce, Selection, coefficients};
use crate::RelightError;
use crate::bench::Bench;
use crate::eval::{ProductRow, RotateRow, sh_product, sh_rotate};

/// Quaternions of all lengths, half turns and what is no rotation.
pub(super) fn rotations(bench: &Bench<'_>, selection: &Selection<'_>) -> Result<Vec<Outcome>, RelightError> {
    let quaternions = [
        ("identity", [0.0, 0.0, 0.0, 1.0]),
        ("half turn about x", [1.0, 0.0, 0.0, 0.0]),
        ("half turn about y", [0.0, 1.0, 0.0, 0.0]),
        ("half turn about z", [0.0, 0.0, 1.0, 0.0]),
        ("half turn about an odd axis", [0.36, -0.48, 0.8, 0.0]),
        ("length 1000", [100.0, -700.0, 500.0, 500.0]),
        ("length 1e-200", [1e-201, 7e-201, -5e-201, 5e-201]),
        ("zero", [0.0; 4]),
        ("not a number", [f64::NAN, 0.0, 0.0, 1.0]),
    ];
    let (mut rows, mut names) = (Vec::new(), Vec::new());
    for (name, q) in quaternions {
        for order in [1, 6] {
            let name = format!("rotation: {name}, order {order}");
            if selection.has(&name) {
                rows.push(RotateRow { order, f: coefficients(order), rotation: DQuat::from_array(q) });
                names.push(name);
            }
        }
    }
    let outcome = |((row, name), found): ((&RotateRow, String), _)| {
        let due = !row.rotation.is_finite() || row.rotation == DQuat::from_array([0.0; 4]);
        Outcome::of_row(name, row.rotation.to_string(), found, due, Reproduce::from(row))
    };
    Ok(rows.iter().zip(names).zip(sh_rotate(bench, &rows)?).map(outcome).collect())
}

/// Products with zero, with one, of values far apart, and of what is not finite.
pub(super) fn products(bench: &Bench<'_>, selection: &Selection<'_>) -> Result<Vec<Outcome>, RelightError> {
    // sqrt(4 pi) Y_00 is the function that is one everywhere.
    let one = std::f64::consts::PI.sqrt() * 2.0;
    let constant = |order, value| (0..order * order).map(|i| if i == 0 { value } else { 0.0 }).collect();
    let scaled = |order, scale: f64| coefficients(order).iter().map(|f| scale * f).collect();
    let (mut rows, mut names) = (Vec::new(), Vec::new());
    for order in [1, 6] {
        let factors: [(&str, Vec<f64>, Vec<f64>); 5] = [
            ("with zero", coefficients(order), constant(order, 0.0)),
            ("with the function one", coefficients(order), constant(order, one)),
            ("with itself", coefficients(order), coefficients(order)),
            ("of 1e-15 and 1e15", scaled(order, 1e-15), scaled(order, 1e15)),
            ("with what is not a number", coefficients(order), constant(order, f64::NAN)),
        ];
        for (name, f, g) in factors {
            let name = format!("product: {name}, order {order}");
            if selection.has(&name) {
                rows.push(ProductRow { order, f, g });
                names.push(name);
            }
        }
    }
    let outcome = |((row, name), found): ((&ProductRow, String), _)| {
        let due = row.g.iter().any(|value| !value.is_finite());
        let input = format!("f starts with {:e}, g with {:e}", row.f[0], row.g[0]);
        Outcome::of_row(name, input, found, due, Reproduce::from(row))
    };
    Ok(rows.iter().zip(names).zip(sh_product(bench, &rows)?).map(outcome).collect())
}
