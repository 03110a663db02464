//! A mesh to spheres that bound it, with little volume outside.
//!
//! After Wang, Zhou, Snyder, Liu, Bao, Peng and Guo, "Variational Sphere Set Approximation for Solid Objects" (2006): points
//! on the surface and within are assigned to spheres, spheres are fitted to their points, and a sphere that is hardly needed
//! is moved to where most volume lies outside. Points go to the sphere of the least power distance here, and volumes are
//! those of a grid.

use glam::DVec3;

use super::ball::{around, farthest};
use super::parallel;
use super::voxels::Voxels;
use crate::{ShadowError, Sphere};

/// How a mesh is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FitSettings {
    /// Spheres, 1 to 1024.
    pub spheres: usize,
    /// Teleports that are tried, 0 to 1000.
    pub teleports: usize,
    /// Cells along the longest side, 8 to 128.
    pub resolution: usize,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self { spheres: 64, teleports: 40, resolution: 48 }
    }
}

/// What a fit gave.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereSet {
    /// The spheres, which hold all vertices together.
    pub spheres: Vec<Sphere>,
    /// The sphere of each vertex.
    pub assignment: Vec<u32>,
    /// Sum over the spheres of the volume outside the mesh; what several share counts for each.
    pub outside: f64,
    /// Volume of the mesh; 0 for an open one without inside.
    pub volume: f64,
}

/// Points and their spheres.
#[derive(Clone)]
struct State {
    spheres: Vec<Sphere>,
    energy: f64,
}

/// Steps of assigning and refitting after the start and after a teleport.
const LLOYD: usize = 12;

/// Fits spheres to a mesh; deterministic. `progress` hears how many of the teleports are done.
///
/// # Errors
/// [`ShadowError::Range`] for settings, positions that are not finite and indices out of range, [`ShadowError::Length`]
/// for no vertices and indices that are no triangles.
pub fn fit(
    positions: &[[f32; 3]],
    indices: &[u32],
    settings: &FitSettings,
    progress: &mut dyn FnMut(usize),
) -> Result<SphereSet, ShadowError> {
    settings.check()?;
    let (vertices, triangles) = checked(positions, indices)?;
    let voxels = Voxels::new(&triangles, &vertices, settings.resolution);
    let mut points = voxels.surface(&triangles);
    points.extend(voxels.inner());
    if triangles.is_empty() {
        points.extend(&vertices);
    }
    let mut state = start(&points, settings.spheres);
    state.settle(&points, &voxels);
    for round in 0..settings.teleports {
        let Some(mut moved) = state.teleported(&points, &voxels, round) else { break };
        moved.settle(&points, &voxels);
        if moved.better_than(&state) {
            state = moved;
        }
        progress(round + 1);
    }
    Ok(state.finish(&vertices, &voxels))
}

impl FitSettings {
    fn check(&self) -> Result<(), ShadowError> {
        let within = |what, value: usize, low: usize, high: usize, range| match (low..=high).contains(&value)
        {
            true => Ok(()),
            false => Err(ShadowError::Range { what, value: value as f64, range }),
        };
        within("the number of spheres", self.spheres, 1, 1024, "1 to 1024")?;
        within("the number of teleports", self.teleports, 0, 1000, "0 to 1000")?;
        within("the resolution of the grid", self.resolution, 8, 128, "8 to 128")
    }
}

/// Vertices, and triangles that are not mere points, in f64.
fn checked(positions: &[[f32; 3]], indices: &[u32]) -> Result<(Vec<DVec3>, Vec<[DVec3; 3]>), ShadowError> {
    let vertices: Vec<DVec3> = positions.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
    if vertices.is_empty() {
        return Err(ShadowError::Length { what: "vertices", expected: 1, actual: 0 });
    }
    if let Some(at) = vertices.iter().position(|vertex| !vertex.is_finite()) {
        let (what, value) = ("a vertex that is not finite, by its index,", at as f64);
        return Err(ShadowError::Range { what, value, range: "finite positions" });
    }
    let (triples, rest) = indices.as_chunks::<3>();
    if !rest.is_empty() {
        let (what, expected, actual) = ("indices of whole triangles", 3 * (triples.len() + 1), indices.len());
        return Err(ShadowError::Length { what, expected, actual });
    }
    let corner = |index: u32| {
        let value = f64::from(index);
        let range = "an index of a vertex";
        vertices.get(index as usize).copied().ok_or(ShadowError::Range { what: "an index", value, range })
    };
    let triangle = |&[a, b, c]: &[u32; 3]| Ok([corner(a)?, corner(b)?, corner(c)?]);
    let triangles = triples.iter().map(triangle).collect::<Result<Vec<_>, ShadowError>>()?;
    Ok((vertices, triangles))
}

/// Seeds that are far from one another: each the farthest point from those before it.
fn start(points: &[DVec3], count: usize) -> State {
    let mut seeds = Vec::with_capacity(count);
    let mut distances = vec![f64::INFINITY; points.len()];
    let mut next = points.first().copied();
    while let (Some(seed), true) = (next, seeds.len() < count) {
        seeds.push(Sphere { center: seed, radius: 0.0 });
        for (distance, point) in distances.iter_mut().zip(points) {
            *distance = distance.min((*point - seed).length_squared());
        }
        let far = (0..points.len()).reduce(|a, b| if distances[b] > distances[a] { b } else { a });
        next = far.filter(|far| distances[*far] > 0.0).map(|far| points[far]);
    }
    State { spheres: seeds, energy: f64::INFINITY }
}

impl State {
    /// The sphere of the least power distance to a point.
    fn nearest(&self, point: DVec3) -> usize {
        let power =
            |sphere: &Sphere| (point - sphere.center).length_squared() - sphere.radius * sphere.radius;
        let mut best = (f64::INFINITY, 0);
        for (at, sphere) in self.spheres.iter().enumerate() {
            let power = power(sphere);
            if power < best.0 {
                best = (power, at);
            }
        }
        best.1
    }

    fn groups(&self, points: &[DVec3]) -> Vec<Vec<DVec3>> {
        let mut groups = vec![Vec::new(); self.spheres.len()];
        let nearest = parallel::map(points, |point| self.nearest(*point));
        for (&point, at) in points.iter().zip(nearest) {
            groups[at].push(point);
        }
        groups
    }

    /// Assigns and refits; keeps the best of what is passed through. Spheres without points are put where most volume lies
    /// outside.
    fn settle(&mut self, points: &[DVec3], voxels: &Voxels) {
        let count = self.spheres.len();
        let mut best = self.clone();
        for _ in 0..LLOYD {
            let groups = self.groups(points);
            let filled: Vec<Vec<DVec3>> = groups.into_iter().filter(|group| !group.is_empty()).collect();
            self.spheres = parallel::map(&filled, |group| around(group));
            let outside = parallel::map(&self.spheres, |sphere| voxels.outside(sphere));
            self.energy = outside.iter().sum();
            if self.better_than(&best) {
                best = self.clone();
            }
            let mut worst: Vec<usize> = (0..filled.len()).collect();
            worst.sort_by(|a, b| outside[*b].total_cmp(&outside[*a]).then(a.cmp(b)));
            for at in worst.into_iter().take(count - filled.len()) {
                if let Some([first, second]) = self.halves(at, &filled[at]) {
                    self.spheres[at] = first;
                    self.spheres.push(second);
                }
            }
        }
        *self = best;
    }

    /// With more spheres, or as many and less outside; anything is better than what has not been fitted yet.
    fn better_than(&self, other: &Self) -> bool {
        let [here, there] = [self, other].map(|state| state.spheres.len());
        other.energy.is_infinite() || here > there || (here == there && self.energy < other.energy)
    }

    /// A sphere cut in two, by the points of its group that are farthest apart.
    fn halves(&self, at: usize, group: &[DVec3]) -> Option<[Sphere; 2]> {
        let Sphere { center, radius } = self.spheres[at];
        let first = farthest(group, center)?;
        let second = farthest(group, first)?;
        Some([first, second].map(|end| Sphere { center: end.lerp(center, 0.5), radius: 0.5 * radius }))
    }

    /// Takes the sphere away whose points others take up with the least, and cuts the one in two with most outside. Later
    /// rounds take the next in line, so that a move that failed is not tried again.
    fn teleported(&self, points: &[DVec3], voxels: &Voxels, round: usize) -> Option<Self> {
        if self.spheres.len() < 2 {
            return None;
        }
        let outside: Vec<f64> = self.spheres.iter().map(|sphere| voxels.outside(sphere)).collect();
        let mut worst: Vec<usize> = (0..outside.len()).collect();
        worst.sort_by(|a, b| outside[*b].total_cmp(&outside[*a]).then(a.cmp(b)));
        let split = *worst.get(round % 4)?;
        // A small sphere near another is given up most cheaply.
        let cost = |at: usize| {
            let sphere = self.spheres[at];
            let others = self.spheres.iter().enumerate().filter(|(other, _)| *other != at);
            let reach = |other: &Sphere| {
                let grown = ((sphere.center - other.center).length() + sphere.radius).max(other.radius);
                grown.powi(3) - other.radius.powi(3)
            };
            others.map(|(_, other)| reach(other)).fold(f64::INFINITY, f64::min) - sphere.radius.powi(3)
        };
        let mut cheap: Vec<(f64, usize)> =
            (0..self.spheres.len()).filter(|at| *at != split).map(|at| (cost(at), at)).collect();
        cheap.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (_, gone) = *cheap.get((round / 4) % cheap.len().min(4))?;
        let [first, second] = self.halves(split, &self.groups(points).swap_remove(split))?;
        let mut spheres = self.spheres.clone();
        (spheres[split], spheres[gone]) = (first, second);
        Some(Self { spheres, energy: f64::INFINITY })
    }

    /// Grows the spheres around all vertices.
    fn finish(mut self, vertices: &[DVec3], voxels: &Voxels) -> SphereSet {
        let assignment: Vec<u32> = vertices.iter().map(|vertex| self.nearest(*vertex) as u32).collect();
        for (vertex, at) in vertices.iter().zip(&assignment) {
            if let Some(sphere) = self.spheres.get_mut(*at as usize) {
                sphere.radius = sphere.radius.max((*vertex - sphere.center).length());
            }
        }
        let outside = self.spheres.iter().map(|sphere| voxels.outside(sphere)).sum();
        SphereSet { spheres: self.spheres, assignment, outside, volume: voxels.volume() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box from the origin, twelve triangles.
    fn block(size: [f32; 3]) -> (Vec<[f32; 3]>, Vec<u32>) {
        let corner = |i: usize| std::array::from_fn(|axis| if i >> axis & 1 == 1 { size[axis] } else { 0.0 });
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let indices = faces.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
        ((0..8).map(corner).collect(), indices)
    }

    fn fitted(positions: &[[f32; 3]], indices: &[u32], spheres: usize) -> SphereSet {
        let settings = FitSettings { spheres, teleports: 12, resolution: 24 };
        let set = fit(positions, indices, &settings, &mut |_| ()).unwrap();
        for (position, at) in positions.iter().zip(&set.assignment) {
            let sphere = set.spheres[*at as usize];
            let distance = (DVec3::from_array(position.map(f64::from)) - sphere.center).length();
            assert!(distance <= sphere.radius * (1.0 + 1e-12), "{distance} of {sphere:?}");
        }
        set
    }

    #[test]
    fn a_long_box_becomes_a_row_of_spheres_with_less_outside_the_more_there_are() {
        let (positions, indices) = block([4.0, 1.0, 1.0]);
        let sets = [1, 4, 16].map(|count| fitted(&positions, &indices, count));
        assert!((sets[0].volume / 4.0 - 1.0).abs() < 0.1, "{}", sets[0].volume);
        let union = |set: &SphereSet| set.outside;
        assert!(union(&sets[1]) < 0.5 * union(&sets[0]), "{} {}", union(&sets[0]), union(&sets[1]));
        assert!(sets.iter().zip([1, 4, 16]).all(|(set, count)| set.spheres.len() == count));
        assert_eq!(fitted(&positions, &indices, 4), sets[1], "the same mesh, the same spheres");
    }

    #[test]
    fn open_broken_and_degenerate_meshes_are_bounded() {
        // A triangle, twice over; a point; points in a line with triangles of no area; a box without its top.
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(fitted(&triangle, &[0, 1, 2, 0, 1, 2, 2, 1, 0], 3).volume, 0.0);
        assert_eq!(fitted(&[[1.0; 3]], &[], 5).spheres, [Sphere { center: DVec3::ONE, radius: 0.0 }]);
        let line: Vec<[f32; 3]> = (0..9).map(|i| [i as f32, 0.0, 0.0]).collect();
        fitted(&line, &[0, 4, 8, 0, 0, 0], 3);
        let (positions, indices) = block([1.0; 3]);
        fitted(&positions, &indices[6..], 8);
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let default = FitSettings::default();
        let refused = |positions: &[[f32; 3]], indices: &[u32], settings: &FitSettings| {
            fit(positions, indices, settings, &mut |_| ()).unwrap_err().to_string()
        };
        assert!(refused(&[], &[], &default).contains("vertices"));
        assert!(refused(&[[f32::NAN; 3]], &[], &default).contains("finite"));
        assert!(refused(&[[0.0; 3]], &[0, 0], &default).contains("whole triangles"));
        assert!(refused(&[[0.0; 3]], &[0, 0, 1], &default).contains("index"));
        assert!(refused(&[[0.0; 3]], &[], &FitSettings { spheres: 0, ..default }).contains("1 to 1024"));
    }
}
