//! The shadowed bake of a mesh: checks, then blocks of vertices handed to the executor's threads.

use std::ops::ControlFlow;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use glam::Mat4;

use crate::mesh::Mesh;
use crate::vertices::Vertices;
use crate::{BakeError, Baked, Executor, Occluders, Progress, Report, Settings, Stats, Transfer};

/// Vertices a thread takes at a time.
const BLOCK: usize = 16;
/// Least time between two reports.
const REPORT_INTERVAL: Duration = Duration::from_millis(33);
/// Most vertices of one bake: the result of order 6 with visibility then takes 2^39 bytes at most.
const MAX_VERTICES: usize = 1 << 30;

/// Bakes the vertices of `mesh`, carried by `transform` to the space of the `occluders` (the identity in object
/// space, the world matrix for an instance), on the threads of `executor`. The vectors are in the directions of
/// that space. The same input gives the same bits on any number of threads.
///
/// # Errors
/// [`BakeError::Cancelled`] when `progress` asks for it; otherwise a faulty mesh, transform or setting, named.
pub fn bake(
    mesh: &Mesh<'_>,
    transform: Mat4,
    occluders: &Occluders<'_>,
    settings: &Settings,
    executor: &dyn Executor,
    progress: &mut dyn Progress,
) -> Result<Baked, BakeError> {
    settings.check()?;
    mesh.check()?;
    let vertex_count = mesh.positions.len();
    if vertex_count > MAX_VERTICES {
        return Err(BakeError::TooMany { what: "vertices", count: vertex_count, limit: MAX_VERTICES });
    }
    let vertices = Vertices::new(mesh, transform, occluders, settings)?;
    let values = vertex_count * settings.coefficient_count();
    let mut coefficients = vec![0.0; values];
    let mut visibility = settings.visibility.map(|_| vec![0.0; values]);
    let stats = run(&vertices, &mut coefficients, visibility.as_deref_mut(), executor, progress)?;
    let transfer = Transfer { order: settings.order, vertex_count, coefficients, visibility };
    Ok(Baked { transfer, stats })
}

/// Hands out blocks of vertices until none is left or the host cancels.
fn run(
    vertices: &Vertices<'_>,
    coefficients: &mut [f32],
    visibility: Option<&mut [f32]>,
    executor: &dyn Executor,
    progress: &mut dyn Progress,
) -> Result<Stats, BakeError> {
    let start = Instant::now();
    let block = BLOCK * vertices.coefficient_count();
    let mut visibility = visibility.map(|values| values.chunks_mut(block));
    let mut first = 0;
    let blocks = coefficients.chunks_mut(block).map(|transfer| {
        let here = first;
        first += BLOCK;
        (here, transfer, visibility.as_mut().and_then(Iterator::next).unwrap_or_default())
    });
    let blocks = Mutex::new(blocks);
    let account = Mutex::new(Account::new(vertices, progress, start));
    executor.run(&|| {
        while lock(&account).error.is_none() {
            let Some((first, transfer, visibility)) = lock(&blocks).next() else { break };
            let result = vertices.bake(first, transfer, visibility);
            lock(&account).add(transfer.len() / vertices.coefficient_count(), result);
        }
    });
    let mut account = account.into_inner().unwrap_or_else(PoisonError::into_inner);
    account.report();
    match account.error {
        Some(error) => Err(error),
        None => Ok(Stats { time: start.elapsed(), threads: executor.threads(), ..account.stats }),
    }
}

/// What the threads have done so far, and whether to go on.
struct Account<'a> {
    progress: &'a mut dyn Progress,
    stats: Stats,
    done: usize,
    vertex_count: usize,
    start: Instant,
    reported: Instant,
    error: Option<BakeError>,
}

impl<'a> Account<'a> {
    fn new(vertices: &Vertices<'_>, progress: &'a mut dyn Progress, start: Instant) -> Self {
        let (stats, vertex_count) = (Stats::default(), vertices.len());
        Self { progress, stats, done: 0, vertex_count, start, reported: start, error: None }
    }

    fn add(&mut self, vertices: usize, result: Result<Stats, BakeError>) {
        match result {
            Ok(stats) => {
                self.done += vertices;
                self.stats.rays += stats.rays;
                self.stats.blocked += stats.blocked;
                self.stats.zero_normals += stats.zero_normals;
            }
            Err(error) => self.error = Some(error),
        }
        if self.reported.elapsed() >= REPORT_INTERVAL {
            self.report();
        }
    }

    fn report(&mut self) {
        self.reported = Instant::now();
        let report = Report {
            vertices: self.done,
            vertex_count: self.vertex_count,
            rays: self.stats.rays,
            elapsed: self.start.elapsed(),
        };
        if self.error.is_none() && self.progress.report(&report) == ControlFlow::Break(()) {
            self.error = Some(BakeError::Cancelled);
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // A poisoned lock means a panic of the host's callback, which the executor passes on.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
