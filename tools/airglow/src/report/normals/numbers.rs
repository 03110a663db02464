//! The numbers that the pass is held to, and where each method wins.

use airglow::normals::vmf::{concentration_by_polynomial, mean_length};
use airglow::normals::{Brdf, Method};

use crate::failure::{Failure, Outcome};
use crate::report::interleave::paired;
use crate::report::model::{Curve, Number, Point};

/// Bytes of a texel at which methods are compared: one, two and four array layers.
const LAYERS: [u64; 3] = [1, 2, 4];
/// Times at which they are, as multiples of Toksvig's.
const TIMES: [f64; 3] = [1.3, 2.0, 4.0];

/// The concentration of a lobe from the length of its mean.
pub fn concentration() -> Number {
    let worst =
        (0..=4000).map(|i| 10_f64.powf(-1.5 + 5.5 * f64::from(i) / 4000.0)).map(|k| (k, mean_length(k)));
    let worst = worst.filter(|(_, r)| (0.01..=0.999).contains(r));
    let worst = worst.map(|(k, r)| (concentration_by_polynomial(r) / k - 1.0).abs()).fold(0.0, f64::max);
    Number {
        what: "concentration of a lobe from the length of its mean, largest relative error".to_owned(),
        asked: "at most 2.5e-3 from 0.01 to 0.999".to_owned(),
        measured: format!("{worst:.1e}"),
        holds: worst <= 2.5e-3,
    }
}

/// What the methods of a curve are held to.
pub fn of(curve: &Curve, brdf: Brdf) -> Outcome<Vec<Number>> {
    let point = |method: Method| named(curve, method);
    let error = |method| Ok::<_, Failure>(point(method)?.error.model.unwrap_or(f64::INFINITY));
    let four = Method::Lobes(4);
    let mut numbers = Vec::new();
    let mut number = |what: String, asked: f64, found: f64| {
        numbers.push(Number {
            what: format!("{}: {what}", curve.knob),
            asked: format!("at most {:.0} %", 100.0 * asked),
            measured: format!("{:.2} %", 100.0 * found),
            holds: found <= asked,
        });
    };
    if brdf == Brdf::Lambert {
        number("error of three bands".to_owned(), 0.04, error(Method::Harmonics(3))?);
        let best = curve.points.iter().filter_map(|point| point.error.model).fold(f64::INFINITY, f64::min);
        number("least error of all".to_owned(), 0.01, best);
        return Ok(numbers);
    }
    let asked = if matches!(brdf, Brdf::BlinnPhong { exponent } if exponent <= 50.0) { 0.05 } else { 0.08 };
    number("error of 4 lobes".to_owned(), asked, error(four)?);
    number("error of 4 lobes at four places".to_owned(), asked, error(Method::Taps)?);
    let of_rivals = error(four)? / error(Method::Toksvig)?.min(error(Method::Lean)?);
    numbers.push(Number {
        what: format!("{}: error of 4 lobes over that of Toksvig and LEAN", curve.knob),
        asked: "at most 0.2 on maps of several modes".to_owned(),
        measured: format!("{of_rivals:.3}"),
        holds: of_rivals <= 0.2,
    });
    let ratio = paired(point(four)?, point(Method::Toksvig)?).map_err(Failure::work)?;
    numbers.push(Number {
        what: format!("{}: time of 4 lobes over Toksvig's", curve.knob),
        asked: "at most 3 on a software driver, 2 on a GPU".to_owned(),
        measured: format!("{:.2} ({:.2} to {:.2})", ratio.ratio, ratio.interval[0], ratio.interval[1]),
        holds: ratio.ratio <= 3.0,
    });
    Ok(numbers)
}

/// The best method at equal memory and at equal time.
pub fn where_each_wins(curve: &Curve) -> String {
    let smallest = curve.points.iter().map(|point| point.memory).min().unwrap_or(0);
    let median = |point: &Point| point.time().map_or(f64::INFINITY, |time| time.median);
    let toksvig = named(curve, Method::Toksvig).map_or(f64::INFINITY, median);
    let best = |within: &dyn Fn(&Point) -> bool| {
        let error = |point: &&Point| point.error.model.unwrap_or(f64::INFINITY);
        let found = curve.points.iter().filter(|point| within(point));
        let found = found.min_by(|a, b| error(a).total_cmp(&error(b)));
        found.map_or("none".to_owned(), |point| format!("{} {:.1} %", point.setting, 100.0 * error(&point)))
    };
    let memory = LAYERS.map(|layers| {
        format!("{} bytes a texel: {}", 8 * layers, best(&|point| point.memory <= layers * smallest))
    });
    let time = TIMES.map(|times| {
        format!("{times} times Toksvig's time: {}", best(&|point| median(point) <= times * toksvig))
    });
    format!("{}: least error in {}; in {}.", curve.knob, memory.join(", "), time.join(", "))
}

fn named(curve: &Curve, method: Method) -> Outcome<&Point> {
    let name = method.to_string();
    let found = curve.points.iter().find(|point| point.setting == name);
    found.ok_or_else(|| Failure::work(format!("the curve of {} lacks {name}", curve.knob)))
}
