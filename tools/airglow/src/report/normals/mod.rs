//! The report on normal maps: every way to filter them against the mean of their texels, by error, time and memory.

mod errors;
mod numbers;
mod presets;
mod shading;
mod steps;
mod workload;

use airglow::normals::{Brdf, Method, Normals, Settings, choose};
use airglow_gpu::Requirements;

pub use workload::Map;

use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::output::Output;
use crate::report::interleave::{self, Rounds};
use crate::report::model::{Choice, Curve, Errors, Number, Point};

/// Materials of the report: matt, moderately glossy, glossy, and facets with long tails.
const BRDFS: [Brdf; 5] = [
    Brdf::Lambert,
    Brdf::BlinnPhong { exponent: 10.0 },
    Brdf::BlinnPhong { exponent: 50.0 },
    Brdf::BlinnPhong { exponent: 200.0 },
    Brdf::Ggx { alpha: 0.2 },
];
/// Error that a setting is chosen for.
const AIM: f64 = 0.05;
/// Bytes of a texel and array layer.
const LAYER: u64 = 8;

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds of all methods.
    pub rounds: Rounds,
    /// Texels of each map.
    pub texels: u32,
    /// Columns and rows of the map whose build is timed.
    pub side: usize,
}

impl Effort {
    /// All, or enough to see the shape of the curves.
    pub fn new(quick: bool) -> Self {
        match quick {
            true => Self { rounds: Rounds { warm_up: 1, measured: 3 }, texels: 30, side: 256 },
            false => Self { rounds: Rounds { warm_up: 1, measured: 11 }, texels: 120, side: 1024 },
        }
    }

    /// Rounds of builds, which take seconds.
    fn build_rounds(&self) -> Rounds {
        Rounds { warm_up: 1, measured: self.rounds.measured.min(3) }
    }
}

/// What the curves are measured with.
pub struct Measurement<'a> {
    /// The device.
    pub device: &'a Device<'a>,
    /// How much is measured.
    pub effort: Effort,
    /// Where progress goes.
    pub output: &'a Output,
}

/// What a report is made of.
pub struct Measured {
    /// What a reader must know.
    pub remarks: Vec<String>,
    /// The curves.
    pub curves: Vec<Curve>,
    /// What the pass is held to.
    pub numbers: Vec<Number>,
}

impl Measurement<'_> {
    /// Everything.
    pub fn all(&self, maps: &[Map]) -> Outcome<Measured> {
        let mut curves = Vec::new();
        let mut remarks = vec![
            "Memory held: the texture from level 1 of the map on, four halves a texel and array layer.".to_owned(),
            "Model error: over random texels of levels 2 to 7, lights and views, half of them near the highlight, on the \
             device, against the mean radiance of all texels of the map under each."
                .to_owned(),
        ];
        let mut numbers = vec![numbers::concentration()];
        for map in maps {
            let of_map = self.methods(map, &BRDFS)?;
            for (curve, brdf) in of_map.iter().zip(BRDFS) {
                remarks.push(numbers::where_each_wins(curve));
                numbers.extend(numbers::of(curve, brdf)?);
            }
            curves.extend(of_map);
        }
        if let Some(map) = maps.last() {
            let (curve, build) = self.steps(map)?;
            curves.push(curve);
            numbers.extend(build);
        }
        Ok(Measured { remarks, curves, numbers })
    }

    /// Every method on each map with its own material alone.
    pub fn explain(&self, maps: &[Map]) -> Outcome<Vec<Curve>> {
        let curves = maps.iter().map(|map| self.methods(map, &[map.brdf]));
        Ok(curves.collect::<Outcome<Vec<_>>>()?.concat())
    }

    /// Error, time and memory of every method on a map, a curve for each material.
    fn methods(&self, map: &Map, brdfs: &[Brdf]) -> Outcome<Vec<Curve>> {
        let errors = errors::of_map(self.device, map, brdfs, self.effort.texels)?;
        let of_brdf = |(brdf, errors): (&Brdf, Vec<f64>)| {
            let times = shading::times(self, map, *brdf, &Method::ALL)?;
            let points =
                Method::ALL.into_iter().zip(errors).zip(times).map(|((method, error), (ms, counts))| Point {
                    setting: method.to_string(),
                    milliseconds: ms,
                    memory: memory(map, method),
                    counts,
                    error: Errors { model: Some(error), ..Errors::default() },
                    distribution: None,
                });
            self.curve(map, *brdf, points.collect())
        };
        brdfs.iter().zip(errors).map(of_brdf).collect()
    }

    fn curve(&self, map: &Map, brdf: Brdf, points: Vec<Point>) -> Outcome<Curve> {
        let chosen = choose(&map.normals, brdf, AIM).map_err(Failure::work)?;
        let setting = chosen.method.to_string();
        let comparisons = interleave::compare(&points, &setting).map_err(Failure::work)?;
        let reason = match chosen.within {
            true => format!("it takes least of those within {:.0} % on its own texels", 100.0 * AIM),
            false => format!("none is within {:.0} % on its own texels, and it errs least", 100.0 * AIM),
        };
        Ok(Curve {
            knob: format!("{}, {}", map.name, words(brdf)),
            question: "What is to be kept of the normals under a texel? vmf:J are J lobes, vmf:4x4 four lobes at four \
                       places, sh:n n bands, the others keep a mean normal or its slope."
                .to_owned(),
            norm: "relative L2 of the radiance".to_owned(),
            timed: format!(
                "device time of looking up, bilinear in one level, and shading one light at {0} x {0} pixels",
                shading::SIDE
            ),
            points,
            chosen: Some(Choice { setting, reason }),
            comparisons,
        })
    }
}

/// What the device must offer.
pub fn requirements() -> Requirements {
    Normals::requirements(&Settings::default())
}

/// A material in words.
pub fn words(brdf: Brdf) -> String {
    match brdf {
        Brdf::Lambert => "Lambert".to_owned(),
        Brdf::BlinnPhong { exponent } => format!("Blinn-Phong {exponent}"),
        Brdf::Ggx { alpha } => format!("GGX {alpha:.2}"),
    }
}

/// Bytes of the texture of a method, as it is sampled.
fn memory(map: &Map, method: Method) -> u64 {
    let layers = method.numbers().div_ceil(4) as u64;
    let normals = &map.normals;
    let texels: usize =
        (1..normals.levels()).map(|level| normals.size(level).iter().product::<usize>()).sum();
    LAYER * layers * texels as u64
}
