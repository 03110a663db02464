//! What a bake returns.

use std::time::Duration;

/// Transfer vectors of a mesh, in the host's vertex order: the colour of a white diffuse surface at vertex p
/// under the light vector l is t_p · l (thesis eq. 2.28 and 5.14: the vectors carry 1/π and no albedo).
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// Bands; a vector has order² coefficients, coefficient l(l+1)+m first by l, then by m.
    pub order: usize,
    /// Number of vectors.
    pub vertex_count: usize,
    /// `[vertex][coefficient]`, vertex_count · order² values.
    pub coefficients: Vec<f32>,
    /// Static visibility projected on the same basis, same shape, when it was asked for.
    pub visibility: Option<Vec<f32>>,
}

impl Transfer {
    /// Coefficients per vertex.
    #[must_use]
    pub fn coefficient_count(&self) -> usize {
        self.order * self.order
    }

    /// Transfer vector of one vertex; empty when there is no such vertex.
    #[must_use]
    pub fn vector(&self, vertex: usize) -> &[f32] {
        row(&self.coefficients, self.coefficient_count(), vertex)
    }

    /// Visibility vector of one vertex; empty when there is none.
    #[must_use]
    pub fn visibility_vector(&self, vertex: usize) -> &[f32] {
        row(self.visibility.as_deref().unwrap_or(&[]), self.coefficient_count(), vertex)
    }
}

fn row(values: &[f32], width: usize, vertex: usize) -> &[f32] {
    let start = vertex.saturating_mul(width);
    values.get(start..start.saturating_add(width)).unwrap_or(&[])
}

/// What a bake did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stats {
    /// Rays traced.
    pub rays: u64,
    /// Rays that met an occluder.
    pub blocked: u64,
    /// Vertices whose normal is zero: their vectors are zero.
    pub zero_normals: usize,
    /// Wall-clock time of the vertices, without building the hierarchy.
    pub time: Duration,
    /// Threads the executor said it runs.
    pub threads: usize,
}

impl Stats {
    /// Rays per second over all threads, ray generation and accumulation included; 0 if none were traced.
    #[must_use]
    pub fn rays_per_second(&self) -> f64 {
        let seconds = self.time.as_secs_f64();
        if seconds > 0.0 { self.rays as f64 / seconds } else { 0.0 }
    }
}

/// A bake's result and its account.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// The vectors.
    pub transfer: Transfer,
    /// The account.
    pub stats: Stats,
}
