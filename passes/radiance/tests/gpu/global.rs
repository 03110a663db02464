//! The rival's interpolation on a device, against that in f64.

use airglow_graph::Access;
use airglow_math::statistics::relative_l2;
use airglow_radiance::gpu::{GLOBAL_BINDINGS, Global, GlobalWork, LightShape, TexelSettings, Texels};
use airglow_radiance::rivals;

use crate::receivers::Mesh;
use crate::scenes::{blocks, points};
use crate::with_bench;

#[test]
fn all_samples_at_each_vertex_weigh_as_in_f64() {
    let (mesh, emitters, shape) =
        (Mesh::ball(10, 3, false), blocks(), LightShape { order: 3, gradients: false });
    with_bench(&Texels::requirements().with_descriptors(&GLOBAL_BINDINGS), |bench| {
        let texels = Texels::new(bench.context, TexelSettings { shape, size: 8, rays: 1 }).unwrap();
        let global = Global::new(bench.context, shape).unwrap();
        let places = points(12);
        let buffers = bench.buffers(shape, &emitters, &places).unwrap();
        let lights = bench.texels(&texels, &emitters, &places).unwrap();
        let samples: Vec<_> = places.iter().copied().zip(lights).collect();
        let positions: Vec<[f32; 4]> = mesh.positions.iter().map(|[x, y, z]| [*x, *y, *z, 0.0]).collect();
        for power in [1, 2, 4] {
            let work = GlobalWork {
                points: buffers.points.clone(),
                lights: buffers.lights.clone(),
                samples: places.len() as u32,
                positions: bench.upload("positions", &positions).unwrap(),
                vertices: positions.len() as u32,
                light: bench.scratch("light", 12 * 9 * positions.len() as u64).unwrap(),
                power,
            };
            (bench.run)(&mut |recorder| {
                texels.record(recorder, &buffers)?;
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageRead)?;
                global.record(recorder, &work)
            })
            .unwrap();
            let found: Vec<f32> = bench.read(&work.light).unwrap();
            let found: Vec<f64> = found.into_iter().map(f64::from).collect();
            let vertex = |v| rivals::interpolate(mesh.point(v), &samples, f64::from(power));
            let expected: Vec<f64> =
                (0..positions.len()).flat_map(vertex).flat_map(|light| light.to_array()).collect();
            let error = relative_l2(&found, &expected).unwrap();
            println!("1/d^{power}: {error:.1e} (first {:.6e}, in f64 {:.6e})", found[0], expected[0]);
            assert!(error < 1e-5, "1/d^{power}: {error:e}");
        }
    });
}
