//! Textures of lobes: order, what is between their texels, rounding, and both roads into a host.

use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Execution, Imports, Recorder};
use airglow_graph::{Graph, Limits};
use airglow_math::statistics::relative_l2;
use airglow_normals::bench::{LevelLobes, Source};
use airglow_normals::cache::ChainKey;
use airglow_normals::{
    Brdf, FitSettings, Mixture, NormalMap, Normals, Settings, Storage, WeightedLobe, reference, shade,
};
use airglow_tests::device::fixture_with;
use airglow_tests::plan::compile;

use super::common::{self, Random, directions};
use super::{texel, wide, with_bench};

#[test]
fn lobes_lie_in_the_places_of_the_coarser_level() {
    for (name, map, lobes) in
        [("weave", common::weave(64), 4), ("grain", common::grain(47), 6), ("groove", common::groove(32), 2)]
    {
        let settings = wide(FitSettings { lobes, iterations: 4, ..Default::default() });
        let levels = with_bench(|bench| bench.build(&map, &settings).unwrap());
        let (mut moved, mut lobes_seen) = (0.0, 0.0);
        for pair in levels.windows(2) {
            let [fine, coarse] = pair else { unreachable!() };
            for at in 0..fine.size[0] * fine.size[1] {
                let (x, y) = (at % fine.size[0], at / fine.size[0]);
                let place = |axis: usize, at: usize| {
                    (at * coarse.size[axis] / fine.size[axis]).min(coarse.size[axis] - 1)
                };
                let parent = texel(coarse, lobes, place(0, x), place(1, y));
                let found = texel(fine, lobes, x, y);
                // What is in its places stays there, but for the rare lobe that another order of exchange moves.
                let again = found.aligned_to(&parent);
                for (lobe, other) in found.lobes().iter().zip(again.lobes()) {
                    moved += 0.5 * (lobe.weight - other.weight).abs();
                }
                lobes_seen += 1.0;
            }
        }
        println!("{name}: {:.2} % of the normals would lie elsewhere", 100.0 * moved / lobes_seen);
        assert!(moved < 0.04 * lobes_seen, "{name}: {moved} of {lobes_seen}");
    }
}

/// Texels of a level around a place in [0, 1)^2 and their shares, clamped at the edges as the sampler of a test is.
fn around(size: [usize; 2], place: [f64; 2]) -> Vec<([usize; 2], f64)> {
    let axis = |axis: usize| {
        let at = place[axis] * size[axis] as f64 - 0.5;
        let (low, share) = (at.floor(), at - at.floor());
        let clamped = |at: f64| at.clamp(0.0, (size[axis] - 1) as f64) as usize;
        [(clamped(low), 1.0 - share), (clamped(low + 1.0), share)]
    };
    let (columns, rows) = (axis(0), axis(1));
    rows.iter().flat_map(|&(y, b)| columns.map(|(x, a)| ([x, y], a * b))).collect()
}

/// The mixture that a sampler gives between texels of two levels.
fn interpolated(levels: &[(usize, Vec<Mixture>, [usize; 2])], place: [f64; 2], between: f64) -> Mixture {
    let mut lobes = vec![WeightedLobe::default(); levels[0].1[0].lobes().len()];
    for ((_, mixtures, size), of_level) in levels.iter().zip([1.0 - between, between]) {
        for ([x, y], share) in around(*size, place) {
            for (sum, lobe) in lobes.iter_mut().zip(mixtures[y * size[0] + x].lobes()) {
                sum.weight += of_level * share * lobe.weight;
                sum.moment += of_level * share * lobe.moment;
            }
        }
    }
    Mixture::new(lobes).unwrap()
}

/// Relative L2 error of the radiance at places between texels and levels, and at texels, against the truth there: the
/// box-filtered radiances of these texels, interpolated.
fn errors(map: &NormalMap, levels: &[LevelLobes], lobes: usize, brdf: Brdf) -> [f64; 2] {
    let mut random = Random(21);
    let mixtures = |level: usize| {
        let found = &levels[level - 1];
        let one = |at: usize| texel(found, lobes, at % found.size[0], at / found.size[0]);
        (level, (0..found.size[0] * found.size[1]).map(one).collect::<Vec<_>>(), found.size)
    };
    let (mut ours, mut truths) = ([const { Vec::new() }; 2], [const { Vec::new() }; 2]);
    for level in 2..levels.len() - 1 {
        let pair = [mixtures(level), mixtures(level + 1)];
        for row in 0..60 {
            let place = [random.next(), random.next()];
            let between = random.next();
            let parts: Vec<_> = pair
                .iter()
                .zip([1.0 - between, between])
                .flat_map(|((level, _, size), of_level)| {
                    around(*size, place).into_iter().map(move |(at, share)| (*level, at, of_level * share))
                })
                .map(|(level, [x, y], share)| (map.footprint(level, x, y).unwrap(), share))
                .collect();
            let directions = directions(row, &parts[row % 4].0, 0.1, &mut random);
            let truth =
                |(footprint, share): &(Vec<_>, f64)| share * reference::radiance(footprint, brdf, directions);
            truths[0].push(parts.iter().map(truth).sum::<f64>());
            ours[0].push(shade::radiance(&interpolated(&pair, place, between), brdf, directions));
            let [[x, y], _] = [around(pair[0].2, place)[0].0, [0; 2]];
            truths[1].push(reference::radiance(&map.footprint(level, x, y).unwrap(), brdf, directions));
            ours[1].push(shade::radiance(&pair[0].1[y * pair[0].2[0] + x], brdf, directions));
        }
    }
    [0, 1].map(|i| relative_l2(&ours[i], &truths[i]).unwrap())
}

#[test]
fn between_texels_and_levels_lobes_stay_near_the_truth() {
    let brdf = Brdf::BlinnPhong { exponent: 50.0 };
    for (name, map, most) in [
        ("groove", common::groove(128), 0.02),
        ("weave", common::weave(128), 0.02),
        ("grain", common::grain(128), 0.05),
    ] {
        let settings = wide(FitSettings { iterations: 8, ..Default::default() });
        let levels = with_bench(|bench| bench.build(&map, &settings).unwrap());
        let [between, at] = errors(&map, &levels, 4, brdf);
        // The same lobes of each texel, in an order of its own.
        let mut shuffled = levels;
        let mut random = Random(4);
        for level in &mut shuffled {
            level.lobes.chunks_mut(4).for_each(|lobes| lobes.rotate_left(random.below(4)));
        }
        let [disordered, _] = errors(&map, &shuffled, 4, brdf);
        println!(
            "{name}, exponent 50: {:.2} % between texels and levels, {:.2} % at texels, {:.1} % without order",
            100.0 * between,
            100.0 * at,
            100.0 * disordered
        );
        assert!(between < most && between < disordered, "{name}: {between}, {disordered} without order");
    }
}

#[test]
fn storage_keeps_the_radiance() {
    let map = common::weave(64);
    let levels = with_bench(|bench| {
        let exact = bench.build(&map, &Settings::default()).unwrap();
        for storage in Storage::ALL {
            let settings = Settings { storage, ..Default::default() };
            let texture = bench.texture(&map, &settings).unwrap().unwrap();
            let mips = bench.bytes(&texture).unwrap();
            assert_eq!(mips.iter().map(Vec::len).sum::<usize>() as u64, texture.bytes);
            for (level, bytes) in exact.iter().zip(&mips) {
                check_packed(storage, level, bytes);
            }
        }
        exact
    });
    for (exponent, most) in [(50.0, [4e-3, 0.1, 0.04]), (200.0, [8e-3, 0.2, 0.08])] {
        for (storage, most) in Storage::ALL.into_iter().zip(most) {
            let error = storage_error(&map, &levels, storage, Brdf::BlinnPhong { exponent });
            println!("{storage:?}, exponent {exponent}: {:.3} % from the same lobes in f32", 100.0 * error);
            assert!(error < most, "{storage:?}, exponent {exponent}: {error}");
        }
    }
}

/// The device's bytes are the reference's rounding of the device's lobes, give or take what f32 cannot tell.
fn check_packed(storage: Storage, level: &LevelLobes, bytes: &[u8]) {
    let (decoded, texels) = (storage.decode(bytes), level.size[0] * level.size[1]);
    let step = if storage == Storage::F16 { 5e-4 } else { 8e-3 };
    for (at, found) in decoded.iter().enumerate() {
        let exact = WeightedLobe::from(level.lobes[(at % texels) * 4 + at / texels]);
        let (found, expected) = (WeightedLobe::from(*found), storage.round(exact));
        assert!((found.weight - expected.weight).abs() <= step, "{found:?} is not {expected:?}");
        if found.weight > 0.1 && expected.weight > 0.1 {
            let kept = |lobe: WeightedLobe| 1.0 - lobe.mean().length();
            let (ours, theirs) = ((kept(found) - kept(exact)).abs(), (kept(expected) - kept(exact)).abs());
            // A weight between two codes may fall to either.
            let slack = if storage == Storage::F16 { 1e-6 } else { 2e-3 };
            assert!(ours <= 1.5 * theirs + slack, "{storage:?}: {ours:e} and {theirs:e} of {exact:?}");
        }
    }
}

/// How far radiance is from that of the lobes before they were rounded.
fn storage_error(map: &NormalMap, levels: &[LevelLobes], storage: Storage, brdf: Brdf) -> f64 {
    let mut random = Random(5);
    let (mut rounded, mut exact) = (Vec::new(), Vec::new());
    for (i, level) in levels.iter().enumerate().skip(1) {
        for row in 0..40 {
            let (x, y) = (random.below(level.size[0]), random.below(level.size[1]));
            let mixture = texel(level, 4, x, y);
            let lobes = mixture.lobes().iter().map(|&lobe| storage.round(lobe)).collect();
            let footprint = map.footprint(i + 1, x, y).unwrap();
            let directions = directions(row, &footprint, 0.1, &mut random);
            exact.push(shade::radiance(&mixture, brdf, directions));
            rounded.push(shade::radiance(&Mixture::new(lobes).unwrap(), brdf, directions));
        }
    }
    relative_l2(&rounded, &exact).unwrap()
}

#[test]
fn both_roads_and_any_number_of_frames_give_the_same_bits() {
    let map = common::weave(32);
    let settings = Settings::default();
    let (texture, expected) = with_bench(|bench| {
        let texture = bench.texture(&map, &settings).unwrap().unwrap();
        (texture.bytes, bench.bytes(&texture).unwrap())
    });
    assert!(texture <= 16 * 32 * 32, "{texture} bytes are over four times the map");
    let fixture = fixture_with(&Normals::requirements(&settings));
    let (device, context) = (fixture.device(), fixture.context());
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), airglow_gpu::GpuError>| {
        device.run(context, |recorder| record(recorder))
    };
    let bench = airglow_normals::Bench { context, run: &run };
    let normals = Normals::new(context, settings).unwrap();
    for steps in [usize::MAX, 3] {
        let mut build = normals.build(context, &map).unwrap();
        let total = build.progress().total;
        assert_eq!(build.progress().done, 0);
        while build.progress().done < total {
            let before = build.progress().done;
            let (mut graph, mut imports) = (Graph::new(), Imports::new());
            build.add(&mut graph, &mut imports, steps);
            let plan = compile(graph, &Limits::default());
            assert_eq!(plan.left_out().len(), usize::from(before == 0));
            let mut execution = Execution::prepare(context, plan).unwrap();
            let mut frames = FrameLoop::new(device, context).unwrap();
            frames
                .frame(FrameSemaphores::default(), |commands| {
                    // SAFETY: the loop's command buffer is recording and submitted once; imports are as declared.
                    unsafe { execution.record(context, commands, &imports, None) }
                })
                .unwrap();
            frames.finish().unwrap();
            assert!(build.progress().done > before);
        }
        let texture = build.texture().unwrap();
        assert_eq!(bench.bytes(texture).unwrap(), expected, "{steps} steps a frame");
    }
    let single = NormalMap::from_vectors(1, 1, &[[0.0, 0.0, 1.0]]).unwrap();
    let build = normals.build(context, &single).unwrap();
    assert!(build.texture().is_none() && build.progress().total == 0);
}

#[test]
fn kept_chains_are_the_same_bits_and_spoiled_files_are_built_again() {
    let (map, other) = (common::weave(32), common::groove(32));
    let settings = Settings::default();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(ChainKey::new(&map, &settings).to_hex());
    with_bench(|bench| {
        let seen = |map: &NormalMap, settings: &Settings| {
            let (texture, source) = bench.cached(&path, map, settings).unwrap();
            let miss = match source {
                Source::Cache => None,
                Source::Built(miss) => Some(miss.to_string()),
            };
            (bench.bytes(&texture.unwrap()).unwrap(), miss)
        };
        let (built, miss) = seen(&map, &settings);
        assert!(miss.unwrap().contains("cannot be read"));
        assert_eq!(seen(&map, &settings), (built.clone(), None));
        let whole = std::fs::read(&path).unwrap();
        for (spoiled, word) in [
            (whole[..whole.len() - 1].to_vec(), "damaged"),
            (whole[..20].to_vec(), "damaged"),
            (Vec::new(), "damaged"),
            ([&whole[..whole.len() - 9], &[77], &whole[whole.len() - 8..]].concat(), "checksum"),
        ] {
            std::fs::write(&path, spoiled).unwrap();
            let (bytes, miss) = seen(&map, &settings);
            assert_eq!(bytes, built);
            assert!(miss.as_ref().is_some_and(|miss| miss.contains(word)), "{miss:?} is not {word}");
        }
        for (map, settings) in [(&other, settings), (&map, Settings { storage: Storage::Snorm8, ..settings })]
        {
            assert!(seen(map, &settings).1.unwrap().contains("another map"));
        }
        let nowhere = folder.path().join("missing").join("file");
        let error = bench.cached(&nowhere, &map, &settings).err().unwrap().to_string();
        assert!(error.contains("missing") && error.contains("folder"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing half-written stays");
    });
}
