//! The room's own code on rows of parameters, beside the f64 reference: exponentials and spheres on the device, tables as
//! the kernels look them up.

use std::collections::BTreeMap;

use airglow_math::sh::zonal::coefficients_from_factors;

use crate::bench::{Bench, RowKernel, Scene, SphereKernel};
use crate::exponential::{Evaluator, Exponential};
use crate::logarithm::{CLIP, Logarithm};
use crate::reference::{caps, truth};
use crate::settings::Settings;
use crate::table::{self, Tables};
use crate::{ShadowError, Sphere, check_order, circle};

/// Degree of the rule that the truth of spheres is integrated by.
const DEGREE: usize = 600;

/// A way from blockers to visibility.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The exponential of the sum of logarithms.
    Exponential(Exponential),
    /// Products of visibilities, one after the other.
    Products,
}

/// A row of `sh-exp`.
#[derive(Clone, Debug)]
pub struct ExponentialRow {
    /// Bands, 3 to 6.
    pub order: usize,
    /// order^2 coefficients.
    pub f: Vec<f64>,
    /// The way.
    pub method: Exponential,
}

/// A row of `shadow-spheres`.
#[derive(Clone, Debug)]
pub struct SpheresRow {
    /// Bands, 3 to 6.
    pub order: usize,
    /// The receiver.
    pub point: glam::DVec3,
    /// The blockers, at most [`crate::MAX_SPHERES`].
    pub spheres: Vec<Sphere>,
    /// The way.
    pub method: Method,
}

/// What a row gave: the room's values and the reference's.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// The device's or the tables' values, exactly.
    pub values: Vec<f64>,
    /// The truth.
    pub reference: Vec<f64>,
}

/// The results of rows, in their order; a refused row has its reason.
pub type Rows<T> = Vec<Result<T, ShadowError>>;

/// The exponential of a name: `default`, `exact`, `ol`, `hyb:T`, `psN` or `pssN`.
///
/// # Errors
/// [`ShadowError::Method`].
pub fn exponential(name: &str) -> Result<Exponential, ShadowError> {
    let degree = |text: &str| text.parse().ok();
    let found = match name {
        "default" => Some(Exponential::Adaptive),
        "exact" => Some(Exponential::Operator),
        "ol" => Some(Exponential::OptimalLinear),
        _ => None,
    };
    let hybrid = || Some(Exponential::Hybrid { threshold: name.strip_prefix("hyb:")?.parse().ok()? });
    let scaled = || Some(Exponential::ScaledSeries { degree: degree(name.strip_prefix("pss")?)? });
    let series = || Some(Exponential::Series { degree: degree(name.strip_prefix("ps")?)? });
    found.or_else(hybrid).or_else(scaled).or_else(series).filter(|found| found.check().is_ok()).ok_or_else(
        || {
            let known = "default, exact, ol, hyb:T with T above 0, psN or pssN with N from 1 to 32";
            ShadowError::Method { method: name.to_owned(), known }
        },
    )
}

/// The way of a name: as [`exponential`], or `products`.
///
/// # Errors
/// [`ShadowError::Method`].
pub fn method(name: &str) -> Result<Method, ShadowError> {
    if name == "products" { Ok(Method::Products) } else { exponential(name).map(Method::Exponential) }
}

/// `sh-exp`: the exponentials on the device, beside the same way in f64.
///
/// # Errors
/// [`ShadowError::Gpu`]; what is wrong with one row is that row's own result.
pub fn exponentials(bench: &Bench<'_>, rows: &[ExponentialRow]) -> Result<Rows<Evaluated>, ShadowError> {
    let mut results: Rows<Evaluated> = rows.iter().map(ExponentialRow::reference).collect();
    let mut groups: BTreeMap<(usize, String), Vec<usize>> = BTreeMap::new();
    for (place, row) in rows.iter().enumerate().filter(|(place, _)| results[*place].is_ok()) {
        groups.entry((row.order, format!("{:?}", row.method))).or_default().push(place);
    }
    for ((order, _), places) in groups {
        let Some(&first) = places.first() else { continue };
        let input: Vec<f32> =
            places.iter().flat_map(|&place| rows[place].f.iter().map(|value| *value as f32)).collect();
        let (found, _) = bench.rows(order, RowKernel::Exponential(rows[first].method), &input, 1)?;
        for (place, values) in places.into_iter().zip(found.chunks_exact(order * order)) {
            if let Ok(result) = &mut results[place] {
                result.values = wide(values);
            }
        }
    }
    Ok(results)
}

impl ExponentialRow {
    fn reference(&self) -> Result<Evaluated, ShadowError> {
        let reference = Evaluator::new(self.order)?.exponential(self.method, &self.f)?;
        Ok(Evaluated { values: Vec::new(), reference })
    }
}

/// `shadow-spheres`: visibility on the device, beside the projection of what the spheres leave to be seen.
///
/// # Errors
/// [`ShadowError::Gpu`]; what is wrong with one row is that row's own result.
pub fn spheres(bench: &Bench<'_>, rows: &[SpheresRow]) -> Result<Rows<Evaluated>, ShadowError> {
    let mut passes = BTreeMap::new();
    rows.iter()
        .map(|row| match row.evaluated(bench, &mut passes) {
            Err(ShadowError::Gpu(error)) => Err(ShadowError::Gpu(error)),
            other => Ok(other),
        })
        .collect()
}

impl SpheresRow {
    fn evaluated(
        &self,
        bench: &Bench<'_>,
        passes: &mut BTreeMap<(usize, String), crate::Shadow>,
    ) -> Result<Evaluated, ShadowError> {
        let reference = truth(self.order, DEGREE, &caps(&self.spheres, self.point))?;
        let settings = |exponential| Settings {
            order: self.order,
            exponential,
            reach: 0.0,
            clamp: exponential == Exponential::Adaptive && self.method != Method::Products,
            ..Default::default()
        };
        let (settings, kernel, after) = match self.method {
            Method::Products => (settings(Exponential::Adaptive), SphereKernel::Products, None),
            Method::Exponential(method) => match settings(method).check() {
                Ok(()) => (settings(method), SphereKernel::Pass, None),
                // No kernel over receivers: the logarithm first, then the kernel over rows.
                Err(_) => (settings(Exponential::Adaptive), SphereKernel::Logarithm, Some(method)),
            },
        };
        let key = (self.order, format!("{:?} {kernel:?}", settings.exponential));
        let shadow = match passes.get(&key) {
            Some(shadow) => shadow.clone(),
            None => passes.entry(key).or_insert(bench.shadow(settings, kernel)?).clone(),
        };
        let positions = [self.point.as_vec3().to_array()];
        let scene = Scene { positions: &positions, normals: None, spheres: &self.spheres };
        let mut values = bench.frame(&shadow, &scene, 1)?.values;
        if let Some(method) = after {
            (values, _) = bench.rows(self.order, RowKernel::Exponential(method), &values, 1)?;
        }
        Ok(Evaluated { values: wide(&values), reference })
    }
}

/// `sh-circle`: zonal visibility and logarithm of a blocker of an angular radius about +Z, as the kernels look them up in
/// f32, each beside f64.
///
/// # Errors
/// [`ShadowError::Order`], [`ShadowError::Range`].
pub fn circle(order: usize, angular_radius: f64) -> Result<[Evaluated; 2], ShadowError> {
    check_order(order)?;
    let height = circle::height(angular_radius)?;
    let tables = Tables::new(order, CLIP)?;
    let mut visibility = coefficients_from_factors(&table::visibility(order, height))?;
    visibility[0] += crate::mean::ONE;
    Ok([
        Evaluated { values: visibility, reference: circle::visibility(order, height)? },
        Evaluated {
            values: coefficients_from_factors(&table::looked_up(order, &tables.logarithm, height))?,
            reference: Logarithm::new(order, CLIP)?.of_cap(height)?,
        },
    ])
}

/// `sh-log`: the logarithm that the tables are made with. It is made on the CPU; the reference is the same function, its
/// exponential being what tests hold it to.
///
/// # Errors
/// As [`Logarithm::of`].
pub fn logarithm(order: usize, g: &[f64]) -> Result<Evaluated, ShadowError> {
    let values = Logarithm::new(order, CLIP)?.of(g)?;
    Ok(Evaluated { reference: values.clone(), values })
}

fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().copied().map(f64::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_or_refused() {
        assert_eq!(exponential("default").unwrap(), Exponential::Adaptive);
        assert_eq!(exponential("ps9").unwrap(), Exponential::Series { degree: 9 });
        assert_eq!(exponential("pss2").unwrap(), Exponential::ScaledSeries { degree: 2 });
        assert_eq!(exponential("hyb:0.25").unwrap(), Exponential::Hybrid { threshold: 0.25 });
        assert_eq!(method("products").unwrap(), Method::Products);
        for bad in ["", "ps", "ps0", "pss33", "hyb", "hyb:0", "hyb:nan", "products2", "taylor"] {
            assert!(method(bad).unwrap_err().to_string().contains("hyb:T"), "{bad}");
        }
    }

    #[test]
    fn looked_up_circles_are_near_the_reference() {
        for order in 3..=6 {
            for angle in [0.0, 1e-3, 0.2, 0.9, 1.5, std::f64::consts::FRAC_PI_2] {
                for Evaluated { values, reference } in circle(order, angle).unwrap() {
                    for (value, truth) in values.iter().zip(&reference) {
                        assert!(
                            (value - truth).abs() < 2e-2,
                            "{order}, {angle}: {values:?} and {reference:?}"
                        );
                    }
                }
            }
        }
        assert!(circle(4, 2.0).is_err() && circle(7, 0.1).is_err());
    }
}
