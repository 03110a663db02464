//! Soft shadows on extreme inputs and through their limits: the device against f64.

mod inputs;
mod meshes;
mod sweeps;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use airglow::shadow::bench::{Bench, Frame, Scene, SphereKernel};
use airglow::shadow::reference::{Reference, caps, rms};
use airglow::shadow::{Cap, Exponential, PixelShadow, Settings, Shadow, ShadowError, Sphere};
use glam::DVec3;

use super::{Arguments, Row, Table};
use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::device;
use crate::output::Output;

/// Root mean square over the sphere that the device's visibility may be off the reference's: its tables of caps are linear
/// between their entries.
const BOUND: f64 = 2e-3;

/// Runs the inputs and sweeps that were asked for.
pub(super) fn attempt(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Table> {
    let only = arguments.case.as_deref();
    let requirements = Shadow::requirements().and(&PixelShadow::requirements());
    device::with(global, &requirements, |device| {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        let trial = Trial { bench: &bench, passes: RefCell::default(), references: RefCell::default() };
        output.say("trying extreme inputs");
        let mut rows = inputs::rows(&trial, only).map_err(Failure::work)?;
        rows.extend(meshes::rows(only));
        output.say("sweeping limits");
        let sweeps = sweeps::tables(&trial, only).map_err(Failure::work)?;
        Ok(Table { pass: arguments.pass.name(), machine: device.machine(), rows, sweeps })
    })
}

/// Whether something of that name was asked for.
fn wanted(only: Option<&str>, name: &str) -> bool {
    only.is_none_or(|only| only == name)
}

/// The device, with the passes that were made for earlier inputs.
struct Trial<'a> {
    bench: &'a Bench<'a>,
    /// By order, and whether they clamp and take normals.
    passes: RefCell<BTreeMap<(usize, bool, bool), Shadow>>,
    references: RefCell<BTreeMap<usize, Reference>>,
}

impl Trial<'_> {
    /// Visibility under some caps, by the pass's own way in f64.
    fn reference(&self, order: usize, caps: &[Cap]) -> Result<Vec<f64>, ShadowError> {
        let mut references = self.references.borrow_mut();
        let reference = match references.entry(order) {
            Entry::Occupied(made) => made.into_mut(),
            Entry::Vacant(place) => place.insert(Reference::new(order)?),
        };
        reference.visibility(Exponential::Adaptive, caps)
    }

    /// Visibility of a receiver at the origin, with its normal where it has one.
    fn frame(
        &self,
        order: usize,
        clamp: bool,
        normal: Option<[f32; 3]>,
        spheres: &[Sphere],
    ) -> Result<Frame, ShadowError> {
        let pass = self.pass(order, clamp, normal.is_some())?;
        let normals = normal.as_slice();
        let normals = (!normals.is_empty()).then_some(normals);
        self.bench.frame(&pass, &Scene { positions: &[[0.0; 3]], normals, spheres }, 1)
    }

    /// Visibility of several receivers in the air, clamped.
    fn receivers(
        &self,
        order: usize,
        positions: &[[f32; 3]],
        spheres: &[Sphere],
    ) -> Result<Vec<f64>, ShadowError> {
        let pass = self.pass(order, true, false)?;
        let frame = self.bench.frame(&pass, &Scene { positions, normals: None, spheres }, 1)?;
        Ok(frame.values.into_iter().map(f64::from).collect())
    }

    /// A pass that was made before, or a new one.
    fn pass(&self, order: usize, clamp: bool, normals: bool) -> Result<Shadow, ShadowError> {
        let key = (order, clamp, normals);
        if let Some(pass) = self.passes.borrow().get(&key) {
            return Ok(pass.clone());
        }
        let settings = Settings { order, clamp, normals, reach: 0.0, ..Settings::default() };
        let pass = self.bench.shadow(settings, SphereKernel::Pass)?;
        self.passes.borrow_mut().insert(key, pass.clone());
        Ok(pass)
    }
}

/// A receiver at the origin under some spheres.
#[derive(Clone, Debug)]
struct Sky {
    order: usize,
    spheres: Vec<Sphere>,
    clamp: bool,
}

impl Sky {
    /// Visibility by the device and by the reference, and receivers clamped by the device.
    fn visibility(&self, trial: &Trial<'_>) -> Result<(Vec<f64>, Vec<f64>, u64), ShadowError> {
        let frame = trial.frame(self.order, self.clamp, None, &self.spheres)?;
        let caps = caps(&self.spheres, DVec3::ZERO);
        let truth = trial.reference(self.order, &caps)?;
        Ok((frame.values.iter().copied().map(f64::from).collect(), truth, frame.counts.clamped))
    }

    /// The command lines that evaluate it again; for more spheres than fit a line, the case itself.
    fn again(&self, case: &str) -> String {
        if self.spheres.len() > 64 {
            return again(case);
        }
        let numbers = |sphere: &Sphere| sphere.center.extend(sphere.radius).to_array();
        let spheres: Vec<String> =
            self.spheres.iter().flat_map(numbers).map(|number| format!("{number:e}")).collect();
        format!(
            "printf 'order,px,py,pz,spheres\\n{},0,0,0,{}\\n' > rows.csv\n\
             airglow eval shadow-spheres --in rows.csv --out results.csv --reference",
            self.order,
            spheres.join(";")
        )
    }
}

/// The command that runs a case again.
fn again(case: &str) -> String {
    format!("airglow stability shadow --case '{case}'")
}

/// A row of the table.
fn row(
    name: &str,
    input: String,
    result: String,
    truth: String,
    error: f64,
    bound: f64,
    again: String,
) -> Row {
    let pass = error <= bound;
    Row { name: name.to_owned(), input, result, truth, error, bound, pass, reproduce: again }
}

/// Root mean square of the difference; infinite for what is not finite.
fn error(found: &[f64], truth: &[f64]) -> f64 {
    if found.iter().all(|value| value.is_finite()) { rms(found, truth) } else { f64::INFINITY }
}

/// The share of the sky that a visibility leaves.
fn open(visibility: &[f64]) -> f64 {
    visibility.first().map_or(f64::NAN, |mean| mean / (4.0 * std::f64::consts::PI).sqrt())
}
