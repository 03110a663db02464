//! Where the work runs: on threads of this crate for the length of one call, or on the host's own.

use std::num::NonZeroUsize;

/// Runs the workers of a bake. The host may bring its own job system.
pub trait Executor {
    /// Calls `worker` one or more times, on as many threads at once as there are to spare, and returns after
    /// every call has returned. A call takes work until none is left, so that one call alone finishes the
    /// bake, and later calls return at once. The result does not depend on how many there are.
    fn run(&self, worker: &(dyn Fn() + Sync));

    /// How many threads work at once, for reports.
    fn threads(&self) -> usize;
}

/// Scoped threads that end with the call: `Threads(1)` runs on the caller's thread alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threads(pub NonZeroUsize);

impl Threads {
    /// One thread: the caller's.
    pub const ONE: Self = Self(NonZeroUsize::MIN);

    /// `count` threads, at least one.
    #[must_use]
    pub fn new(count: usize) -> Self {
        Self(NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN))
    }
}

impl Executor for Threads {
    fn run(&self, worker: &(dyn Fn() + Sync)) {
        std::thread::scope(|scope| {
            for _ in 1..self.0.get() {
                // A thread the system refuses is work for the others, not an error.
                let _ = std::thread::Builder::new().spawn_scoped(scope, worker);
            }
            worker();
        });
    }

    fn threads(&self) -> usize {
        self.0.get()
    }
}
