//! The curves: one for each knob, and one for the shapes of the kernel.

use airglow::relight::rivals::{self as contestants, Rival as Contestant, Task};
use airglow::relight::{Bench, Method, Settings, Storage};

use airglow_math::sequence::{hammersley, uniform_sphere};

use super::choice;
use super::effort::Effort;
use super::errors;
use super::rivals::{self, Timed, Transfer};
use super::vectors::{FULL_ORDER, truncate};
use super::workload::Workload;
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::output::Output;
use crate::report::interleave;
use crate::report::model::{Choice, Curve, Errors, Point};

/// Normals of the skinned mesh that is timed, repeated for all its vertices.
const NORMALS: u32 = 4096;

/// What the curves are measured with.
pub struct Measurement<'a> {
    /// The device.
    pub device: &'a Device<'a>,
    /// What is lit.
    pub workload: &'a Workload,
    /// How much is measured.
    pub effort: &'a Effort,
    /// Where progress goes.
    pub output: &'a Output,
}

impl Measurement<'_> {
    /// Orders 1 to 6, with the converged number of rays.
    pub fn order(&self) -> Outcome<Curve> {
        let settings =
            (1..=FULL_ORDER).map(|order| (order.to_string(), Settings { order, ..Settings::default() }));
        let points = self.frame_points("orders", settings.collect())?;
        let chosen = choice::climb(&points)?;
        let question = format!(
            "How many bands of spherical harmonics are worth their bytes? The memory grows with the square. {}",
            choice::rule()
        );
        self.curve("order", &question, points, chosen)
    }

    /// Storage of the transfer vectors.
    pub fn storage(&self) -> Outcome<Curve> {
        let setting = |name: &str, storage| (name.to_owned(), Settings { storage, ..Settings::default() });
        let points =
            self.frame_points("storage", vec![setting("f32", Storage::F32), setting("f16", Storage::F16)])?;
        let reason = "exact to 1e-5; f16 halves the transfer where its error of up to 1e-3 is accepted";
        let chosen = Choice { setting: "f32".to_owned(), reason: reason.to_owned() };
        self.curve("storage", "What do half floats cost and save?", points, Some(chosen))
    }

    /// Compute against the papers' fragment pass.
    pub fn method(&self) -> Outcome<Curve> {
        let setting = |name: &str, method| (name.to_owned(), Settings { method, ..Settings::default() });
        let settings = vec![setting("compute", Method::Compute), setting("fragment", Method::Fragment)];
        let points = self.frame_points("methods", settings)?;
        let chosen = choice::fastest(&points, "compute")?;
        let question = "Compute into the vertex buffer, or the papers' fragment pass over a packed rectangle and a copy?";
        self.curve("method", question, points, chosen)
    }

    /// Baked vectors against the transfer that a kernel makes from current normals.
    pub fn source(&self) -> Outcome<Curve> {
        let (baked, skinned) = (Settings::default(), Settings { normals: true, ..Settings::default() });
        let vectors = truncate(&self.workload.converged, baked.order);
        let light = self.workload.light_of(baked.order);
        let normals: Vec<[f32; 3]> =
            (0..NORMALS).map(|i| uniform_sphere(hammersley(i, NORMALS)).as_vec3().to_array()).collect();
        let sources = [
            ("baked vectors", baked, Transfer::Baked(&vectors)),
            ("current normals", skinned, Transfer::Normals(&normals)),
        ];
        let vertices = self.effort.vertices;
        let all = sources.map(|(name, settings, transfer)| {
            rivals::relight(self.device, name, settings, transfer, light, vertices)
        });
        let all = all.into_iter().collect::<Outcome<_>>()?;
        let timed = rivals::measure(self.device, "sources", all, self.effort.rounds, self.output)?;
        let points: Vec<Point> = timed.into_iter().map(|timed| point(timed, Errors::default())).collect();
        let question = "What does the transfer of skinned meshes cost, which a kernel makes from the normals of the frame, \
                        without shadow, beside reading vectors that were baked?";
        let comparisons = interleave::compare(&points, sources[1].0).map_err(Failure::work)?;
        Ok(Curve {
            knob: "source of transfer".to_owned(),
            question: question.to_owned(),
            norm: "none: they answer different questions, and tests hold each to its own reference"
                .to_owned(),
            timed: format!(
                "rotation of the light and the kernel over {vertices} vertices, device time of a frame; memory held is \
                 that of vectors or normals, and of results"
            ),
            points,
            chosen: None,
            comparisons,
        })
    }

    /// Layouts, workgroups and vertices of an invocation, beside moving the same bytes without arithmetic.
    pub fn shape(&self, storage: Storage) -> Outcome<Curve> {
        let vertices = self.effort.vertices;
        let contestants: Vec<_> =
            contestants::all().into_iter().filter(|contestant| contestant.storage == storage).collect();
        let all = contestants.iter().map(|contestant| rivals::contestant(self.device, contestant, vertices));
        let name = if storage == Storage::F16 { "kernel shape, f16" } else { "kernel shape, f32" };
        let all = all.collect::<Outcome<_>>()?;
        let timed = rivals::measure(self.device, name, all, self.effort.rounds, self.output)?;
        let points: Vec<Point> = timed.into_iter().map(|timed| point(timed, Errors::default())).collect();
        let chosen = contestants.iter().position(Contestant::is_default).map(|shipped| Choice {
            setting: contestants[shipped].name(),
            reason: against_bytes(&contestants, &points, shipped),
        });
        let chosen = chosen.map(|choice| Self::measured_on(choice, &self.device.machine().device));
        let comparisons = match &chosen {
            Some(choice) => interleave::compare(&points, &choice.setting).map_err(Failure::work)?,
            None => Vec::new(),
        };
        let order = contestants::ORDER;
        Ok(Curve {
            knob: name.to_owned(),
            question: format!(
                "Which layout, vertices of an invocation and workgroup are fastest at order {order}? All give the same \
                 bits. `Move` reads the same words and writes as many without the arithmetic; `Copy` is \
                 vkCmdCopyBuffer of as many bytes."
            ),
            norm: "none: every shape gives the same colours".to_owned(),
            timed: format!("the kernel over {vertices} vertices, device time"),
            comparisons,
            chosen,
            points,
        })
    }

    /// Points of settings of the pass: device time of a frame, and all three errors.
    pub(super) fn frame_points(&self, what: &str, settings: Vec<(String, Settings)>) -> Outcome<Vec<Point>> {
        let full = &self.workload.converged;
        let best = Settings { order: FULL_ORDER, ..Settings::default() };
        let converged = self.colours(best, full)?;
        let mut all = Vec::new();
        let mut found = Vec::new();
        for (name, settings) in settings {
            let vectors = truncate(full, settings.order);
            let light = self.workload.light_of(settings.order);
            let vertices = self.effort.vertices;
            let transfer = Transfer::Baked(&vectors);
            all.push(rivals::relight(self.device, name, settings, transfer, light, vertices)?);
            let colours = self.colours(settings, full)?;
            found.push(errors::of(&colours, settings.order, full, &converged, self.workload)?);
        }
        let timed = rivals::measure(self.device, what, all, self.effort.rounds, self.output)?;
        Ok(timed.into_iter().zip(found).map(|(timed, error)| point(timed, error)).collect())
    }

    /// The pass's colours with these settings and vectors of full order.
    pub(super) fn colours(&self, settings: Settings, vectors: &[f32]) -> Outcome<Vec<[f32; 3]>> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        errors::colours(&bench, settings, self.workload, vectors)
    }

    /// The choice with the name of what it was measured on.
    pub(super) fn measured_on(choice: Choice, device: &str) -> Choice {
        let reason = choice.reason.trim_end_matches([' ', ';']);
        Choice { reason: format!("{reason}. Measured on {device}."), ..choice }
    }

    pub(super) fn curve(
        &self,
        knob: &str,
        question: &str,
        points: Vec<Point>,
        chosen: Option<Choice>,
    ) -> Outcome<Curve> {
        let chosen = chosen.map(|choice| Self::measured_on(choice, &self.device.machine().device));
        let comparisons = match &chosen {
            Some(choice) => interleave::compare(&points, &choice.setting).map_err(Failure::work)?,
            None => Vec::new(),
        };
        Ok(Curve {
            knob: knob.to_owned(),
            question: question.to_owned(),
            norm: errors::norm(self.workload),
            timed: format!(
                "rotation of the light and the kernel over {} vertices, device time of a frame; memory held is that \
                 of vectors and results, read + written are the bytes of a frame: equal where a frame moves each byte \
                 held once",
                self.effort.vertices
            ),
            points,
            chosen,
            comparisons,
        })
    }
}

pub(super) fn point(timed: Timed, error: Errors) -> Point {
    Point {
        setting: timed.name,
        milliseconds: timed.milliseconds,
        memory: timed.memory,
        counts: timed.counts,
        error,
        distribution: None,
    }
}

/// How the shipped shape stands to the fastest one, to the fastest kernel that only moves bytes, and to the copy.
fn against_bytes(contestants: &[Contestant], points: &[Point], shipped: usize) -> String {
    let median = |place: usize| points.get(place)?.time().map(|time| time.median);
    let best = |task: Task| {
        let places = (0..contestants.len()).filter(|&place| contestants[place].task == task);
        let timed = places.filter_map(|place| Some((median(place)?, contestants[place].name())));
        timed.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (Some(mine), Some(colour), Some(bytes), Some(copy)) =
        (median(shipped), best(Task::Colour), best(Task::Move), best(Task::Copy))
    else {
        return "not measured".to_owned();
    };
    let rate = points[shipped].counts.bytes as f64 / (1e6 * mine);
    format!(
        "{mine:.4} ms, {rate:.1} GB/s: {:.2} times the fastest shape ({}), {:.2} times the fastest kernel that only \
         moves the bytes ({}), {:.2} times vkCmdCopyBuffer of as many bytes",
        mine / colour.0,
        colour.1,
        mine / bytes.0,
        bytes.1,
        mine / copy.0
    )
}
