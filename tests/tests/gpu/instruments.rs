//! What is counted of a plan, by us while recording and by the device while it works; and one time line for both.

use airglow_gpu::{AdoptInfo, Context, Counts, DeviceMask, Feature, GpuError, Missing, Options, Timing};
use airglow_gpu::{PassStatistics, Requirements};
use airglow_graph::{Access, State};
use airglow_tests::device::{fixture, open};
use airglow_tests::workload::{COUNT, Workload};
use std::time::Instant;

/// Colours of 16 bytes, and a picture of as many texels of 16 bytes.
const BYTES: u64 = 16 * COUNT as u64;

#[test]
fn a_plan_counts_what_it_records() {
    let fixture = fixture();
    let context = fixture.context();
    let mut work = Workload::new(context, State::UNDEFINED, Access::FragmentSampled.into()).unwrap();
    let memory = |counts: &Counts| counts.memory_bytes;
    assert_eq!(work.execution.counts().iter().map(memory).collect::<Vec<_>>(), [BYTES, 2 * BYTES]);
    let expected = [
        Counts {
            dispatches: 1,
            invocations: u64::from(COUNT),
            // The tint is a uniform of 16 bytes.
            bound_bytes: BYTES + 16,
            barriers: work.execution.plan().steps()[0].barriers.len() as u64,
            memory_bytes: BYTES,
            ..Counts::default()
        },
        Counts {
            draws: 1,
            vertices: u64::from(COUNT),
            // Vertices, 32-bit indices, attachment.
            bound_bytes: 2 * BYTES + 4 * u64::from(COUNT),
            barriers: work.execution.plan().steps()[1].barriers.len() as u64,
            memory_bytes: 2 * BYTES,
            ..Counts::default()
        },
    ];
    for _ in 0..2 {
        fixture.device().run(context, |recorder| work.record(recorder)).unwrap();
        assert_eq!(work.execution.counts(), expected, "each recording starts from nothing");
    }
}

/// A frame of the workload with statistics, and the moments around it.
#[test]
fn the_device_counts_the_same() {
    let fixture = fixture();
    let context = fixture.context();
    let mut work = Workload::new(context, State::UNDEFINED, Access::FragmentSampled.into()).unwrap();
    work.timing = Timing::new(context, 2, 0, 4).unwrap().with_pipeline_statistics().unwrap();
    let begun = Instant::now();
    for _ in 0..4 {
        fixture.device().run(context, |recorder| work.record(recorder)).unwrap();
    }
    let done = Instant::now();
    let newest = work.timing.collect().unwrap().unwrap().clone();
    let count = u64::from(COUNT);
    let [compute, draw] = newest.statistics[..] else { panic!("{newest:?}") };
    assert_eq!(compute, PassStatistics { compute_invocations: count, ..PassStatistics::default() });
    assert_eq!((draw.input_vertices, draw.vertex_invocations), (count, count), "{draw:?}");
    assert_eq!((draw.clipping_primitives, draw.compute_invocations), (count, 0), "{draw:?}");
    assert!(draw.fragment_invocations >= count, "a point is a pixel: {draw:?}");
    let summary = work.timing.summary().unwrap();
    assert_eq!(summary.passes[1].statistics, Some(draw));
    assert!(summary.coverage > 0.0 && summary.coverage.is_finite(), "{}", summary.coverage);

    for [begin, end] in &newest.recorded {
        assert!(begun <= *begin && begin <= end && *end <= done);
    }
    let calibration = context.calibrate().unwrap().expect("lavapipe has VK_EXT_calibrated_timestamps");
    let end = context.device_seconds(calibration.ticks, newest.start) + newest.span;
    assert!(calibration.at >= done && end < 0.0, "the frame ended {end} s after a moment after it");
    let begin = (calibration.at - begun).as_secs_f64();
    let slack = calibration.uncertainty.as_secs_f64() + 1e-3;
    assert!(
        end > -begin - slack,
        "the frame ended {end} s before the calibration, the first began {begin} s"
    );
}

#[test]
fn statistics_that_the_host_did_not_enable_are_refused_by_name() {
    let device = open(&Requirements::engine());
    let mut extensions = Vec::new();
    let mask = DeviceMask { without_optional_features: true, ..Default::default() };
    let info = AdoptInfo {
        options: Options { mask, ..Default::default() },
        ..device.adopt_info(&mut extensions, 2)
    };
    // SAFETY: handles of the open device; nothing is submitted, and everything is dropped before it.
    let context = unsafe { Context::adopt(info) }.unwrap();
    let refused = Timing::new(&context, 2, 0, 4).unwrap().with_pipeline_statistics().err();
    let Some(GpuError::Missing(missing)) = refused else { panic!("{refused:?}") };
    let feature = Feature::PipelineStatisticsQuery;
    assert!(matches!(missing[..], [Missing::Feature { feature: named, .. }] if named == feature));
    assert!(missing[0].to_string().contains("pipelineStatisticsQuery"));
}

#[test]
fn without_the_extension_there_is_no_calibration() {
    let device = open(&Requirements::engine());
    let mut extensions = Vec::new();
    let info = AdoptInfo { extensions: &[], ..device.adopt_info(&mut extensions, 2) };
    // SAFETY: as above.
    let context = unsafe { Context::adopt(info) }.unwrap();
    assert_eq!(context.calibrate().unwrap(), None);
}
