//! `cargo run --release -p airglow-shadow --example speed [ORDER [SPHERES]]`: on the device that tests use, time and error of the sum of
//! logarithms with one exponential, and of chained products, over 1 to 200 blockers at orders 3 to 6; time of each generated
//! product and square, and how long the driver compiles each kernel.

use std::cell::RefCell;

use airglow_gpu::{GpuError, Recorder};
use airglow_math::statistics::paired_ratio_interval;
use airglow_shadow::bench::{RowKernel, SphereKernel};
use airglow_shadow::families::figure;
use airglow_shadow::reference::{caps, rms, truth};
use airglow_shadow::spheres::Hierarchy;
use airglow_shadow::{Bench, Blockers, Exponential, Settings, Shadow, ShadowError, Sphere};
use airglow_tests::device::fixture_with;
use glam::{DMat4, DVec3};

/// Receivers of a scene: a square of ground, so many that what a frame costs without any does not count.
const RECEIVERS: usize = 40_000;
/// Runs of a frame; the least of them counts.
const RUNS: usize = 15;
/// Rows of a product.
const ROWS: usize = 16_384;

/// As hosts run it: with ratios, and a cut of the hierarchy for each cluster.
const HIERARCHY: &str = "default, hierarchy";

/// Ways in the table.
fn ways() -> [(&'static str, SphereKernel, Exponential); 7] {
    [
        ("products", SphereKernel::Products, Exponential::Adaptive),
        ("logarithm alone", SphereKernel::Logarithm, Exponential::Adaptive),
        ("default", SphereKernel::Pass, Exponential::Adaptive),
        ("PS*-2", SphereKernel::Pass, Exponential::ScaledSeries { degree: 2 }),
        ("squares", SphereKernel::Pass, Exponential::Horner { degree: 2, norm: 0.25 }),
        ("OL", SphereKernel::Pass, Exponential::OptimalLinear),
        (HIERARCHY, SphereKernel::Pass, Exponential::Adaptive),
    ]
}

fn ground() -> Vec<[f32; 3]> {
    let side = RECEIVERS.isqrt();
    (0..RECEIVERS)
        .map(|i| {
            [4.0 * (i % side) as f32 / side as f32 - 2.0, 0.0, 4.0 * (i / side) as f32 / side as f32 - 2.0]
        })
        .collect()
}

fn least(times: &[f64]) -> f64 {
    times.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Seconds that all threads of this process have run: unlike the time on the wall, what other programs take is not in it.
fn processor_time() -> f64 {
    let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let nanoseconds = threads.filter_map(|thread| {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<u64>().ok()
    });
    1e-9 * nanoseconds.sum::<u64>() as f64
}

/// A bench, and the processor time of each frame that it ran.
struct Stopwatch<'a> {
    bench: Bench<'a>,
    taken: &'a RefCell<Vec<f64>>,
}

impl Stopwatch<'_> {
    /// What `frames` gives, and the times of its runs; what it reads back afterwards is not among them.
    fn time<T>(
        &self,
        frames: impl FnOnce(&Bench<'_>) -> Result<T, ShadowError>,
    ) -> Result<(T, Vec<f64>), ShadowError> {
        self.taken.take();
        let made = frames(&self.bench)?;
        let mut times = self.taken.take();
        times.truncate(RUNS);
        Ok((made, times))
    }
}

fn main() -> Result<(), ShadowError> {
    let fixture = fixture_with(&Shadow::requirements());
    let taken = RefCell::<Vec<f64>>::default();
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        let begin = processor_time();
        let done = fixture.device().run(fixture.context(), |recorder| record(recorder));
        taken.borrow_mut().push(processor_time() - begin);
        done
    };
    let watch = Stopwatch { bench: Bench { context: fixture.context(), run: &run }, taken: &taken };
    // One order and one number of spheres, or all.
    let chosen: Vec<usize> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let wanted = |place: usize, value: usize| chosen.get(place).is_none_or(|chosen| *chosen == value);
    let positions = ground();
    for order in (3..=6).filter(|order| wanted(0, *order)) {
        products(&watch, order)?;
        for count in [1, 5, 15, 60, 200].into_iter().filter(|count| wanted(1, *count)) {
            scene(&watch, order, &figure(count), &positions)?;
        }
    }
    Ok(())
}

/// Time of products and squares.
fn products(watch: &Stopwatch<'_>, order: usize) -> Result<(), ShadowError> {
    println!("order {order}: kernel, ns a row, first run ms (driver's compiler)");
    let rows: Vec<f32> = (0..ROWS * order * order)
        .map(|i| if i % (order * order) == 0 { 3.5 } else { ((i * 37 % 101) as f32 - 50.0) * 1e-5 })
        .collect();
    for (name, kernel) in
        [("product", RowKernel::Product as fn(u32) -> RowKernel), ("square", RowKernel::Square)]
    {
        let (_, one) = watch.time(|bench| bench.rows(order, kernel(1), &rows, RUNS))?;
        let (_, many) = watch.time(|bench| bench.rows(order, kernel(9), &rows, RUNS))?;
        let each = (least(&many) - least(&one)) / (8 * ROWS) as f64;
        println!("  {name:16} {:9.1}  {:8.1}", 1e9 * each, 1e3 * (one[0] - least(&one)));
    }
    Ok(())
}

/// A way, ready to be run over a scene.
struct Rival {
    name: &'static str,
    pass: Shadow,
    blockers: Blockers,
    /// Processor time of its first run, seconds.
    first: f64,
    error: Option<f64>,
    /// Of its runs, each one of a round in which all ways run once.
    times: Vec<f64>,
}

/// Every way over one scene: time, first run, error over 64 receivers. Ways take turns, so that what else runs on the
/// machine meets all of them; a ratio is the median of those of rounds, with the interval that holds it.
fn scene(
    watch: &Stopwatch<'_>,
    order: usize,
    spheres: &[Sphere],
    positions: &[[f32; 3]],
) -> Result<(), ShadowError> {
    let probes: Vec<usize> = (0..64).map(|i| i * positions.len() / 64 + 17 * i % 90).collect();
    let truths = probes
        .iter()
        .map(|&at| truth(order, 200, &caps(spheres, DVec3::from_array(positions[at].map(f64::from)))))
        .collect::<Result<Vec<_>, _>>()?;
    let (alone, nodes) = (Blockers::default(), Blockers::default());
    alone.set(spheres, DMat4::IDENTITY)?;
    nodes.set_nodes(&Hierarchy::new(spheres, order)?.posed(spheres)?, DMat4::IDENTITY)?;
    let mut rivals = Vec::new();
    for (name, kernel, exponential) in ways() {
        let hierarchy = name == HIERARCHY;
        // Nothing is culled but by the hierarchy.
        let settings = Settings { order, exponential, reach: 0.0, clamp: false, ..Default::default() };
        let blockers = if hierarchy { &nodes } else { &alone };
        let pass = watch.bench.shadow(settings, kernel)?;
        let (frame, times) = watch.time(|bench| bench.blocked(&pass, positions, None, blockers, 1))?;
        let width = order * order;
        let row =
            |at: usize| frame.values[at * width..][..width].iter().map(|v| f64::from(*v)).collect::<Vec<_>>();
        let error = probes.iter().zip(&truths).map(|(&at, truth)| rms(&row(at), truth)).sum::<f64>() / 64.0;
        let error = (kernel != SphereKernel::Logarithm).then_some(error);
        rivals.push(Rival {
            name,
            pass,
            blockers: blockers.clone(),
            first: times[0],
            error,
            times: Vec::new(),
        });
    }
    for _ in 0..RUNS {
        for rival in &mut rivals {
            let run = |bench: &Bench<'_>| bench.blocked(&rival.pass, positions, None, &rival.blockers, 1);
            rival.times.push(watch.time(run)?.1[0]);
        }
    }
    println!(
        "order {order}, {} spheres, {} receivers: ns a receiver, products over it and 95 %, first run ms, RMS error",
        spheres.len(),
        positions.len()
    );
    let chained = rivals[0].times.clone();
    for rival in &rivals {
        let of_all = |time: f64| 1e9 * time / positions.len() as f64;
        let ratio = paired_ratio_interval(&chained, &rival.times, 0.95, 1000, 1)?;
        let least = least(&rival.times);
        let error = rival.error.map_or("-".to_owned(), |error| format!("{error:.5}"));
        println!(
            "  {:18} {:9.1}  {:6.2} {:6.2} to {:5.2}  {:8.1}  {error}",
            rival.name,
            of_all(least),
            ratio.estimate,
            ratio.low,
            ratio.high,
            1e3 * (rival.first - least)
        );
    }
    Ok(())
}
