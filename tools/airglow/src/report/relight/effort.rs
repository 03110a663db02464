//! How much the report on relighting measures.

use crate::report::interleave::Rounds;

/// Rays, vertices and rounds.
#[derive(Clone, Debug)]
pub struct Effort {
    /// Rays for each vertex of the bakes compared, ascending.
    pub rays: Vec<u32>,
    /// Rays for each vertex of the ray-traced truth, and of the converged bake: at least four times the most of
    /// `rays`.
    pub truth_rays: u32,
    /// Vertices lit: a larger mesh is thinned to about as many.
    pub lit: usize,
    /// Vertices whose bake is timed, about.
    pub timed_bake: usize,
    /// How often each bake is timed.
    pub bake_rounds: Rounds,
    /// Vertices that frame times are measured at.
    pub vertices: usize,
    /// Rounds of interleaved timing of frames.
    pub rounds: Rounds,
}

impl Effort {
    /// What a committed report is made with, or with `quick` enough to see the shape of the curves.
    pub fn new(quick: bool) -> Self {
        let (timed_bake, vertices) = (512, 100_000);
        if quick {
            return Self {
                rays: vec![64, 256, 1024],
                truth_rays: 4096,
                lit: 4096,
                timed_bake,
                bake_rounds: Rounds { warm_up: 0, measured: 5 },
                vertices,
                rounds: Rounds { warm_up: 2, measured: 9 },
            };
        }
        Self {
            rays: vec![64, 256, 1024, 4096, 16_384],
            truth_rays: 65_536,
            lit: 16_384,
            timed_bake,
            bake_rounds: Rounds { warm_up: 1, measured: 9 },
            vertices,
            rounds: Rounds { warm_up: 3, measured: 41 },
        }
    }
}
