//! Cache files: used when sound and fitting, otherwise replaced, with the reason.

use std::path::Path;

use crate::common::Shape;
use airglow_bake::cache::{
    CacheError, CacheKey, CachedBakeError, Miss, Precision, Source, bake_cached, load, store,
};
use airglow_bake::{BakeError, BelowHorizon, Report, Settings, Silent, Threads, Transfer};
use glam::Mat4;
use std::ops::ControlFlow;

fn settings() -> Settings {
    Settings { rays: 32, visibility: Some(BelowHorizon::Blocked), ..Settings::default() }
}

#[expect(clippy::unwrap_used, reason = "a test helper")]
fn run(path: &Path, precision: Precision, settings: &Settings) -> (Transfer, Source) {
    let shape = Shape::bumpy_sphere(12, 8);
    let (mesh, occluder) = (shape.mesh(), shape.mesh().occluder());
    bake_cached(path, precision, &mesh, Mat4::IDENTITY, &[occluder], settings, &Threads::ONE, &mut Silent)
        .unwrap()
}

fn key(settings: &Settings) -> CacheKey {
    let shape = Shape::bumpy_sphere(12, 8);
    CacheKey::new(&shape.mesh(), Mat4::IDENTITY, &[shape.mesh().occluder()], settings)
}

#[test]
fn a_bake_comes_back_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bake.safetensors");
    for precision in [Precision::F32, Precision::F16] {
        let (baked, source) = run(&path, precision, &settings());
        assert!(matches!(source, Source::Baked { .. }), "{source:?}");
        let (read, source) = run(&path, precision, &settings());
        assert!(matches!(source, Source::Cache), "{source:?}");
        assert_eq!(baked, read, "{precision:?}");
        // The same input gives the same file.
        let bytes = std::fs::read(&path).unwrap();
        store(&path, &key(&settings()), precision, &read).unwrap();
        assert!(bytes == std::fs::read(&path).unwrap());
    }
    let files = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(files, 1, "temporary files left behind");
}

#[test]
fn whatever_does_not_fit_is_baked_again_for_a_stated_reason() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bake.safetensors");
    let reason = |settings: &Settings, precision| match run(&path, precision, settings).1 {
        Source::Cache => "none".to_owned(),
        Source::Baked { miss, .. } => format!("{miss:?}"),
    };
    assert_eq!(reason(&settings(), Precision::F32), "Absent");
    assert_eq!(reason(&settings(), Precision::F32), "none");
    assert_eq!(reason(&settings(), Precision::F16), "OtherPrecision");
    assert_eq!(reason(&Settings { seed: 9, ..settings() }, Precision::F16), "OtherInput");
    let sound = std::fs::read(&path).unwrap();
    let text = |bytes: &[u8], from: &str, to: &str| {
        let text = String::from_utf8_lossy(&bytes[8..]).into_owned();
        let at = text.find(from).unwrap_or_else(|| panic!("{from} is not in the header")) + 8;
        [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat()
    };
    let mut flipped = sound.clone();
    *flipped.last_mut().unwrap() ^= 1;
    let damages = [
        (Vec::new(), "Damaged"),
        (sound[..sound.len() / 2].to_vec(), "Damaged"),
        (sound[..sound.len() - 1].to_vec(), "Damaged"),
        ([&sound[..], b"more"].concat(), "Damaged"),
        (flipped, "Damaged"),
        (b"not a safetensors file at all".to_vec(), "Damaged"),
        (vec![0xff; 64], "Damaged"),
        (text(&sound, r#"\"schema\":1"#, r#"\"schema\":0"#), "OtherSchema { found: 0 }"),
        (text(&sound, r#"\"schema\":1"#, r#"\"schema\":7"#), "OtherSchema { found: 7 }"),
        (text(&sound, r#"\"order\":4"#, r#"\"order\":5"#), "Damaged"),
        (text(&sound, "airglow.bake", "another.tool"), "Foreign"),
    ];
    let settings = Settings { seed: 9, ..settings() };
    for (bytes, expected) in damages {
        std::fs::write(&path, &bytes).unwrap();
        let found = reason(&settings, Precision::F16);
        assert!(found.starts_with(expected), "{found} for {expected}");
        assert!(sound == std::fs::read(&path).unwrap(), "the file after {expected}");
    }
}

#[test]
fn every_truncation_and_flipped_header_byte_is_a_miss_or_sound() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bake.safetensors");
    let (transfer, _) = run(&path, Precision::F16, &settings());
    let sound = std::fs::read(&path).unwrap();
    for place in 0..600 {
        let mut bytes = sound.clone();
        bytes[place] ^= 0x15;
        std::fs::write(&path, &bytes).unwrap();
        if let Ok(read) = load(&path, &key(&settings()), Precision::F16) {
            assert_eq!(read, transfer, "byte {place}");
        }
        std::fs::write(&path, &sound[..place]).unwrap();
        let miss = load(&path, &key(&settings()), Precision::F16).unwrap_err();
        assert!(matches!(miss, Miss::Damaged(_)), "{miss:?}");
    }
}

#[test]
fn failures_leave_the_old_file_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bake.safetensors");
    std::fs::write(&path, "old").unwrap();
    let shape = Shape::bumpy_sphere(12, 8);
    let mut stop = |_: &Report| ControlFlow::Break(());
    let cancelled = bake_cached(
        &path,
        Precision::F32,
        &shape.mesh(),
        Mat4::IDENTITY,
        &[],
        &settings(),
        &Threads::ONE,
        &mut stop,
    );
    assert!(matches!(cancelled, Err(CachedBakeError::Bake(BakeError::Cancelled))), "{cancelled:?}");
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    let odd = Transfer { order: 2, vertex_count: 3, coefficients: vec![0.0; 11], visibility: None };
    let refused = store(&path, &key(&settings()), Precision::F32, &odd);
    assert!(matches!(refused, Err(CacheError::Shape { found: 11, expected: 12 })), "{refused:?}");
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    let nowhere = folder.path().join("no such folder").join("bake.safetensors");
    let good = Transfer { coefficients: vec![0.0; 12], ..odd };
    let error = store(&nowhere, &key(&settings()), Precision::F32, &good).unwrap_err().to_string();
    assert!(error.contains("no such folder"), "{error}");
}
