//! The kernels over vertices against the f64 reference: storages, orders, lights, visibility, both methods, chunks.

use crate::host::falling::Falling;
use crate::host::{Numbers, length, wide, wide_rgb, with_bench};
use airglow_math::sh::product::TripleProduct;
use airglow_relight::pack::ChunkLimits;
use airglow_relight::{
    Bench, Case, CaseLight, LightKind, Method, Output, Relight, Settings, Storage, reference,
};

/// A mesh and everything that can fall on it.
struct Input {
    vectors: Vec<f32>,
    falling: Falling,
}

impl Input {
    fn new(order: usize, vertices: usize) -> Self {
        let mut numbers = Numbers::new(order as u64);
        let vectors = numbers.values(order * order * vertices);
        Self { vectors, falling: Falling::new(&mut numbers, order, vertices) }
    }

    /// What the GPU gives, and the result of each vertex by the reference with the scale of its error.
    fn check(&self, bench: &Bench<'_>, settings: Settings, limits: Option<&ChunkLimits>) -> Vec<f32> {
        let count = settings.coefficients();
        let vertices = self.vectors.len() / count;
        let values = self.run(bench, settings, limits);
        let uniform = reference::light(
            settings.order,
            &wide_rgb(&self.falling.light),
            self.falling.turn,
            self.falling.rotation,
        )
        .unwrap();
        let tensor = TripleProduct::new(settings.order).unwrap();
        let tolerance = if settings.storage == Storage::F16 { 1e-3 } else { 1e-5 };
        let stride = settings.output_bytes() as usize / 4;
        let mut worst: f64 = 0.0;
        for vertex in 0..vertices {
            let of_vertex = vertex * count..(vertex + 1) * count;
            let baked = wide(&self.vectors[of_vertex.clone()]);
            let seen = wide(&self.falling.visibility[of_vertex.clone()]);
            let light = match settings.light {
                LightKind::Uniform => uniform.clone(),
                LightKind::Vertex => wide_rgb(&self.falling.vertex_light[of_vertex]),
            };
            let dynamic = settings.visibility.then_some(&seen[..]);
            let expected = match (settings.output, dynamic) {
                (Output::Colour, None) => vec![reference::colour(&baked, &light)],
                (Output::Colour, Some(seen)) => {
                    vec![reference::shadowed_colour(&tensor, &baked, &light, seen).unwrap()]
                }
                (Output::Incident, dynamic) => {
                    reference::incident(&tensor, &light, Some(&baked), dynamic).unwrap()
                }
            };
            let scale = length(baked) * length(light.into_iter().flatten());
            let actual = &values[vertex * stride..][..stride];
            for (i, expected) in expected.iter().flatten().enumerate() {
                let error = (f64::from(actual[i]) - expected).abs() / scale;
                assert!(
                    error < tolerance,
                    "{settings:?} vertex {vertex}: {} and {expected}: {error}",
                    actual[i]
                );
                worst = worst.max(error);
            }
        }
        println!("{settings:?}: {worst:.2e}");
        values
    }

    fn run(&self, bench: &Bench<'_>, settings: Settings, limits: Option<&ChunkLimits>) -> Vec<f32> {
        let vertices = self.vectors.len() / settings.coefficients();
        self.falling.run(bench, settings, limits, vertices, (Some(&self.vectors), None))
    }
}

#[test]
fn colours_agree_with_the_reference_at_every_order() {
    with_bench(|bench| {
        for order in 1..=6 {
            let input = Input::new(order, 200);
            for storage in [Storage::F32, Storage::F16] {
                input.check(bench, Settings { order, storage, ..Settings::default() }, None);
            }
        }
    });
}

#[test]
fn light_of_each_vertex_and_visibility_agree_with_the_reference() {
    with_bench(|bench| {
        for order in [1, 2, 4, 6] {
            let input = Input::new(order, 70);
            for light in [LightKind::Uniform, LightKind::Vertex] {
                for visibility in [false, true] {
                    for output in [Output::Colour, Output::Incident] {
                        let settings = Settings { order, light, visibility, output, ..Settings::default() };
                        input.check(bench, settings, None);
                    }
                }
            }
        }
    });
}

#[test]
fn incident_radiance_from_half_floats_and_from_dynamic_visibility_alone() {
    with_bench(|bench| {
        let settings =
            Settings { output: Output::Incident, visibility: true, order: 3, ..Settings::default() };
        let input = Input::new(3, 90);
        input.check(bench, Settings { storage: Storage::F16, visibility: false, ..settings }, None);
        for light in [LightKind::Uniform, LightKind::Vertex] {
            let settings = Settings { light, ..settings };
            let mut relight = Relight::new(bench.context, settings).unwrap();
            let mesh = relight.add_mesh(bench.context, "moving", 90, None).unwrap();
            let case_light = match light {
                LightKind::Uniform => CaseLight::Uniform(&input.falling.light, input.falling.turn),
                LightKind::Vertex => CaseLight::Vertices(&input.falling.vertex_light),
            };
            let visibility = Some(&input.falling.visibility[..]);
            let orientation = input.falling.rotation.into();
            let case = Case { orientation, visibility, ..Case::new(case_light, mesh) };
            let values = bench.results(&mut relight, &case).unwrap();
            // With dynamic visibility in the place of the static one the result is the same.
            let baked = Input { vectors: input.falling.visibility.clone(), ..Input::new(3, 90) };
            assert_eq!(values, baked.run(bench, Settings { visibility: false, ..settings }, None));
        }
    });
}

#[test]
fn both_methods_give_the_same_bits() {
    with_bench(|bench| {
        for order in [1, 3, 4, 6] {
            let input = Input::new(order, 2500);
            for storage in [Storage::F32, Storage::F16] {
                for light in [LightKind::Uniform, LightKind::Vertex] {
                    for visibility in [false, true] {
                        let settings = Settings { order, storage, light, visibility, ..Settings::default() };
                        let compute = input.run(bench, settings, None);
                        let fragment =
                            input.run(bench, Settings { method: Method::Fragment, ..settings }, None);
                        let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                        assert_eq!(bits(&compute), bits(&fragment), "{settings:?}");
                        assert_eq!(bits(&compute), bits(&input.run(bench, settings, None)), "a second run");
                    }
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
            for light in [LightKind::Uniform, LightKind::Vertex] {
                let settings = Settings { method, light, visibility: true, ..Settings::default() };
                let chunked = input.check(bench, settings, Some(&limits));
                assert_eq!(chunked, input.run(bench, settings, None), "{settings:?}");
            }
        }
        let settings = Settings { output: Output::Incident, visibility: true, ..Settings::default() };
        assert_eq!(input.run(bench, settings, Some(&limits)), input.run(bench, settings, None));
    });
}
