//! The ground around a scene's figures: its colours by rays, and by visibility of some order.

use std::collections::BTreeMap;
use std::path::Path;

use airglow::math::sh::product::TripleProduct;
use airglow::math::sh::rotation::Rotation;
use airglow::math::sh::{coefficient_count, evaluate, zonal};
use airglow::math::sphere::equirect::Projector;
use airglow::shadow::{Blockers, MAX_ORDER, MIN_ORDER, Sphere};
use airglow_bake::{Mesh, Occluder, Occluders, Probe};
use airglow_scene::Scene;
use glam::{DMat4, DVec3, Mat4};

use super::Measurement;
use crate::failure::{Failure, Outcome};
use crate::host::ball::Ball;
use crate::host::environment_samples::EnvironmentSamples;
use crate::host::shadow::Blocking;
use crate::host::{spheres, transfer, truth};

/// Where fits are kept.
const CACHE: &str = ".cache/airglow";
/// Receivers along a side of the ground.
const SIDE: usize = 48;
/// Metres of it beyond the figures.
const MARGIN: f32 = 1.0;

/// White ground below a scene's figures under its environment.
pub struct Shading {
    /// The spheres of all figures and blockers, in the world.
    pub spheres: Vec<Sphere>,
    /// The same in their hierarchies, with the ratios of each order.
    blockers: BTreeMap<usize, Blockers>,
    /// Receivers.
    pub positions: Vec<[f32; 3]>,
    /// All upwards.
    pub normals: Vec<[f32; 3]>,
    /// Colours by rays to the figures' triangles.
    truth: Vec<[f32; 3]>,
    /// The environment about the world's axes.
    light: Vec<[f64; 3]>,
    name: String,
}

impl Shading {
    /// Fits or reads spheres, and traces the truth.
    pub fn new(measurement: &Measurement<'_>, scene: &Scene) -> Outcome<Self> {
        let Some(environment) = &scene.environment else {
            return Err(Failure::input("the scene has no environment to cast shadows from"));
        };
        let fitted = spheres::of_scene(scene, Path::new(CACHE), measurement.output)?;
        let (mut spheres, mut blockers) = (Vec::new(), BTreeMap::new());
        for order in MIN_ORDER..=MAX_ORDER {
            let nodes = Blocking::new(scene, fitted.clone(), order)?.nodes(scene, 0.0)?;
            spheres = nodes.iter().filter(|node| node.subtree == 1).map(|node| node.sphere).collect();
            let own: &Blockers = blockers.entry(order).or_default();
            own.set_nodes(&nodes, DMat4::IDENTITY).map_err(Failure::work)?;
        }
        if spheres.is_empty() {
            return Err(Failure::input("nothing moves in the scene; add a [[figure]] or a [[blocker]]"));
        }
        let positions = ground(&spheres);
        let normals = vec![[0.0, 1.0, 0.0]; positions.len()];
        let balls: Vec<Ball> = scene.blockers.iter().map(Ball::new).collect();
        let moving = (0..scene.instances.len()).filter(|number| scene.moves(*number));
        let none: Vec<_> = scene.instances.iter().map(|_| None).collect();
        let place =
            |number: usize| transfer::occluder(scene, number, scene.instances[number].transform, &none);
        let occluding: Vec<Occluder<'_>> =
            moving.map(place).chain(balls.iter().map(Ball::occluder)).collect();
        let occluders = Occluders::build(&occluding).map_err(Failure::input)?;
        let indices: Vec<u32> = (0..positions.len() as u32 / 3 * 3).collect();
        let mesh = Mesh { name: "ground", positions: &positions, normals: &normals, indices: &indices };
        let probe = Probe::new(&mesh, Mat4::IDENTITY, &occluders, f32::INFINITY).map_err(Failure::input)?;
        let samples = EnvironmentSamples::new(environment).map_err(Failure::input)?;
        let rays = measurement.effort.rays;
        let truth = truth::colours("ground", &probe, &samples, rays, 0, measurement.output);
        let projector =
            Projector::new(MAX_ORDER, environment.width, environment.height).map_err(Failure::input)?;
        let light = projector.project(&environment.pixels).map_err(Failure::input)?;
        let rotation = Rotation::from_quaternion(MAX_ORDER, environment.rotation.as_dquat());
        let light = rotation.and_then(|rotation| rotation.apply_rgb(&light)).map_err(Failure::input)?;
        let name = environment.file.display().to_string();
        Ok(Self { spheres, blockers, positions, normals, truth, light, name })
    }

    /// What was measured on.
    pub fn words(&self) -> String {
        format!(
            "{} receivers on white ground around {} spheres, under {}",
            self.positions.len(),
            self.spheres.len(),
            self.name
        )
    }

    /// What casts shadows at an order.
    pub fn blockers(&self, order: usize) -> Blockers {
        self.blockers.get(&order).cloned().unwrap_or_default()
    }

    /// Root mean square of the colours' difference from the truth's, over the truth's, for visibility of an order at every
    /// receiver; without visibility of no shadow at all.
    pub fn error(&self, order: usize, visibility: Option<&[f32]>) -> Outcome<f64> {
        let count = coefficient_count(order);
        let product = TripleProduct::new(order).map_err(Failure::work)?;
        let transfer = upwards(order)?;
        // M_l t, for each channel: a colour is its product with the visibility.
        let mut matrix = [vec![0.0; count], vec![0.0; count], vec![0.0; count]];
        for (channel, out) in matrix.iter_mut().enumerate() {
            let light: Vec<f64> = self.light[..count].iter().map(|light| light[channel]).collect();
            product.product(&light, &transfer, out).map_err(Failure::work)?;
        }
        let (mut difference, mut size) = (0.0, 0.0);
        for (receiver, truth) in self.truth.iter().enumerate() {
            for (channel, vector) in matrix.iter().enumerate() {
                let colour: f64 = match visibility {
                    Some(values) => {
                        let own = &values[receiver * count..][..count];
                        vector.iter().zip(own).map(|(a, b)| a * f64::from(*b)).sum()
                    }
                    None => vector[0] * (4.0 * std::f64::consts::PI).sqrt(),
                };
                let truth = f64::from(truth[channel]);
                difference += (colour - truth) * (colour - truth);
                size += truth * truth;
            }
        }
        Ok((difference / size).sqrt())
    }
}

/// Transfer of a surface that faces upwards: the clamped cosine over pi.
fn upwards(order: usize) -> Outcome<Vec<f64>> {
    let factors = zonal::clamped_cosine(order).map_err(Failure::work)?;
    let mut basis = vec![0.0; coefficient_count(order)];
    evaluate(order, DVec3::Y, &mut basis).map_err(Failure::work)?;
    let band = |(i, y): (usize, f64)| factors[i.isqrt()] / std::f64::consts::PI * y;
    Ok(basis.into_iter().enumerate().map(band).collect())
}

/// A grid of receivers at the height of the lowest sphere's lower end, as wide as all spheres and a margin.
fn ground(spheres: &[Sphere]) -> Vec<[f32; 3]> {
    let low = spheres.iter().map(|sphere| sphere.center - sphere.radius).fold(DVec3::INFINITY, DVec3::min);
    let high =
        spheres.iter().map(|sphere| sphere.center + sphere.radius).fold(DVec3::NEG_INFINITY, DVec3::max);
    let (low, high) = (low.as_vec3() - MARGIN, high.as_vec3() + MARGIN);
    let place = |at: usize| (at as f32 + 0.5) / SIDE as f32;
    let receiver = |at: usize| {
        let [u, v] = [place(at % SIDE), place(at / SIDE)];
        [low.x + u * (high.x - low.x), low.y + MARGIN - 1e-3, low.z + v * (high.z - low.z)]
    };
    (0..SIDE * SIDE).map(receiver).collect()
}
