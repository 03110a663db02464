//! A mesh as a grid of cells: which are inside, by the parity of its crossings along the three axes, two of which must agree
//! so that a hole does not turn a line of cells inside out, and points on its surface and within.

use glam::DVec3;

use crate::Sphere;

/// The cells around a mesh.
pub(super) struct Voxels {
    low: DVec3,
    side: f64,
    size: [usize; 3],
    inside: Vec<bool>,
}

impl Voxels {
    /// `resolution` cells along the longest side.
    pub(super) fn new(triangles: &[[DVec3; 3]], points: &[DVec3], resolution: usize) -> Self {
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let side = ((high - low).max_element() / resolution as f64).max(1e-12);
        let size = ((high - low) / side).to_array().map(|cells| cells as usize + 1);
        let mut votes = vec![0_u8; size.iter().product()];
        let grid = Self { low, side, size, inside: Vec::new() };
        for axis in 0..3 {
            grid.count_parity(triangles, axis, &mut votes);
        }
        Self { inside: votes.into_iter().map(|votes| votes >= 2).collect(), ..grid }
    }

    /// Volume of a cell.
    fn cell(&self) -> f64 {
        self.side.powi(3)
    }

    fn center(&self, cell: [usize; 3]) -> DVec3 {
        self.low + self.side * (DVec3::from_array(cell.map(|c| c as f64)) + 0.5)
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Adds a vote to every cell behind an odd number of crossings along an axis.
    fn count_parity(&self, triangles: &[[DVec3; 3]], axis: usize, votes: &mut [u8]) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); self.size[u] * self.size[v]];
        // A little off the centres, so that no line meets an edge of a mesh that is aligned with the grid.
        let line = |along: usize, at: usize| {
            self.low[along] + self.side * (at as f64 + 0.500_137 + 0.000_071 * along as f64)
        };
        for triangle in triangles {
            let range = |along: usize| {
                let values = triangle.map(|corner| (corner[along] - self.low[along]) / self.side - 0.5);
                let low = values.iter().copied().fold(f64::INFINITY, f64::min).floor().max(0.0) as usize;
                let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil().max(0.0) as usize;
                low..(high + 1).min(self.size[along])
            };
            for (i, j) in range(u).flat_map(|i| range(v).map(move |j| (i, j))) {
                if let Some(depth) = crossing(triangle, [u, v, axis], line(u, i), line(v, j)) {
                    crossings[j * self.size[u] + i].push(depth);
                }
            }
        }
        for (at, depths) in crossings.into_iter().enumerate() {
            for step in 0..self.size[axis] {
                let place = self.low[axis] + self.side * (step as f64 + 0.5);
                if depths.iter().filter(|depth| **depth < place).count() % 2 == 1 {
                    let mut cell = [0; 3];
                    (cell[u], cell[v], cell[axis]) = (at % self.size[u], at / self.size[u], step);
                    votes[self.index(cell)] += 1;
                }
            }
        }
    }

    /// Centres of the cells inside.
    pub(super) fn inner(&self) -> Vec<DVec3> {
        let all = (0..self.inside.len()).filter(|&at| self.inside[at]);
        all.map(|at| {
            let [x, y, _] = self.size;
            self.center([at % x, at / x % y, at / (x * y)])
        })
        .collect()
    }

    /// Volume of a sphere outside the mesh.
    pub(super) fn outside(&self, sphere: &Sphere) -> f64 {
        let volume = 4.0 / 3.0 * std::f64::consts::PI * sphere.radius.powi(3);
        let range = |axis: usize| {
            let place = (sphere.center[axis] - self.low[axis]) / self.side;
            let reach = sphere.radius / self.side;
            ((place - reach).max(0.0) as usize)
                ..((place + reach + 1.0).max(0.0) as usize).min(self.size[axis])
        };
        let mut inside = 0_usize;
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let near =
                        (self.center([x, y, z]) - sphere.center).length_squared() <= sphere.radius.powi(2);
                    inside += usize::from(near && self.inside[self.index([x, y, z])]);
                }
            }
        }
        (volume - inside as f64 * self.cell()).max(0.0)
    }

    /// Volume inside the mesh.
    pub(super) fn volume(&self) -> f64 {
        self.inside.iter().filter(|inside| **inside).count() as f64 * self.cell()
    }

    /// Points of the triangles, none farther than a cell from the next, at most one for each eighth of a cell.
    pub(super) fn surface(&self, triangles: &[[DVec3; 3]]) -> Vec<DVec3> {
        let mut seen = std::collections::BTreeSet::new();
        let mut points = Vec::new();
        for [a, b, c] in triangles {
            let longest = (*b - *a).length().max((*c - *b).length()).max((*a - *c).length());
            let steps = ((longest / self.side).ceil() as usize).clamp(1, 256);
            for (i, j) in (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| (i, j))) {
                let (s, t) = (i as f64 / steps as f64, j as f64 / steps as f64);
                let point = *a + s * (*b - *a) + t * (*c - *a);
                let key = ((point - self.low) / self.side * 2.0).to_array().map(|place| place as i64);
                if seen.insert(key) {
                    points.push(point);
                }
            }
        }
        points
    }
}

/// Where a line along the third axis meets a triangle.
fn crossing(triangle: &[DVec3; 3], [u, v, w]: [usize; 3], x: f64, y: f64) -> Option<f64> {
    let [a, b, c] = triangle;
    let edge = |p: &DVec3, q: &DVec3| (q[u] - p[u]) * (y - p[v]) - (q[v] - p[v]) * (x - p[u]);
    let (at_c, at_a, at_b) = (edge(a, b), edge(b, c), edge(c, a));
    let area = at_a + at_b + at_c;
    let one_side = (at_a >= 0.0 && at_b >= 0.0 && at_c >= 0.0) || (at_a <= 0.0 && at_b <= 0.0 && at_c <= 0.0);
    (one_side && area != 0.0).then(|| (at_a * a[w] + at_b * b[w] + at_c * c[w]) / area)
}
