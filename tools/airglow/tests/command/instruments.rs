//! The instruments of `render`: counts that must not change by accident, what measuring costs, and the time line.

#![cfg(feature = "relight")]

#[cfg(all(feature = "fog", feature = "radiance", feature = "normals"))]
use crate::counts::counts;
use crate::counts::lines;
use crate::root;
use std::path::Path;
use std::process::Command;

use airglow_tests::golden::assert_text;
use serde_json::Value;

/// What `render --stat` writes of a small scene.
fn render(folder: &Path, more: &[&str]) -> Value {
    render_of(folder, "spot", more)
}

/// The same of another scene.
fn render_of(folder: &Path, scene: &str, more: &[&str]) -> Value {
    let scene = root().join(format!("assets/scenes/{scene}.toml")).display().to_string();
    let small = ["-o", "a.exr", "--size", "64x48", "--rays", "16", "--exposure", "1"];
    let common = ["--stat", "stat.json", "--device", "cpu", "--quiet"];
    let arguments = [&["render", &scene], &small[..], &common[..], more].concat();
    let output =
        Command::new(env!("CARGO_BIN_EXE_airglow")).current_dir(folder).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    json(&folder.join("stat.json"))
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// Times differ from machine to machine; these do not. llvmpipe's own counts are the same at vector widths of 128 to 512
/// bits and at any number of threads.
#[test]
fn counts_of_every_pass_are_exact() {
    let folder = tempfile::tempdir().unwrap();
    let first = render(folder.path(), &["--frames", "1"]);
    let later = render(folder.path(), &["--frames", "4", "--pipeline-statistics"]);
    let mut text = "spot.toml, 64 x 48 pixels of 2 x 2 samples, on llvmpipe\n".to_owned();
    let passes = |stat: &Value| stat["passes"].as_array().unwrap().clone();
    for (first, later) in passes(&first).iter().zip(passes(&later)) {
        assert_eq!(first["name"], later["name"]);
        text += &format!("{}\n", later["name"].as_str().unwrap());
        text += &lines("first frame", &first["counts"]);
        text += &lines("later frames", &later["counts"]);
        text += &lines("later frames, counted by the device", &later["pipeline_statistics"]);
    }
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/counts.txt");
    assert_text(&golden, &text);
}

/// The same of scenes that the other rooms draw; that of moving shadows stands in `moving.rs`.
#[test]
#[cfg(all(feature = "fog", feature = "radiance", feature = "normals"))]
fn counts_of_other_scenes_are_exact() {
    let folder = tempfile::tempdir().unwrap();
    for scene in ["street", "blocks", "grooves"] {
        let stat = render_of(folder.path(), scene, &["--frames", "3", "--pipeline-statistics", "--health"]);
        let title = format!("{scene}.toml, 64 x 48 pixels of 2 x 2 samples, on llvmpipe");
        let golden = format!("tests/golden/counts-{scene}.txt");
        assert_text(&Path::new(env!("CARGO_MANIFEST_DIR")).join(golden), &counts(&title, &stat));
    }
}

/// Memory that transients hand to one another holds the same picture.
#[test]
fn transients_that_share_memory_draw_the_same_picture_from_fewer_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |more: &[&str]| {
        let stat = render(folder.path(), &[&["--frames", "2", "--views", "2"], more].concat());
        let owner = |owner: &&Value| owner["owner"] == "transient";
        let bytes = stat["memory"].as_array().unwrap().iter().find(owner).unwrap()["bytes"].as_u64();
        (std::fs::read(folder.path().join("a.exr")).unwrap(), bytes.unwrap())
    };
    let (apart, shared) = (draw(&[]), draw(&["--share-transients"]));
    assert!(apart.0 == shared.0, "the same picture");
    println!("{} bytes of transients, {} shared", apart.1, shared.1);
    assert!(shared.1 < apart.1, "{} bytes of {}", shared.1, apart.1);
}

#[test]
fn a_frame_is_covered_and_measuring_has_a_price() {
    let folder = tempfile::tempdir().unwrap();
    let stat = render(folder.path(), &["--frames", "6"]);
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let (span, sum, coverage) =
        (number(&stat["span_ms"]), number(&stat["sum_ms"]), number(&stat["coverage"]));
    assert!(span > 0.0 && sum > 0.0, "{stat}");
    assert!((0.5..1.5).contains(&coverage), "passes cover {coverage} of a frame that does nothing else");
    let profiler = &stat["profiler"];
    assert_eq!(profiler["pairs"], stat["frames"], "{profiler}");
    for what in ["record_ms", "frame_ms"] {
        let [low, median, high] = ["low", "median", "high"].map(|name| number(&profiler[what][name]));
        assert!(low <= median && median <= high, "{what}: {low} <= {median} <= {high}");
    }
    assert!(stat["passes"][0].get("pipeline_statistics").is_none(), "not asked for");
}

#[test]
fn a_trace_opens_with_both_lanes() {
    let folder = tempfile::tempdir().unwrap();
    let stat = render(folder.path(), &["--frames", "6", "--trace", "trace.json"]);
    let trace = json(&folder.path().join("trace.json"));
    let clocks = trace["otherData"]["clocks"].as_str().unwrap();
    assert!(clocks.starts_with("calibrated"), "llvmpipe has VK_EXT_calibrated_timestamps: {clocks}");
    let events = trace["traceEvents"].as_array().unwrap();
    let times: Vec<f64> = events.iter().filter_map(|event| event["ts"].as_f64()).collect();
    assert!(times.is_sorted(), "{times:?}");
    let frames = stat["frames"].as_u64().unwrap() as usize;
    for pass in stat["passes"].as_array().unwrap() {
        let lane = |lane: u64| -> Vec<(f64, f64)> {
            let here =
                |event: &&Value| event["ph"] == "X" && event["tid"] == lane && event["name"] == pass["name"];
            let span = |event: &Value| (event["ts"].as_f64().unwrap(), event["dur"].as_f64().unwrap());
            events.iter().filter(here).map(span).collect()
        };
        let (recorded, worked) = (lane(1), lane(2));
        assert_eq!((recorded.len(), worked.len()), (frames, frames), "{}", pass["name"]);
        for (recorded, worked) in recorded.iter().zip(&worked) {
            assert!(recorded.0 + recorded.1 <= worked.0, "{} ran before it was recorded", pass["name"]);
        }
    }
    for lane in ["CPU: recording", "GPU: queue"] {
        let named = |event: &&Value| event["name"] == "thread_name" && event["args"]["name"] == lane;
        assert_eq!(events.iter().filter(named).count(), 1, "{lane}");
    }
}

#[test]
fn a_plan_lists_what_its_passes_do() {
    let folder = tempfile::tempdir().unwrap();
    let spot = root().join("assets/mesh/spot.glb").display().to_string();
    let plan = |more: &[&str]| {
        let arguments = [&["plan", &spot, "--measure", "--device", "cpu", "--quiet"], more].concat();
        let output = Command::new(env!("CARGO_BIN_EXE_airglow"))
            .current_dir(folder.path())
            .args(arguments)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let json: Value = serde_json::from_str(&plan(&["--json"])).unwrap();
    let steps: Vec<_> = json["steps"].as_array().unwrap().iter().map(|step| &step["name"]).collect();
    let measured = json["measured"].as_array().unwrap();
    assert_eq!(steps, measured.iter().map(|pass| &pass["name"]).collect::<Vec<_>>());
    assert!(measured.iter().all(|pass| pass["median_ms"].as_f64().is_some_and(|time| time > 0.0)), "{json}");
    assert_eq!(measured.last().unwrap()["counts"]["dispatches"], 1, "the tone map");
    let text = plan(&[]);
    let (_, measured) = text.split_once("measured (").unwrap();
    assert!(measured.contains("tone map") && measured.contains("dispatches 1"), "{text}");
}
