//! Transfer made on the GPU from current normals, against the bake's closed form and the f64 reference.

use crate::host::falling::Falling;
use crate::host::{Numbers, length, wide, wide_rgb, with_bench};
use airglow_bake::Mesh;
use airglow_graph::Access;
use airglow_math::sh::product::TripleProduct;
use airglow_relight::pack::ChunkLimits;
use airglow_relight::{
    Bench, Case, CaseLight, Frame, Instance, Light, LightKind, Method, Output, Relight, Resource, Settings,
    reference,
};
use glam::{DQuat, DVec3, Mat4};

/// A mesh in motion and everything that can fall on it.
struct Input {
    order: usize,
    normals: Vec<[f32; 3]>,
    falling: Falling,
}

impl Input {
    fn new(order: usize, vertices: usize) -> Self {
        let mut numbers = Numbers::new(50 + order as u64);
        let mut normals = numbers.rgb(vertices);
        // Lengths over the whole proven domain, the axes, and a vertex without a normal.
        for (i, normal) in normals.iter_mut().enumerate() {
            let scale = [1.0, 1e-18, 1e18, 1e-30, 1e30][i % 5];
            *normal = normal.map(|value| value * scale);
        }
        normals[7] = [0.0; 3];
        normals[8] = [0.0, 0.0, -2.0];
        normals[9] = [3.0, 0.0, 0.0];
        Self { order, normals, falling: Falling::new(&mut numbers, order, vertices) }
    }

    fn run(&self, bench: &Bench<'_>, settings: Settings, limits: Option<&ChunkLimits>) -> Vec<f32> {
        let settings = Settings { order: self.order, ..settings };
        let normals = settings.normals.then_some(&self.normals[..]);
        self.falling.run(bench, settings, limits, self.normals.len(), (None, normals))
    }

    /// Runs and compares every vertex with the reference: error / (norm of t times norm of l).
    fn check(&self, bench: &Bench<'_>, settings: Settings, limits: Option<&ChunkLimits>) -> Vec<f32> {
        let count = self.order * self.order;
        let values = self.run(bench, settings, limits);
        let uniform = reference::light(
            self.order,
            &wide_rgb(&self.falling.light),
            self.falling.turn,
            self.falling.rotation,
        )
        .unwrap();
        let tensor = TripleProduct::new(self.order).unwrap();
        let mut worst: f64 = 0.0;
        for (vertex, normal) in self.normals.iter().enumerate() {
            let of_vertex = vertex * count..(vertex + 1) * count;
            let transfer =
                reference::unshadowed(self.order, DVec3::from_array(normal.map(f64::from))).unwrap();
            let light = match settings.light {
                LightKind::Uniform => uniform.clone(),
                LightKind::Vertex => wide_rgb(&self.falling.vertex_light[of_vertex.clone()]),
            };
            let seen = wide(&self.falling.visibility[of_vertex]);
            let expected = match settings.visibility {
                true => reference::shadowed_colour(&tensor, &transfer, &light, &seen).unwrap(),
                false => reference::colour(&transfer, &light),
            };
            let actual: [f64; 3] = [0, 1, 2].map(|i| f64::from(values[4 * vertex + i]));
            let scale = length(transfer) * length(light.into_iter().flatten());
            if scale == 0.0 {
                assert_eq!(actual, [0.0; 3], "{settings:?} vertex {vertex} has no normal");
                continue;
            }
            for (actual, expected) in actual.iter().zip(expected) {
                let error = (actual - expected).abs() / scale;
                assert!(error < 1e-5, "{settings:?} vertex {vertex}: {actual} and {expected}: {error}");
                worst = worst.max(error);
            }
        }
        println!("order {}, {settings:?}: {worst:.2e}", self.order);
        values
    }
}

/// Settings for normals: light, visibility, method.
fn settings(light: LightKind, visibility: bool, method: Method) -> Settings {
    Settings { light, visibility, method, normals: true, ..Settings::default() }
}

#[test]
fn colours_agree_with_the_reference_and_both_methods_give_the_same_bits() {
    with_bench(|bench| {
        for order in 1..=6 {
            let input = Input::new(order, 1100);
            for light in [LightKind::Uniform, LightKind::Vertex] {
                for visibility in [false, true] {
                    let compute = input.check(bench, settings(light, visibility, Method::Compute), None);
                    let fragment = input.run(bench, settings(light, visibility, Method::Fragment), None);
                    let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                    assert_eq!(bits(&compute), bits(&fragment), "order {order}, {light:?}, {visibility}");
                }
            }
        }
    });
}

/// Lit by one basis function after another, the colours are the transfer vector itself.
#[test]
fn every_coefficient_is_that_of_the_bake() {
    with_bench(|bench| {
        let normals = Numbers::new(60).rgb(64);
        let positions = vec![[0.0; 3]; normals.len()];
        let mesh = Mesh { name: "points", positions: &positions, normals: &normals, indices: &[0, 1, 2] };
        for order in 1..=6 {
            let baked = airglow_bake::unshadowed(&mesh, Mat4::IDENTITY, order).unwrap().transfer;
            let settings = Settings { order, ..settings(LightKind::Uniform, false, Method::Compute) };
            let mut relight = Relight::new(bench.context, settings).unwrap();
            let points = relight.add_mesh(bench.context, "points", normals.len() as u32, None).unwrap();
            for i in 0..order * order {
                let mut light = vec![[0.0; 3]; order * order];
                light[i] = [1.0; 3];
                let light = CaseLight::Uniform(&light, DQuat::IDENTITY);
                let case = Case { normals: Some(&normals), ..Case::new(light, points) };
                let colours = bench.results(&mut relight, &case).unwrap();
                for vertex in 0..normals.len() {
                    let (actual, expected) =
                        (colours[4 * vertex], baked.coefficients[vertex * order * order + i]);
                    let error = (actual - expected).abs();
                    assert!(error < 1e-6, "order {order}, vertex {vertex}, t_{i}: {actual} and {expected}");
                }
            }
        }
    });
}

#[test]
fn chunks_change_no_bit() {
    with_bench(|bench| {
        let input = Input::new(4, 3000);
        let limits = ChunkLimits { storage_range: 256 << 10, workgroups: 65_535 };
        for method in [Method::Compute, Method::Fragment] {
            let settings = settings(LightKind::Vertex, true, method);
            let chunked = input.check(bench, settings, Some(&limits));
            assert_eq!(chunked, input.run(bench, settings, None), "{method:?}");
        }
    });
}

/// A mesh without a bake blocks nothing: every vertex meets the light itself.
#[test]
fn incident_radiance_of_an_open_mesh_is_the_light() {
    with_bench(|bench| {
        for order in 1..=6 {
            let input = Input::new(order, 100);
            for light in [LightKind::Uniform, LightKind::Vertex] {
                let settings = Settings { output: Output::Incident, light, ..Settings::default() };
                let values = input.run(bench, settings, None);
                let uniform = reference::light(
                    order,
                    &wide_rgb(&input.falling.light),
                    input.falling.turn,
                    input.falling.rotation,
                );
                let expected = match light {
                    LightKind::Uniform => uniform.unwrap().repeat(input.normals.len()),
                    LightKind::Vertex => wide_rgb(&input.falling.vertex_light),
                };
                assert_eq!(values.len(), 3 * expected.len());
                for (actual, expected) in values.iter().zip(expected.as_flattened()) {
                    let error = (f64::from(*actual) - expected).abs();
                    assert!(error < 1e-5, "order {order}, {light:?}: {actual} and {expected}");
                }
            }
        }
    });
}

#[test]
fn normals_are_declared_and_what_does_not_fit_is_refused() {
    with_bench(|bench| {
        let context = bench.context;
        let light = || Light::<(), ()>::Uniform { coefficients: (), rotation: DQuat::IDENTITY };
        let frame = |instance| Frame { light: light(), instances: vec![instance], target: None };
        for (method, access) in
            [(Method::Compute, Access::ComputeStorageRead), (Method::Fragment, Access::FragmentStorageRead)]
        {
            let mut relight = Relight::new(context, settings(LightKind::Uniform, false, method)).unwrap();
            let skinned = relight.add_mesh(context, "skinned", 100, None).unwrap();
            let baked = relight.add_mesh(context, "baked", 10, Some(&[0.5; 160])).unwrap();
            let moving = Instance { normals: Some(()), ..Instance::new(skinned) };
            let prepared = relight.prepare(context, &frame(moving)).unwrap();
            let accesses = prepared.accesses();
            assert!(accesses.contains(&(Resource::Normals(0), vec![access])), "{accesses:?}");
            assert!(!accesses.iter().any(|(resource, _)| matches!(resource, Resource::Vectors(_))));
            let mut refusal =
                |instance| relight.prepare(context, &frame(instance)).err().unwrap().to_string();
            assert!(refusal(Instance::new(skinned)).contains("give Instance::normals"));
            assert!(refusal(Instance { mesh: baked, ..moving }).contains("give one of them"));
        }
        let mut relight = Relight::new(context, Settings::default()).unwrap();
        let refused = relight.add_mesh(context, "skinned", 100, None).unwrap_err().to_string();
        assert!(refused.contains("Settings::normals"), "{refused}");
        let mesh = relight.add_mesh(context, "baked", 10, Some(&[0.5; 160])).unwrap();
        let moving = Instance { normals: Some(()), ..Instance::new(mesh) };
        let refused = relight.prepare(context, &frame(moving)).err().unwrap().to_string();
        assert!(refused.contains("set Settings::normals"), "{refused}");
        let incident = Settings { normals: true, output: Output::Incident, ..Settings::default() };
        assert!(Relight::new(context, incident).is_err());
    });
}
