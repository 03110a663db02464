//! Finding the samples whose domains hold a vertex, by the linear octree of Sun 2005, section 3.3.5, and by the walk of the tree
//! that the device takes: `cargo run --release -p airglow-radiance --example domains`.
//!
//! The church of `assets/scenes/nave-near.toml`, faces of 16 texels in f64. Both find the same samples for each vertex, which is
//! checked. The octree is made anew whenever samples are; the walk needs nothing but the samples' numbers at their nodes.
//! Times are of one thread, in f64, medians of nine; what is looked at does not depend on the machine.

#![expect(clippy::unwrap_used, reason = "an example that stops where it fails")]

use std::time::Instant;

use airglow_math::statistics::median;
use airglow_radiance::gpu::tree::{self, DeviceNode};
use airglow_radiance::gpu::vertices::GROUP;
use airglow_radiance::reference::Cube;
use airglow_radiance::{Glow, OVERLAP, Octree, Oracle, Refined, Settings, refine};
use glam::DVec3;

#[expect(dead_code, reason = "another example reads the rest")]
#[path = "common/scene.rs"]
mod scene;

use scene::{Failure, Placed};

const RUNS: usize = 9;

/// Centre and radius of what a sample is used in.
type Domain = (DVec3, f64);

fn main() -> Result<(), Failure> {
    let placed = Placed::load("nave-near", None)?.ok_or("the church is not here")?;
    let nodes = tree::nodes(&placed.tree, Oracle::Transfer);
    println!("{} vertices, medians of {RUNS}", placed.positions.len());
    for bound in [0.1, 0.02, 0.003] {
        let refined = refined(&placed, bound)?;
        race(&placed, &nodes, &refined);
    }
    Ok(())
}

fn refined(placed: &Placed, bound: f64) -> Result<Refined, Failure> {
    let cube = Cube::new(placed.order, 16)?;
    let settings = Settings { bound, ..Settings::default() };
    let mut sample =
        |points: &[DVec3]| points.iter().map(|point| cube.sample(*point, &placed.emitters)).collect();
    Ok(refine(&placed.tree, &settings, &Glow::of(&placed.emitters), &mut sample)?)
}

/// Both ways in turn.
fn race(placed: &Placed, nodes: &[DeviceNode], refined: &Refined) {
    let mut domains: Vec<Domain> = Vec::new();
    let mut slots = vec![None; nodes.len()];
    for sample in refined.samples.iter().filter(|sample| !sample.split) {
        slots[sample.node] = Some(domains.len());
        domains.push((sample.point, OVERLAP * sample.reach));
    }
    let points: Vec<DVec3> =
        placed.tree.vertices().iter().map(|vertex| placed.point(*vertex as usize)).collect();
    let (mut making, mut searching, mut walking) = (Vec::new(), Vec::new(), Vec::new());
    let (mut pairs, mut seen, mut walked) = (0, Found::default(), Found::default());
    for _ in 0..RUNS {
        let begin = Instant::now();
        let octree = Octree::new(&domains);
        making.push(begin.elapsed().as_secs_f64());
        let begin = Instant::now();
        seen = search(&octree, &domains, &points);
        searching.push(begin.elapsed().as_secs_f64());
        let begin = Instant::now();
        walked = walk_groups(nodes, &slots, &domains, &points);
        walking.push(begin.elapsed().as_secs_f64());
        pairs = octree.len();
    }
    assert_eq!(seen.held, walked.held, "the samples that hold each vertex");
    let each = |count: usize| count as f64 / points.len() as f64;
    let microseconds = |times: &[f64]| 1e6 * median(times).unwrap() / points.len() as f64;
    println!("{} samples, of which {:.1} hold a vertex", domains.len(), each(seen.held.len() - points.len()));
    println!(
        "  octree: {pairs} pairs of cell and sample, sorted in {:.2} ms; {:.1} samples tried and {:.2} us a vertex",
        1e3 * median(&making).unwrap(),
        each(seen.tried),
        microseconds(&searching)
    );
    println!(
        "  walk:   {:.1} nodes looked at, {:.1} samples tried and {:.2} us a vertex",
        each(walked.nodes),
        each(walked.tried),
        microseconds(&walking)
    );
}

/// What was looked at, and the samples that hold each vertex in order, `usize::MAX` behind the last of each.
#[derive(Default)]
struct Found {
    nodes: usize,
    tried: usize,
    held: Vec<usize>,
}

impl Found {
    fn finish(&mut self, of_vertex: &mut Vec<usize>) {
        of_vertex.sort_unstable();
        self.held.append(of_vertex);
        self.held.push(usize::MAX);
    }
}

fn holds(domain: Domain, point: DVec3) -> bool {
    domain.0.distance_squared(point) <= domain.1 * domain.1
}

fn search(octree: &Octree, domains: &[Domain], points: &[DVec3]) -> Found {
    let mut found = Found::default();
    let mut of_vertex = Vec::new();
    for &point in points {
        octree.near(point, |number| {
            found.tried += 1;
            if holds(domains[number], point) {
                of_vertex.push(number);
            }
        });
        found.finish(&mut of_vertex);
    }
    found
}

/// As the kernel: a walk for each group of vertices that lie near one another, whose list each of them tries.
fn walk_groups(nodes: &[DeviceNode], slots: &[Option<usize>], domains: &[Domain], points: &[DVec3]) -> Found {
    let mut found = Found::default();
    let (mut listed, mut of_vertex) = (Vec::new(), Vec::new());
    for group in points.chunks(GROUP) {
        let low = group.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let centre = low.midpoint(group.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max));
        let radius = group.iter().map(|point| point.distance(centre)).fold(0.0, f64::max);
        found.nodes += walk(nodes, slots, domains, (centre, radius), &mut listed);
        for &point in group {
            found.tried += listed.len();
            of_vertex.extend(listed.iter().copied().filter(|number| holds(domains[*number], point)));
            found.finish(&mut of_vertex);
        }
    }
    found
}

/// Lists the samples whose domains meet a ball; returns how many nodes it looked at.
fn walk(
    nodes: &[DeviceNode],
    slots: &[Option<usize>],
    domains: &[Domain],
    (centre, radius): Domain,
    listed: &mut Vec<usize>,
) -> usize {
    listed.clear();
    let (mut i, mut looked) = (0, 0);
    while let Some(node) = nodes.get(i) {
        looked += 1;
        let behind = i + 2 * node.count as usize - 1;
        let away = centre.distance(DVec3::from(node.mean.map(f64::from))) - radius;
        if away > f64::from(node.bound) || node.weight < 0.0 {
            i = behind;
        } else if let Some(number) = slots[i] {
            if away <= domains[number].1 {
                listed.push(number);
            }
            i = behind;
        } else {
            i += 1;
        }
    }
    looked
}
