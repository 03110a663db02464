//! `airglow explain` where the pass has nothing to do.

#![cfg(feature = "relight")]

use std::path::Path;
use std::process::Command;

#[test]
fn a_scene_without_an_environment_is_explained_as_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let spot = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/mesh/spot.glb");
    let explain = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
        let output = command.current_dir(folder.path()).args(["explain", "relight"]).arg(&spot).args(more);
        let output = output.output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let text = explain(&[]);
    for word in ["relight is left out", "the scene has no environment", "--environment"] {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
    let record: serde_json::Value = serde_json::from_str(&explain(&["--json"])).unwrap();
    assert_eq!(record["what"], "relight");
    assert!(record["bytes"].as_u64().unwrap() > 0, "{record}");
    assert!(!folder.path().join(".cache").exists(), "nothing is baked");
}
