//! The tables of Sun 2005, chapter 4, on a device: `cargo run --release -p airglow-radiance --example tables`.
//!
//! Scenes are files of `assets/scenes`, with meshes like those of the thesis and emitters as its text describes them;
//! those whose mesh is not shipped are run where the folder of data is. Error: root mean square of the linear colour's
//! difference from that of a sample at each vertex, over the root mean square of the latter; truth and samples have faces
//! of one size. Times are of a submission from the CPU's side, medians of five, on the device of the tests, validation
//! included. Words choose tables: armadillo, nave, buddha, buddha-fine.

use airglow_gpu::{GpuError, Recorder};
use airglow_radiance::gpu::bench::Bench;
use airglow_radiance::{Oracle, PassSettings, Radiance, Settings};
use airglow_tests::device::fixture_with;

#[path = "common/lab.rs"]
mod lab;
#[expect(dead_code, reason = "another example reads the rest")]
#[path = "common/scene.rs"]
mod scene;

use lab::{Lab, Outcome};
use scene::{Failure, Placed};

/// As the thesis has it, whose oracle believes what a sample sees.
const BELIEVING: f64 = 0.0;

fn main() -> Result<(), Failure> {
    let fixture = fixture_with(&Radiance::requirements(&PassSettings::default()));
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let chosen: Vec<String> = std::env::args().skip(1).collect();
    let wanted = |name: &str| chosen.is_empty() || chosen.iter().any(|word| word == name);
    if wanted("armadillo") {
        let data = Some("mesh/armadillo_10k.glb");
        with_lab(&bench, "armadillo", data, 32, |lab| compare(lab, &[130, 250]))?;
    }
    if wanted("nave") {
        with_lab(&bench, "nave-near", None, 16, |lab| {
            compare(lab, &[160, 500])?;
            near_and_far(lab)
        })?;
    }
    let data = Some("mesh/buddha_50k.glb");
    if wanted("buddha") {
        with_lab(&bench, "buddha", data, 16, |lab| bounds(lab, &[0.1, 0.03, 0.01, 0.003, 0.001]))?;
    }
    if wanted("buddha-fine") {
        // The bounds of the thesis.
        with_lab(&bench, "buddha-fine", data, 8, |lab| bounds(lab, &[0.04, 0.02, 0.01]))?;
    }
    Ok(())
}

fn with_lab(
    bench: &Bench<'_>,
    name: &str,
    data: Option<&str>,
    face: u32,
    run: impl Fn(&Lab<'_>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let Some(placed) = Placed::load(name, data)? else { return Ok(()) };
    let (lab, seconds) = Lab::new(bench, &placed, face)?;
    let (vertices, triangles) = (placed.positions.len(), placed.emitters.len());
    println!(
        "{name}: {vertices} vertices, {triangles} emitter triangles, faces of {face} texels with 4 x 4 rays"
    );
    println!("  a sample at each vertex: {seconds:.2} s of sampling");
    run(&lab)
}

/// Tables 4.1 and 4.2: the pass, the thesis's own method and even samples, at about as many samples.
fn compare(lab: &Lab<'_>, counts: &[usize]) -> Result<(), Failure> {
    for &count in counts {
        let even = lab.even(count)?;
        let mut rivals = Vec::new();
        for power in [1, 2, 4] {
            let outcome = lab.rival(&even, power)?;
            print(&format!("even, 1/d^{power}"), &outcome);
            rivals.push(outcome);
        }
        for (name, oracle) in
            [("thesis, eq. 3.3 as printed", Oracle::Printed), ("thesis, eq. 3.3 as argued", Oracle::Argued)]
        {
            let settings = Settings { oracle, stride: 1, hidden: BELIEVING, ..Settings::default() };
            let settings = lab.settings_for(count, settings)?;
            let refined = lab.refined(settings, false)?;
            let (samples, error) = (refined.samples.len(), lab.inverse(&refined)?);
            println!("  {name:30} {samples:5} samples, error {error:.4}, weighed on the CPU");
        }
        for (name, hidden) in [("ours, as the thesis", BELIEVING), ("ours", Settings::default().hidden)] {
            let settings = lab.settings_for(count, Settings { hidden, ..Settings::default() })?;
            for gradients in [false, true] {
                let with = if gradients { ", gradients" } else { "" };
                let outcome = lab.pass(settings, gradients)?;
                print(&format!("{name}{with}, bound {:.1e}", settings.bound), &outcome);
                let errors: Vec<_> =
                    rivals.iter().map(|rival| format!("{:.2}", outcome.error / rival.error)).collect();
                let race = lab.race(settings, gradients, &even)?;
                println!(
                    "      {} of the even ones' errors; vertices {:.1} ({:.1} to {:.1}) times as fast",
                    errors.join(", "),
                    race.estimate,
                    race.low,
                    race.high
                );
            }
        }
    }
    Ok(())
}

/// Table 4.3: samples of one bound for near emitters and for far ones.
fn near_and_far(lab: &Lab<'_>) -> Result<(), Failure> {
    let Some(far) = Placed::load("nave-far", None)? else { return Ok(()) };
    let settings = Settings { bound: 1e-3, limit: 1 << 14, ..Settings::default() };
    let near = lab.pass(settings, true)?;
    print("near, bound 1e-3", &near);
    println!("  far, the same bound: {} samples", lab.samples_for(&far.emitters, settings)?);
    Ok(())
}

/// Table 4.4: error against bound.
fn bounds(lab: &Lab<'_>, bounds: &[f64]) -> Result<(), Failure> {
    for &bound in bounds {
        let settings = Settings { bound, limit: 1 << 14, ..Settings::default() };
        print(&format!("bound {bound:.0e}, gradients"), &lab.pass(settings, true)?);
    }
    Ok(())
}

fn print(name: &str, outcome: &Outcome) {
    let Outcome { samples, limited, error, sampling, reconstruction } = outcome;
    let limited = if *limited { " (stopped by the limit)" } else { "" };
    println!(
        "  {name:36} {samples:5} samples{limited}, error {error:.4}, sampling {sampling:.3} s, vertices {:.1} ms",
        1e3 * reconstruction
    );
}
