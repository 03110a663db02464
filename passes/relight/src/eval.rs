//! The pass's own GPU code on rows of parameters, many rows a dispatch, beside the f64 reference.

use std::collections::BTreeMap;

use airglow_gpu::Binding;
use airglow_graph::{Access, BufferDesc};
use airglow_math::sh::product::TripleProduct;
use airglow_math::sh::rotation::Rotation;
use airglow_math::sphere::equirect::Projector;
use glam::DQuat;

use crate::RelightError;
use crate::bench::{Bench, Texels};
use crate::constants::Pair;
use crate::envelope::compute;
use crate::kernels;
use crate::order::MAX_ORDER;
use crate::rotation::{OPEN, RotateConstants, Turn, normalised};
use crate::tables::tensor;

/// Rows of one dispatch: the least that a device offers is 65535 workgroups.
const ROWS: usize = 16_384;

/// What a row gave: the GPU's values and those of the f64 reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// The GPU's values, exactly.
    pub values: Vec<f64>,
    /// The reference's.
    pub reference: Vec<f64>,
}

/// A row of `sh-rotate`: `rotated(s) = f(q^-1 s q)`.
#[derive(Clone, Debug)]
pub struct RotateRow {
    /// Bands, 1 to 6.
    pub order: usize,
    /// order^2 coefficients.
    pub f: Vec<f64>,
    /// The quaternion, of any length but zero.
    pub rotation: DQuat,
}

/// A row of `sh-product`: the product of two functions, order n in and order n out.
#[derive(Clone, Debug)]
pub struct ProductRow {
    /// Bands, 1 to 6.
    pub order: usize,
    /// order^2 coefficients of the first function.
    pub f: Vec<f64>,
    /// order^2 coefficients of the second.
    pub g: Vec<f64>,
}

/// What a row of `environment-sh` gave: order^2 RGB coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluatedEnvironment {
    /// The GPU's values, exactly.
    pub values: Vec<[f64; 3]>,
    /// The reference's.
    pub reference: Vec<[f64; 3]>,
}

/// The results of rows, in their order; a refused row has its reason.
pub type Rows<T> = Vec<Result<T, RelightError>>;

/// Rotates the rows on the GPU.
///
/// # Errors
/// [`RelightError::Gpu`]; what is wrong with one row is that row's own result.
pub fn sh_rotate(bench: &Bench<'_>, rows: &[RotateRow]) -> Result<Rows<Evaluated>, RelightError> {
    let check = |row: &RotateRow| {
        check_values(row.order, "f", &row.f)?;
        normalised(row.rotation)
    };
    let mut results: Rows<Evaluated> = Vec::with_capacity(rows.len());
    for row in rows {
        results.push(check(row).and_then(|rotation| {
            let mut reference = vec![0.0; row.f.len()];
            Rotation::from_quaternion(row.order, rotation)?.apply(&row.f, &mut reference)?;
            Ok(Evaluated { values: Vec::new(), reference })
        }));
    }
    for (order, places) in by_order(&results, |i| rows[i].order) {
        let pipeline = compute(bench.context, &kernels::rotate(order))?;
        let count = (order * order) as u32;
        for places in places.chunks(ROWS) {
            let vectors: Vec<[f32; 4]> = (places.iter())
                .flat_map(|&i| rows[i].f.iter().map(|value| [*value as f32, 0.0, 0.0, 0.0]))
                .collect();
            let turns = places.iter().map(|&i| Ok(Turn::new(normalised(rows[i].rotation)?, false)));
            let turns: Vec<Turn> = turns.collect::<Result<_, RelightError>>()?;
            let [source, turns] = [bench.buffer("vectors", &vectors)?, bench.buffer("turns", &turns)?];
            let rotated = bench.scratch("rotated", BufferDesc::new(source.size()))?;
            let bound =
                [Binding::storage(0, &source), Binding::storage(1, &turns), Binding::storage(2, &rotated)];
            let values = bench.run(|recorder| {
                recorder.bind_compute(&pipeline, &bound)?;
                recorder.push_constants(&RotateConstants::new(Pair::new(count, count), 1.0, &OPEN))?;
                recorder.dispatch([places.len() as u32, 1, 1])?;
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
                recorder.read_back_buffer(&rotated)
            })?;
            let values: Vec<f32> = values.read::<[f32; 4]>()?.into_iter().map(|rgbw| rgbw[0]).collect();
            fill(&mut results, places, &values, order * order);
        }
    }
    Ok(results)
}

/// Multiplies the rows on the GPU, by the sparse tensor.
///
/// # Errors
/// [`RelightError::Gpu`]; what is wrong with one row is that row's own result.
pub fn sh_product(bench: &Bench<'_>, rows: &[ProductRow]) -> Result<Rows<Evaluated>, RelightError> {
    let mut tensors: BTreeMap<usize, TripleProduct> = BTreeMap::new();
    for order in 1..=MAX_ORDER {
        if rows.iter().any(|row| row.order == order) {
            tensors.insert(order, TripleProduct::new(order)?);
        }
    }
    let reference = |row: &ProductRow| {
        check_values(row.order, "f", &row.f)?;
        check_values(row.order, "g", &row.g)?;
        let mut reference = vec![0.0; row.f.len()];
        tensors.get(&row.order).map(|tensor| tensor.product(&row.f, &row.g, &mut reference)).transpose()?;
        Ok(Evaluated { values: Vec::new(), reference })
    };
    let mut results: Rows<Evaluated> = rows.iter().map(reference).collect();
    for (order, places) in by_order(&results, |i| rows[i].order) {
        let pipeline = compute(bench.context, &kernels::product(order))?;
        let tensor = bench.buffer("tensor", &tensor(order)?)?;
        for places in places.chunks(ROWS) {
            let gather = |side: fn(&ProductRow) -> &[f64]| -> Vec<f32> {
                places.iter().flat_map(|&i| side(&rows[i]).iter().map(|value| *value as f32)).collect()
            };
            let left = bench.buffer("left", &gather(|row| &row.f))?;
            let right = bench.buffer("right", &gather(|row| &row.g))?;
            let product = bench.scratch("product", BufferDesc::new(left.size()))?;
            let bound = [&tensor, &left, &right, &product];
            let bound: Vec<_> = bound.into_iter().zip(0..).map(|(b, i)| Binding::storage(i, b)).collect();
            let values = bench.run(|recorder| {
                recorder.bind_compute(&pipeline, &bound)?;
                recorder.dispatch([places.len() as u32, 1, 1])?;
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
                recorder.read_back_buffer(&product)
            })?;
            fill(&mut results, places, &values.read::<f32>()?, order * order);
        }
    }
    Ok(results)
}

/// Projects one environment at each of the orders on the GPU.
///
/// # Errors
/// [`RelightError::Length`] and [`RelightError::Values`] for an image that is refused, [`RelightError::Gpu`]; an
/// order out of range is that row's own result.
pub fn environment_sh(
    bench: &Bench<'_>,
    orders: &[usize],
    texels: &Texels<'_>,
) -> Result<Rows<EvaluatedEnvironment>, RelightError> {
    crate::check_environment("the environment", texels.width, texels.height, texels.rgb)?;
    let row = |&order: &usize| {
        check_order(order)?;
        let values = bench.environment(order, texels)?;
        let values = values.into_iter().map(|rgb| rgb.map(f64::from)).collect();
        let projector = Projector::new(order, texels.width as usize, texels.height as usize)?;
        Ok(EvaluatedEnvironment { values, reference: projector.project(texels.rgb)? })
    };
    Ok(orders.iter().map(row).collect())
}

fn check_order(order: usize) -> Result<(), RelightError> {
    if (1..=MAX_ORDER).contains(&order) { Ok(()) } else { Err(RelightError::Order { order }) }
}

/// order^2 finite values.
fn check_values(order: usize, what: &'static str, values: &[f64]) -> Result<(), RelightError> {
    check_order(order)?;
    let (name, expected, actual) = ("the row".to_owned(), order * order, values.len());
    if actual != expected {
        return Err(RelightError::Length { name, what, expected, actual });
    }
    match crate::tables::count_wrong(values, |value| !(value as f32).is_finite()) {
        Some((count, first)) => {
            let problem = "not finite as f32";
            Err(RelightError::Values { name, what: "values", problem, count, first })
        }
        None => Ok(()),
    }
}

/// The rows that were accepted, by order.
fn by_order<T>(results: &Rows<T>, order: impl Fn(usize) -> usize) -> BTreeMap<usize, Vec<usize>> {
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, _) in results.iter().enumerate().filter(|(_, result)| result.is_ok()) {
        groups.entry(order(i)).or_default().push(i);
    }
    groups
}

/// Hands the values of a dispatch to their rows.
fn fill(results: &mut Rows<Evaluated>, places: &[usize], values: &[f32], count: usize) {
    for (&place, values) in places.iter().zip(values.chunks_exact(count)) {
        if let Ok(result) = &mut results[place] {
            result.values = values.iter().map(|value| f64::from(*value)).collect();
        }
    }
}
