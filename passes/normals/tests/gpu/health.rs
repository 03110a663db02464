//! Counts that a host asks for, and hosts with green down.

use airglow_gpu::{Health, Tally};
use airglow_graph::Access;
use airglow_normals::{Brdf, FitSettings, HEALTH, NormalMap, Normals, Resource, Settings, shade};
use airglow_tests::device::fixture_with;
use glam::DVec3;

use super::common::{self, Random, directions};
use super::{texel, wide, with_bench};

#[test]
fn empty_lobes_are_counted_as_the_cpu_counts_them() {
    // Flat: one lobe would do. Dead texels are none that the device sees.
    let mut vectors = vec![[0.0, 0.0, 1.0]; 64];
    vectors[9] = [f32::NAN; 3];
    vectors[10] = [0.6, 0.0, 0.8];
    let map = NormalMap::from_vectors(8, 8, &vectors).unwrap();
    let settings = wide(FitSettings::default());
    let fixture = fixture_with(&Normals::requirements(&settings).and(&Tally::requirements()));
    let (device, context) = (fixture.device(), fixture.context());
    let normals = Normals::new(context, settings).unwrap();
    let mut health = Health::new(context, &HEALTH).unwrap();
    let tally = Tally::new(context, &health).unwrap();
    let mut build = normals.build(context, &map).unwrap();
    let steps = build.progress().total;
    build.count(&tally);
    assert_eq!(build.progress().total, steps, "counting is no progress");
    // All but the copy into the texture.
    let stages = build.take(usize::MAX).to_vec();
    let used = |stage: &airglow_normals::Stage, wanted| stage.accesses().iter().any(|(of, _)| *of == wanted);
    assert_eq!(stages.iter().filter(|stage| used(stage, Resource::Health)).count(), 1);
    let lobes: Vec<_> = (1..=build.levels().len())
        .map(|level| build.buffer(Resource::Lobes(level)).unwrap().clone())
        .collect();
    let copies = device.run(context, |recorder| {
        health.clear(recorder)?;
        for stage in stages.iter().filter(|stage| !used(stage, Resource::Texture)) {
            recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::ComputeStorageReadWrite)?;
            stage.record(recorder)?;
        }
        health.collect(recorder)?;
        recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::TransferSource)?;
        lobes.iter().map(|lobes| recorder.read_back_buffer(lobes)).collect::<Result<Vec<_>, _>>()
    });
    let lobes: Vec<[f32; 4]> =
        copies.unwrap().iter().flat_map(|copy| copy.read::<[f32; 4]>().unwrap()).collect();
    for _ in 0..context.frames_in_flight() {
        device.run(context, |_| Ok(())).unwrap();
    }
    let counts = health.latest(context).unwrap().unwrap().counts;
    let empty = lobes.iter().filter(|lobe| lobe[3] <= 0.0).count() as u32;
    println!("{empty} of {} lobes are empty", lobes.len());
    assert!(lobes.iter().flatten().all(|value| value.is_finite()));
    assert_eq!(counts, [(HEALTH[0].to_owned(), 0), (HEALTH[1].to_owned(), empty)]);
}

/// Lobes are in the map's own tangent space: green down turns them with the map, and shading with them.
#[test]
fn hosts_with_green_down_get_the_same_radiance() {
    let map = common::weave(32);
    let down: Vec<[f32; 3]> =
        map.normals().iter().map(|n| DVec3::new(n.x, -n.y, n.z).as_vec3().to_array()).collect();
    let down = NormalMap::from_vectors(32, 32, &down).unwrap();
    let settings: Settings = wide(FitSettings::default());
    let [ours, theirs] = [&map, &down].map(|map| with_bench(|bench| bench.build(map, &settings).unwrap()));
    let (mut random, brdf) = (Random(8), Brdf::BlinnPhong { exponent: 30.0 });
    for (level, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
        for row in 0..20 {
            let (x, y) = (random.below(ours.size[0]), random.below(ours.size[1]));
            let seen = directions(row, &map.footprint(level + 1, x, y).unwrap(), 0.1, &mut random);
            let mut mirrored = seen;
            (mirrored.light.y, mirrored.half.y) = (-seen.light.y, -seen.half.y);
            let first = shade::radiance(&texel(ours, 4, x, y), brdf, seen);
            let second = shade::radiance(&texel(theirs, 4, x, y), brdf, mirrored);
            assert!((first - second).abs() < 1e-3 * (1.0 + first), "level {level}: {first} and {second}");
        }
    }
}
