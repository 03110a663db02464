//! Spheres, vectors and lights at their extremes.

use airglow::math::sh::{coefficient_count, project};
use airglow::shadow::eval::{ExponentialRow, exponentials};
use airglow::shadow::families::Family;
use airglow::shadow::reference::{caps, truth};
use airglow::shadow::{
    Blockers, Evaluator, Exponential, PixelLight, PixelPicture, PixelShadow, Products, Settings, ShadowError,
    Sphere,
};
use glam::{DMat4, DVec3};

use super::super::Row;
use super::{BOUND, Sky, Trial, again, error, open, row, wanted};

/// Orders that inputs are tried at: the least and the most.
const ORDERS: [usize; 2] = [3, 6];
/// Degree of the rule that what is really open is integrated by.
const DEGREE: usize = 400;
/// How far exponentials of the device may be off the same way in f64, over the size of the result or 1.
const EXPONENTIAL: f64 = 3e-4;

fn sphere(x: f64, radius: f64) -> Sphere {
    Sphere { center: DVec3::new(x, 0.0, 0.0), radius }
}

/// All inputs, or the one called `only`.
pub fn rows(trial: &Trial<'_>, only: Option<&str>) -> Result<Vec<Row>, ShadowError> {
    let mut rows = Vec::new();
    let single = [
        ("receiver in the middle of a sphere", sphere(0.0, 1.0)),
        ("receiver within a sphere", sphere(0.5, 1.0)),
        ("receiver on a sphere", sphere(1.0, 1.0)),
        ("receiver a hair outside of a sphere", sphere(1.0 + 1e-7, 1.0)),
        ("radius 0", sphere(2.0, 0.0)),
        ("radius 0 at the receiver", sphere(0.0, 0.0)),
        ("radius 1e6, seen from 1 above", sphere(1e6 + 1.0, 1e6)),
        ("radius 1e6, seen from 1e6 above", sphere(2e6, 1e6)),
        ("radius 1e-6 at a distance of 1e6", sphere(1e6, 1e-6)),
    ];
    for order in ORDERS {
        for (name, sphere) in single {
            let name = format!("{name}, order {order}");
            if wanted(only, &name) {
                let sky = Sky { order, spheres: vec![sphere], clamp: false };
                let (found, truth, _) = sky.visibility(trial)?;
                rows.push(row(
                    &name,
                    format!("a sphere of radius {:e} at a distance of {:e}", sphere.radius, sphere.center.x),
                    format!("open {:.6}", open(&found)),
                    format!("open {:.6}", open(&truth)),
                    error(&found, &truth),
                    BOUND,
                    sky.again(&name),
                ));
            }
        }
        rows.extend(overlapping(trial, only, order)?);
        rows.extend(gathered(trial, only, order)?);
        rows.extend(broken(trial, only, order)?);
        rows.extend(broken_pixels(trial, only, order)?);
        rows.extend(below(trial, only, order)?);
        rows.extend(long_vectors(trial, only, order)?);
        rows.extend(peak(trial, only, order)?);
    }
    Ok(rows)
}

/// A thousand blockers that overlap all around: next to nothing of the sky is left.
fn overlapping(trial: &Trial<'_>, only: Option<&str>, order: usize) -> Result<Option<Row>, ShadowError> {
    let name = format!("1000 overlapping blockers all around, order {order}");
    if !wanted(only, &name) {
        return Ok(None);
    }
    let family = Family { name: "", count: 1000, degrees: [10.0, 30.0] };
    let spheres = family.scene(1)?.iter().map(|cap| cap.sphere(3.0)).collect();
    let sky = Sky { order, spheres, clamp: true };
    let (found, _, clamped) = sky.visibility(trial)?;
    let truth = truth(order, DEGREE, &caps(&sky.spheres, DVec3::ZERO))?;
    Ok(Some(row(
        &name,
        "caps of 10 to 30 degrees".to_owned(),
        format!("open {:.6}; {clamped} receiver clamped", open(&found)),
        format!("open {:.6}", open(&truth)),
        error(&found, &truth),
        0.01,
        sky.again(&name),
    )))
}

/// A thousand blockers in one place, whose logarithms add up to more than there is: what is hidden once is to be hidden, and
/// the rest to be open. All open would be twice the bound off the truth.
fn gathered(trial: &Trial<'_>, only: Option<&str>, order: usize) -> Result<Option<Row>, ShadowError> {
    let name = format!("1000 blockers in one place, order {order}");
    if !wanted(only, &name) {
        return Ok(None);
    }
    let place = |i: u32| {
        let turn = DVec3::new(f64::from(i).sin(), f64::from(i).cos(), f64::from(2 * i).sin());
        Sphere { center: 2.0 * DVec3::X + 0.2 * turn, radius: 1.0 }
    };
    let sky = Sky { order, spheres: (0..1000).map(place).collect(), clamp: true };
    let (found, _, clamped) = sky.visibility(trial)?;
    let truth = truth(order, DEGREE, &caps(&sky.spheres, DVec3::ZERO))?;
    let all = open_everywhere(order);
    Ok(Some(row(
        &name,
        "spheres of radius 1 within 0.35 of one another".to_owned(),
        format!("open {:.4}; {clamped} receiver clamped", open(&found)),
        format!("open {:.4}; all open would be {:.2} off", open(&truth), error(&all, &truth)),
        error(&found, &truth),
        0.5 * error(&all, &truth),
        sky.again(&name),
    )))
}

/// A receiver that is not a number, and one that is infinite: all open, and its neighbours as they are without it.
fn broken(trial: &Trial<'_>, only: Option<&str>, order: usize) -> Result<Vec<Row>, ShadowError> {
    let width = coefficient_count(order);
    let spheres: Vec<Sphere> = (0..20).map(|i| sphere(2.0 + 0.1 * f64::from(i), 1.0)).collect();
    let mut rows = Vec::new();
    for (kind, value) in
        [("not a number", f32::NAN), ("infinite", f32::INFINITY), ("minus infinite", f32::NEG_INFINITY)]
    {
        let name = format!("a receiver that is {kind}, order {order}");
        if !wanted(only, &name) {
            continue;
        }
        let among = trial.receivers(order, &[[0.0; 3], [0.0, value, 0.0], [0.0, 0.5, 0.0]], &spheres)?;
        let alone = trial.receivers(order, &[[0.0; 3], [0.0, 0.5, 0.0]], &spheres)?;
        let mut expected = alone[..width].to_vec();
        expected.extend(open_everywhere(order));
        expected.extend(&alone[width..]);
        rows.push(row(
            &name,
            "the second of three under 20 spheres".to_owned(),
            format!(
                "open {:.6}, {:.6}, {:.6}",
                open(&among),
                open(&among[width..]),
                open(&among[2 * width..])
            ),
            format!("open {:.6}, 1, {:.6}", open(&alone), open(&alone[width..])),
            error(&among, &expected),
            1e-6,
            again(&name),
        ));
    }
    Ok(rows)
}

/// A pixel whose position or normal is not finite: no surface, and its neighbours as they are without it.
fn broken_pixels(trial: &Trial<'_>, only: Option<&str>, order: usize) -> Result<Vec<Row>, ShadowError> {
    let cases = [
        ("position is not a number", 0, f32::NAN),
        ("position is infinite", 0, f32::INFINITY),
        ("normal is not a number", 1, f32::NAN),
    ];
    let name = |kind: &str| format!("a pixel whose {kind}, order {order}");
    if !cases.iter().any(|(kind, ..)| wanted(only, &name(kind))) {
        return Ok(Vec::new());
    }
    let settings = Settings { order, reach: 0.0, ..Settings::default() };
    let pass = PixelShadow::new(trial.bench.context, settings)?;
    let blockers = Blockers::default();
    let spheres: Vec<Sphere> = (0..20).map(|i| sphere(2.0 + 0.1 * f64::from(i), 1.0)).collect();
    blockers.set(&spheres, DMat4::IDENTITY)?;
    let mut light = vec![[0.0; 3]; coefficient_count(order)];
    light[0] = [(4.0 * std::f64::consts::PI).sqrt(); 3];
    let (products, picture) = (Products::new(order, &light)?, PixelPicture::Light);
    let light = PixelLight { products, disc: None, picture };
    let places: Vec<[f32; 4]> = [0.0, 0.25, 0.5].map(|y| [0.0, y, 0.0, 1.0]).to_vec();
    let images = [places, vec![[1.0, 0.0, 0.0, 0.0]; 3]];
    let mut rows = Vec::new();
    let of = |images: &[Vec<[f32; 4]>; 2]| -> Result<Vec<f64>, ShadowError> {
        let pixels = trial.bench.pixels(&pass, [3, 1], [&images[0], &images[1]], &blockers, &light)?;
        Ok(pixels.as_flattened().iter().copied().map(f64::from).collect())
    };
    let alone = of(&images)?;
    for (kind, image, value) in cases.into_iter().filter(|(kind, ..)| wanted(only, &name(kind))) {
        let name = name(kind);
        let mut among = images.clone();
        among[image][1][1] = value;
        let found = of(&among)?;
        let expected = [&alone[..4], &[0.0; 4], &alone[8..]].concat();
        rows.push(row(
            &name,
            "the second of three under 20 spheres".to_owned(),
            format!("light {:.6}, {:.6}, {:.6}", found[0], found[4], found[8]),
            format!("light {:.6}, 0, {:.6}", alone[0], alone[8]),
            error(&found, &expected),
            1e-6,
            again(&name),
        ));
    }
    Ok(rows)
}

/// Visibility of all.
fn open_everywhere(order: usize) -> Vec<f64> {
    let mut all = vec![0.0; coefficient_count(order)];
    all[0] = (4.0 * std::f64::consts::PI).sqrt();
    all
}

/// Everything below the tangent plane of a receiver with a normal.
fn below(trial: &Trial<'_>, only: Option<&str>, order: usize) -> Result<Option<Row>, ShadowError> {
    let name = format!("all blockers below the horizon, order {order}");
    if !wanted(only, &name) {
        return Ok(None);
    }
    let place = |i: u32| Sphere {
        center: DVec3::new(2.0 * f64::from(i).sin(), -1.2 - 0.02 * f64::from(i), 2.0 * f64::from(i).cos()),
        radius: 1.0,
    };
    let spheres: Vec<Sphere> = (0..60).map(place).collect();
    let frame = trial.frame(order, true, Some([0.0, 1.0, 0.0]), &spheres)?;
    let found: Vec<f64> = frame.values.iter().copied().map(f64::from).collect();
    let all = open_everywhere(order);
    Ok(Some(row(
        &name,
        "60 spheres that do not reach the tangent plane".to_owned(),
        format!(
            "open {:.8}, {} of {} clusters out of reach",
            open(&found),
            frame.counts.open,
            frame.counts.clusters
        ),
        "open 1".to_owned(),
        error(&found, &all),
        1e-6,
        again(&name),
    )))
}

/// Vectors with norms up to 50, as many spheres give them: a mean far below 0, and bands in all directions.
fn long_vectors(trial: &Trial<'_>, only: Option<&str>, order: usize) -> Result<Vec<Row>, ShadowError> {
    let count = coefficient_count(order);
    let mut rows = Vec::new();
    for norm in [1.0, 10.0, 50.0] {
        let name = format!("a logarithm of norm {norm}, order {order}");
        if !wanted(only, &name) {
            continue;
        }
        let mut f: Vec<f64> = (0..count).map(|i| f64::from(1 + i as u32).sin()).collect();
        // No visibility is above 1: the mean of a logarithm outweighs the rest.
        f[0] = -2.0 * f.iter().map(|value| value * value).sum::<f64>().sqrt();
        let size = f.iter().map(|value| value * value).sum::<f64>().sqrt();
        f.iter_mut().for_each(|value| *value *= norm / size);
        let input = [ExponentialRow { order, f: f.clone(), method: Exponential::Adaptive }];
        let Some(found) = exponentials(trial.bench, &input)?.into_iter().next().transpose()? else {
            continue;
        };
        let truth = Evaluator::new(order)?.exponential(Exponential::Adaptive, &f)?;
        let scale = truth.iter().map(|value| value * value).sum::<f64>().sqrt().max(1.0);
        let cells: Vec<String> = f.iter().map(|value| format!("{value:e}")).collect();
        rows.push(row(
            &name,
            "the mean twice as long as all the rest together".to_owned(),
            format!("open {:.6e}", open(&found.values)),
            format!("open {:.6e}", open(&truth)),
            error(&found.values, &truth) / scale,
            EXPONENTIAL,
            format!(
                "printf 'order,f\\n{order},{}\\n' > rows.csv\n\
                 airglow eval sh-exp --in rows.csv --out results.csv --reference",
                cells.join(";")
            ),
        ));
    }
    Ok(rows)
}

/// A peak of 1e5 W/sr/m2 two degrees wide behind sixteen spheres: the product of light and visibility.
fn peak(trial: &Trial<'_>, only: Option<&str>, order: usize) -> Result<Option<Row>, ShadowError> {
    let name = format!("a peak of 1e5 W/sr/m2, order {order}");
    if !wanted(only, &name) {
        return Ok(None);
    }
    let axis = DVec3::new(0.6, 0.48, 0.64);
    let light = project(order, DEGREE, |direction| if direction.dot(axis) > 0.9994 { 1e5 } else { 1.0 })?;
    let place = |i: u32| Sphere {
        center: 3.0
            * (axis + 0.4 * DVec3::new(f64::from(i).sin(), f64::from(3 * i).cos(), f64::from(i).cos())),
        radius: 0.3,
    };
    let sky = Sky { order, spheres: (0..16).map(place).collect(), clamp: false };
    let (found, truth, _) = sky.visibility(trial)?;
    let dot = |v: &[f64]| light.iter().zip(v).map(|(l, v)| l * v).sum::<f64>();
    let all = light[0] * (4.0 * std::f64::consts::PI).sqrt();
    Ok(Some(row(
        &name,
        "light integrated over the sphere, behind 16 spheres, over the same without them".to_owned(),
        format!("{:.6}", dot(&found) / all),
        format!("{:.6}", dot(&truth) / all),
        (dot(&found) - dot(&truth)).abs() / all,
        BOUND,
        sky.again(&name),
    )))
}
