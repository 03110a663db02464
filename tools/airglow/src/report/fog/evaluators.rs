//! The pass's evaluator among its rivals: error over random rays against time.

use airglow::fog::Bench;
use airglow::fog::reference::table::Filter;
use airglow::fog::rivals::{Evaluator, Froxels, Round, Row, Track};
use airglow_gpu::Imports;
use airglow_graph::Graph;

use super::choice;
use super::picture::{Picture, SIDE};
use super::random::{self, Draw, Range};
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::output::Output;
use crate::report::interleave::{self, Rounds};
use crate::report::model::{Curve, Distribution, Errors, Point};
use crate::report::timed_plan::{self, TimedPlan};

/// Pixels of the picture that times are given for.
pub const PIXELS: u32 = 512 * 512;

/// The taps of the default preset.
pub const DEFAULT: Evaluator = Evaluator::Taps { count: 6 };

/// Lights that are timed for each ray read, so that the read does not hide what it is for.
pub const REPEATS: u32 = 8;

/// Steps of a frame, at most: a longer march is timed over fewer pixels.
const TIMED_STEPS: u32 = 1 << 20;

/// Its name among the points.
const DEPTH_FOG: &str = "depth fog";

/// Volumes of the curve of the picture.
const FROXELS: [Froxels; 2] = [Froxels { cells: [64; 3] }, Froxels { cells: [160, 90, 64] }];

/// Rays that a long march's error is taken over, at least.
const FEWEST: u32 = 1024;

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds of all rivals.
    pub rounds: Rounds,
    /// Steps over which errors of marches are taken.
    pub error_steps: u64,
    /// Longest march; software drivers end a loop after 65536 passes.
    pub longest: u32,
    /// Random rays against quadrature.
    pub rays: usize,
}

impl Effort {
    /// All, or enough to see the shape of the curves.
    pub fn new(quick: bool) -> Self {
        match quick {
            true => Self {
                rounds: Rounds { warm_up: 1, measured: 5 },
                error_steps: 1 << 24,
                longest: 1 << 14,
                rays: 1 << 16,
            },
            false => Self {
                rounds: Rounds { warm_up: 2, measured: 11 },
                error_steps: 1 << 28,
                longest: 1 << 16,
                rays: 1 << 20,
            },
        }
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

/// Every evaluator of the curve.
fn evaluators(longest: u32) -> Vec<Evaluator> {
    let mut all = vec![Evaluator::Nothing];
    let marches = (4..=16).step_by(2).map(|power| 1 << power).filter(|steps| *steps <= longest);
    all.extend(marches.map(|steps| Evaluator::March { steps }));
    all.extend([4, 8, 16, 64, 256].map(|steps| Evaluator::Equiangular { steps }));
    for filter in [Filter::Nearest, Filter::Bilinear] {
        all.extend([16, 32, 64, 128, 256].map(|size| Evaluator::Table { size, filter }));
    }
    all.push(Evaluator::Entries { size: 64 });
    all.extend([4, 7].map(|count| Evaluator::Poles { count }));
    all.extend([1, 2, 4, 6, 8, 12, 16].map(|count| Evaluator::Taps { count }));
    all
}

/// Those of the picture.
fn evaluators_of_picture() -> Vec<Evaluator> {
    let mut all = vec![Evaluator::Nothing, Evaluator::DepthFog];
    all.extend([8, 32, 128].map(|steps| Evaluator::March { steps }));
    all.extend([4, 16, 64].map(|steps| Evaluator::Equiangular { steps }));
    all.extend([64, 256].map(|size| Evaluator::Table { size, filter: Filter::Bilinear }));
    all.push(Evaluator::Entries { size: 64 });
    all.extend([4, 7].map(|count| Evaluator::Poles { count }));
    all.extend([1, 2, 4, 6, 8, 12, 16].map(|count| Evaluator::Taps { count }));
    all
}

impl Measurement<'_> {
    /// Error and time of all evaluators over random rays of a range, of one channel.
    pub fn evaluators(&self, name: &str, range: &Range) -> Outcome<Curve> {
        let draws = random::draws(range, PIXELS as usize)?;
        let rows: Vec<Row> = draws.iter().map(Draw::row).collect();
        let part = |evaluator: Evaluator| self.effort.error_steps / u64::from(evaluator.steps().max(1));
        let points = self.race(
            name,
            &Course { rows: &rows, lights: 1, coloured: false, picture: None },
            &evaluators(if range.optical[0] < 1e-3 { self.effort.longest } else { 1 << 12 }),
            |evaluator| part(evaluator).clamp(u64::from(FEWEST), u64::from(PIXELS)) as u32,
            |_, values| {
                let found = random::distribution(&draws, values.iter().map(|[red, ..]| f64::from(*red)))?;
                Ok((Errors { setting: Some(found.p99), ..Errors::default() }, Some(found)))
            },
        )?;
        let question = format!(
            "Which way to the airlight of a light, in a homogeneous medium that scatters alike in all directions? Each \
             runs in the same kernel on the same rays: {}. Setting error is the 99th percentile of the relative error.",
            range.words()
        );
        let norm = format!(
            "relative, against quadrature in f64 of relative tolerance 1e-12, over {PIXELS} rays whose truth is at \
             least {:e}, fewer for marches of more than {} steps; `below` is absolute",
            random::SMALLEST,
            self.effort.error_steps / u64::from(PIXELS)
        );
        self.curve(name, question, norm, "one extinction", points)
    }

    /// The same on a picture, of three channels.
    pub fn seen(&self, picture: &Picture) -> Outcome<Curve> {
        let lights = picture.view.lights.len() as u32;
        let points = self.race(
            "evaluator on the picture",
            &Course { rows: &picture.rows, lights, coloured: true, picture: Some(picture) },
            &evaluators_of_picture(),
            |_| PIXELS,
            |name, values| {
                // Its artist has seen the truth.
                let fitted = if name == DEPTH_FOG { picture.fit(&values) } else { values };
                let found = picture.errors(&fitted)?;
                Ok((Errors { setting: Some(found.largest), ..Errors::default() }, Some(found)))
            },
        )?;
        let question = format!(
            "What do the same cost and miss on {}? Neighbouring rays are alike, and of three channels.",
            picture.words()
        );
        let norm = "setting: largest error against quadrature in f64, in half 8-bit steps of the exposed pixel over \
                    black surfaces; below 1 it is not seen";
        self.curve("evaluator on the picture", question, norm.to_owned(), "three extinctions", points)
    }

    fn curve(
        &self,
        name: &str,
        question: String,
        norm: String,
        channels: &str,
        points: Vec<Point>,
    ) -> Outcome<Curve> {
        let setting = DEFAULT.to_string();
        let comparisons = interleave::compare(&points, &setting).map_err(Failure::work)?;
        Ok(Curve {
            knob: name.to_owned(),
            question: format!(
                "{question} `reads alone` and `two fetches` compute nothing: they are what cannot be undercut."
            ),
            norm,
            timed: format!(
                "{PIXELS} pixels, {channels}, device time of one light; scaled where fewer pixels ran"
            ),
            chosen: choice::of(&points, &setting),
            points,
            comparisons,
        })
    }

    /// Runs the evaluators once for their error and in turn for their time.
    fn race(
        &self,
        name: &str,
        course: &Course<'_>,
        evaluators: &[Evaluator],
        pixels: impl Fn(Evaluator) -> u32,
        error: impl Fn(&str, Vec<[f32; 3]>) -> Outcome<(Errors, Option<Distribution>)>,
    ) -> Outcome<Vec<Point>> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let track = bench.track(course.rows, PIXELS).map_err(Failure::work)?;
        let (mut plans, mut points) = (Vec::new(), Vec::new());
        for &evaluator in evaluators {
            let of_error = pixels(evaluator);
            self.plan(&bench, &track, course, evaluator, [of_error, 1])?.run(self.device)?;
            let (error, distribution) = match evaluator {
                Evaluator::Nothing | Evaluator::Entries { .. } => (Errors::default(), None),
                _ => error(
                    &evaluator.to_string(),
                    bench.airlight_of(&track, of_error).map_err(Failure::work)?,
                )?,
            };
            let (setting, memory) = (evaluator.to_string(), evaluator.memory());
            let (milliseconds, counts) = (Vec::new(), Default::default());
            points.push(Point { setting, milliseconds, memory, counts, error, distribution });
            plans.push(self.plan(&bench, &track, course, evaluator, course.timed(evaluator))?);
        }
        if let Some(picture) = course.picture {
            for froxels in FROXELS {
                let mut plan = self.froxels(&bench, &track, picture, froxels)?;
                plan.run(self.device)?;
                let (error, distribution) =
                    error(&froxels.name(), bench.airlight_of(&track, PIXELS).map_err(Failure::work)?)?;
                let (milliseconds, counts) = (Vec::new(), Default::default());
                let (setting, memory) = (froxels.name(), froxels.memory());
                points.push(Point { setting, milliseconds, memory, counts, error, distribution });
                plans.push(plan);
            }
        }
        let times = timed_plan::measure(self.device, name, &mut plans, self.effort.rounds, self.output)?;
        let bytes = size_of_val(course.rows) as u64 + 16 * u64::from(PIXELS);
        for ((point, plan), milliseconds) in points.iter_mut().zip(&plans).zip(times) {
            (point.milliseconds, point.counts) = (milliseconds, plan.counts(bytes));
        }
        Ok(points)
    }

    fn plan(
        &self,
        bench: &Bench<'_>,
        track: &Track,
        course: &Course<'_>,
        evaluator: Evaluator,
        [pixels, repeats]: [u32; 2],
    ) -> Outcome<TimedPlan> {
        let (mut graph, mut imports) = (Graph::new(), Imports::new());
        let lights = course.lights;
        let round = Round { pixels, lights, stride: PIXELS, mask: u32::MAX, steps: 0, repeats };
        let rival = (evaluator, course.coloured);
        bench.add_rival(&mut graph, &mut imports, track, rival, round).map_err(Failure::work)?;
        let plan = TimedPlan::new(self.device, evaluator.to_string(), graph, imports)?;
        Ok(plan.of_part(f64::from(lights * repeats) * f64::from(pixels) / f64::from(PIXELS)))
    }
}

impl Measurement<'_> {
    /// A volume for all lights of a picture; its time is divided by them.
    fn froxels(
        &self,
        bench: &Bench<'_>,
        track: &Track,
        picture: &Picture,
        froxels: Froxels,
    ) -> Outcome<TimedPlan> {
        let (mut graph, mut imports) = (Graph::new(), Imports::new());
        let view = (&picture.view, SIDE);
        bench.add_froxels(&mut graph, &mut imports, track, froxels, view).map_err(Failure::work)?;
        let plan = TimedPlan::new(self.device, froxels.name(), graph, imports)?;
        Ok(plan.of_part(picture.view.lights.len() as f64))
    }
}

/// What the evaluators run on.
struct Course<'a> {
    /// Rays: all pixels of the first light, then all of the next.
    rows: &'a [Row],
    lights: u32,
    coloured: bool,
    /// Where the rays are of one: a volume needs its view.
    picture: Option<&'a Picture>,
}

impl Course<'_> {
    /// Pixels that are timed, and how often each row is used. A part of a picture is not like the rest.
    fn timed(&self, evaluator: Evaluator) -> [u32; 2] {
        if self.picture.is_some() {
            return [PIXELS, 1];
        }
        let steps = evaluator.steps().max(1);
        let repeats = if steps > 4096 { 1 } else { REPEATS };
        [(TIMED_STEPS / (repeats * steps)).clamp(64, PIXELS), repeats]
    }
}
