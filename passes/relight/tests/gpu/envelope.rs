//! What may be needed is prepared ahead, on another thread; frames and changes of quality within it make no pipeline.

use crate::host::{Numbers, with_bench};
use airglow_gpu::Permutations;
use airglow_relight::{
    Bench, Case, CaseLight, Envelope, LightKind, MAX_ORDER, Method, Output, Pipelines, Relight, RelightError,
    Settings, Storage,
};
use glam::DQuat;

fn envelope() -> Envelope {
    Envelope {
        orders: vec![2, 4],
        storages: vec![Storage::F32, Storage::F16],
        outputs: vec![Output::Colour, Output::Incident],
        methods: vec![Method::Compute, Method::Fragment],
        lights: vec![LightKind::Uniform, LightKind::Vertex],
        visibility: true,
        normals: true,
        health: true,
    }
}

const VERTICES: usize = 70;

/// One frame of every kind of instance that the settings allow.
fn frames(bench: &Bench<'_>, relight: &mut Relight, numbers: &mut Numbers) {
    let Settings { light, visibility, normals, .. } = *relight.settings();
    let count = relight.settings().coefficients();
    let vectors = numbers.values(VERTICES * count);
    let directions = numbers.rgb(VERTICES);
    let (uniform, of_vertices) = (numbers.rgb(count), numbers.rgb(VERTICES * count));
    let light = match light {
        LightKind::Uniform => CaseLight::Uniform(&uniform, DQuat::IDENTITY),
        LightKind::Vertex => CaseLight::Vertices(&of_vertices),
    };
    let baked = relight.add_mesh(bench.context, "baked", VERTICES as u32, Some(&vectors)).unwrap();
    let mut cases = vec![Case::new(light, baked)];
    if normals {
        let bare = relight.add_mesh(bench.context, "bare", VERTICES as u32, None).unwrap();
        cases.push(Case { normals: Some(&directions), ..Case::new(light, bare) });
    }
    if visibility {
        cases.extend_from_within(..);
        let half = cases.len() / 2;
        cases[half..].iter_mut().for_each(|case| case.visibility = Some(&vectors));
    }
    for case in &cases {
        let results = bench.results(relight, case).unwrap();
        assert!(results.iter().all(|value| value.is_finite()));
    }
}

#[test]
fn nothing_within_the_envelope_makes_a_pipeline() {
    with_bench(|bench| {
        let context = bench.context;
        let mut numbers = Numbers::new(90);
        // Frames are recorded here while another thread prepares.
        let mut busy = Relight::new(context, Settings { order: 1, ..Settings::default() }).unwrap();
        let before = context.pipelines_made();
        let pipelines = std::thread::scope(|scope| {
            let preparing = scope.spawn(|| Pipelines::prepare(context, envelope()));
            let mut recorded = 0;
            while recorded == 0 || !preparing.is_finished() {
                frames(bench, &mut busy, &mut numbers);
                recorded += 1;
            }
            println!("{recorded} frames were recorded meanwhile");
            preparing.join().unwrap().unwrap()
        });
        let made = context.pipelines_made() - before;
        println!("{made} pipelines for {} settings", envelope().settings().unwrap().len());
        assert_eq!(made as usize, pipelines.count());
        assert_eq!(pipelines.count(), envelope().pipeline_count().unwrap());
        let before = context.pipelines_made();
        for widest in envelope().settings().unwrap() {
            for visibility in [false, widest.visibility] {
                let settings = Settings { visibility, normals: widest.normals && visibility, ..widest };
                let mut relight = Relight::with_pipelines(context, settings, &pipelines).unwrap();
                frames(bench, &mut relight, &mut numbers);
            }
        }
        assert_eq!(context.pipelines_made(), before, "a frame within the envelope made a pipeline");
    });
}

/// Prepared with others or alone, the kernels are the same.
#[test]
fn an_envelope_s_pipelines_give_the_same_bits() {
    with_bench(|bench| {
        let pipelines = Pipelines::prepare(bench.context, envelope()).unwrap();
        let (vectors, light) = (Numbers::new(91).values(VERTICES * 16), Numbers::new(92).rgb(16));
        for storage in [Storage::F32, Storage::F16] {
            for method in [Method::Compute, Method::Fragment] {
                let settings = Settings { storage, method, ..Settings::default() };
                let colours = |mut relight: Relight| {
                    let id =
                        relight.add_mesh(bench.context, "mesh", VERTICES as u32, Some(&vectors)).unwrap();
                    let light = CaseLight::Uniform(&light, DQuat::from_rotation_x(0.4));
                    bench.results(&mut relight, &Case::new(light, id)).unwrap()
                };
                let shared = Relight::with_pipelines(bench.context, settings, &pipelines).unwrap();
                let alone = Relight::new(bench.context, settings).unwrap();
                assert_eq!(colours(shared), colours(alone), "{settings:?}");
            }
        }
    });
}

#[test]
fn what_lies_outside_is_named() {
    with_bench(|bench| {
        let narrow = Envelope::from(Settings::default());
        assert_eq!(narrow.pipeline_count().unwrap(), 4);
        let pipelines = Pipelines::prepare(bench.context, narrow).unwrap();
        let inside = Settings::default();
        let outside = [
            (Settings { order: 6, ..inside }, "order 6", "orders"),
            (Settings { storage: Storage::F16, ..inside }, "F16", "storages"),
            (Settings { output: Output::Incident, ..inside }, "Incident", "outputs"),
            (Settings { method: Method::Fragment, ..inside }, "Fragment", "methods"),
            (Settings { light: LightKind::Vertex, ..inside }, "Vertex", "lights"),
            (Settings { visibility: true, ..inside }, "visibility", "visibility"),
            (Settings { normals: true, ..inside }, "normals", "normals"),
        ];
        let before = bench.context.pipelines_made();
        for (settings, setting, field) in outside {
            let error = Relight::with_pipelines(bench.context, settings, &pipelines).err().unwrap();
            let message = error.to_string();
            assert!(message.contains(setting), "{message}");
            assert!(message.contains(&format!("Envelope::{field}")), "{message}");
        }
        assert_eq!(bench.context.pipelines_made(), before);
        let all = Envelope { orders: (1..=MAX_ORDER).collect(), ..envelope() };
        println!("{} pipelines for everything", all.pipeline_count().unwrap());
        let empty = Envelope { methods: Vec::new(), ..envelope() };
        assert!(matches!(empty.settings(), Err(RelightError::Settings { .. })));
        let high = Envelope { orders: vec![9], ..envelope() };
        assert!(matches!(high.pipeline_count(), Err(RelightError::Order { order: 9 })));
    });
}
