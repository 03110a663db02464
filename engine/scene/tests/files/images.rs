//! Pictures on disk: what is written is read back, and what cannot be radiance is refused.

use crate::support::put;
use airglow_scene::{FloatImage, SceneError, image_io};

fn picture() -> FloatImage {
    let value = |i: usize| [i as f32, 1e5 / (i + 1) as f32, 1e-6 * i as f32];
    FloatImage { width: 5, height: 3, pixels: (0..15).map(value).collect() }
}

#[test]
fn exr_keeps_every_bit() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.exr");
    image_io::write_exr(&file, &picture()).unwrap();
    assert_eq!(image_io::read_image(&file).unwrap(), picture());
    let environment = image_io::read_environment(&file).unwrap();
    assert_eq!((environment.width, environment.pixels), (5, picture().pixels));
}

#[test]
fn png_comes_back_within_half_a_step() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.png");
    let bytes: Vec<[u8; 3]> = (0..=255).map(|i| [i, 255 - i, i / 2]).collect();
    image_io::write_png_bytes(&file, 16, 16, &bytes).unwrap();
    let read = image_io::read_image(&file).unwrap();
    for (found, expected) in read.pixels.iter().zip(&bytes) {
        let encoded = found.map(|value| (255.0 * airglow_scene::srgb_encode(value)).round() as u8);
        assert_eq!(encoded, *expected);
    }
}

#[test]
fn radiance_pictures_are_read_and_exposure_undone() {
    let folder = tempfile::tempdir().unwrap();
    // Two pixels: mantissas 128, 64, 0 with exponent 129 (x 2 / 256) and 1, 1, 2 with 136 (x 1).
    let pixels = [128, 64, 0, 129, 1, 1, 2, 136];
    for (line, divisor) in [("", 1.0), ("EXPOSURE=4\n", 4.0)] {
        let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{line}\n-Y 1 +X 2\n");
        let file = put(&folder, "a.hdr", &[header.as_bytes(), &pixels].concat());
        let read = image_io::read_environment(&file).unwrap();
        let expected = [[1.0, 0.5, 0.0], [1.0, 1.0, 2.0]].map(|pixel| pixel.map(|x| x / divisor));
        assert_eq!(read.pixels, expected);
    }
}

#[test]
fn impossible_radiance_is_counted_and_located() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.exr");
    for bad in [f32::NAN, f32::INFINITY, -1e-3] {
        let mut broken = picture();
        broken.pixels[7][1] = bad;
        broken.pixels[9][2] = bad;
        image_io::write_exr(&file, &broken).unwrap();
        let error = image_io::read_environment(&file).unwrap_err();
        assert!(matches!(error, SceneError::Radiance { count: 2, x: 2, y: 1, .. }), "{error}");
        assert!(error.to_string().contains("a.exr: 2 pixels") && error.to_string().contains("clamp"));
        // As a plain picture it is what it is.
        assert!(image_io::read_image(&file).is_ok());
    }
}

#[test]
fn absurd_sizes_are_refused_before_memory_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    for size in ["-Y 2000000000 +X 2000000000", "-Y 32768 +X 32768", "-Y 1 +X 4000000000"] {
        let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
        let file = put(&folder, "a.hdr", header.as_bytes());
        let error = image_io::read_environment(&file).unwrap_err();
        let refused = matches!(error, SceneError::TooLarge { .. } | SceneError::Invalid { .. });
        assert!(refused && error.to_string().contains("a.hdr"), "{size}: {error}");
    }
    // The data window of an EXR file: four corners behind the attribute's name and type.
    let file = folder.path().join("a.exr");
    image_io::write_exr(&file, &picture()).unwrap();
    let mut bytes = std::fs::read(&file).unwrap();
    for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
        let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len() + 4;
        bytes[at + 8..at + 16].copy_from_slice(bytemuck::bytes_of(&[1_000_000_i32, 1_000_000]));
    }
    let error = image_io::read_image(&put(&folder, "b.exr", &bytes)).unwrap_err();
    assert!(matches!(error, SceneError::TooLarge { .. }), "{error}");
}

#[test]
fn incomplete_pictures_are_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let short = FloatImage { width: 5, height: 4, ..picture() };
    for name in ["a.exr", "a.png"] {
        let file = folder.path().join(name);
        let result = match name {
            "a.exr" => image_io::write_exr(&file, &short),
            _ => image_io::write_png(&file, &short, 1.0),
        };
        assert!(matches!(result, Err(SceneError::Invalid { .. })), "{result:?}");
        assert!(!file.exists());
    }
    let unknown = image_io::read_image(&put(&folder, "a.tga", b"")).unwrap_err();
    assert!(unknown.to_string().contains("name an .exr, .hdr or .png file"), "{unknown}");
}
