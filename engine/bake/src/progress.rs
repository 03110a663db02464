//! How far a bake is, and the wish to stop it.

use std::ops::ControlFlow;
use std::time::Duration;

/// State of a running bake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Vertices finished.
    pub vertices: usize,
    /// Vertices in all.
    pub vertex_count: usize,
    /// Rays traced so far.
    pub rays: u64,
    /// Time since the first ray.
    pub elapsed: Duration,
}

impl Report {
    /// Rays per second so far, over all threads; 0 before the first.
    #[must_use]
    pub fn rays_per_second(&self) -> f64 {
        let seconds = self.elapsed.as_secs_f64();
        if seconds > 0.0 { self.rays as f64 / seconds } else { 0.0 }
    }

    /// Time left at the rate so far; `None` before the first vertex.
    #[must_use]
    pub fn time_left(&self) -> Option<Duration> {
        let share = self.vertices as f64 / self.vertex_count.max(1) as f64;
        (share > 0.0)
            .then(|| self.elapsed.as_secs_f64() * (1.0 - share) / share)
            .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
    }
}

/// Told how far a bake is, about every thirtieth of a second and at its end, by one thread at a time.
pub trait Progress: Send {
    /// Returning [`ControlFlow::Break`] ends the bake with [`crate::BakeError::Cancelled`] within one block of
    /// vertices per thread.
    fn report(&mut self, report: &Report) -> ControlFlow<()>;
}

/// Says nothing and never cancels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&mut self, _: &Report) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: FnMut(&Report) -> ControlFlow<()> + Send> Progress for F {
    fn report(&mut self, report: &Report) -> ControlFlow<()> {
        self(report)
    }
}
