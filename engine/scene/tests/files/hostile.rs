//! Thousands of broken files: each is read or refused, none panics. Byte-wise changes and truncations for every
//! format, and changes to the JSON of glTF files that stay JSON.

use crate::support;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::support::{asset, full_model, glb, put};
use airglow_scene::{FloatImage, image_io};
use serde_json::{Value, json};

/// A small generator (Marsaglia's xorshift64*), so that a failure can be repeated.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() >> 33) as usize % limit.max(1)
    }
}

/// Changes a few bytes, most of them among the first `head`, or cuts the file off.
fn damage(bytes: &[u8], head: usize, random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if random.below(4) == 0 {
        bytes.truncate(random.below(bytes.len()));
        return bytes;
    }
    for _ in 0..=random.below(6) {
        let reach = if random.below(4) == 0 { bytes.len() } else { head.min(bytes.len()) };
        let at = random.below(reach);
        bytes[at] = match random.below(4) {
            0 => 0,
            1 => 255,
            2 => bytes[at] ^ 1 << random.below(8),
            _ => random.next() as u8,
        };
    }
    bytes
}

/// Reads `count` damaged files with `read`; returns how many were read in spite of it.
fn survive(
    name: &str,
    count: u64,
    make: impl Fn(&mut Random) -> Vec<u8>,
    read: impl Fn(&Path) -> bool,
) -> u64 {
    let folder = tempfile::tempdir().unwrap();
    let mut good = 0;
    for seed in 1..=count {
        let bytes = make(&mut Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
        let file = put(&folder, name, &bytes);
        match catch_unwind(AssertUnwindSafe(|| read(&file))) {
            Ok(read) => good += u64::from(read),
            Err(_) => panic!("{name}: seed {seed} panics"),
        }
    }
    good
}

fn load(file: &Path) -> bool {
    airglow_scene::load(file).is_ok()
}

#[test]
fn damaged_glb_bytes() {
    let model = full_model().glb();
    let good = survive("a.glb", 6000, |random| damage(&model, model.len(), random), load);
    assert!((1..6000).contains(&good), "{good} of 6000 were read");
    for (name, head) in [("mesh/spot.glb", 1500), ("mesh/lights_room.glb", 3000)] {
        let bytes = std::fs::read(asset(name)).unwrap();
        let good = survive("a.glb", 300, |random| damage(&bytes, head, random), load);
        assert!(good < 300, "{name}: damage was never noticed");
    }
}

#[test]
fn hostile_gltf_documents() {
    let model = full_model();
    let mut json = model.json.clone();
    json["buffers"] = json!([{ "byteLength": model.buffer.len() }]);
    let make = |random: &mut Random| {
        let mut json = json.clone();
        for _ in 0..=random.below(2) {
            change(&mut json, random);
        }
        glb(&serde_json::to_vec(&json).unwrap(), &model.buffer)
    };
    let good = survive("a.glb", 12_000, make, load);
    assert!((100..11_900).contains(&good), "{good} of 12000 were read");
}

/// Walks down a random path and replaces, removes or doubles what it finds.
fn change(value: &mut Value, random: &mut Random) {
    let size = value.as_array().map(Vec::len).or(value.as_object().map(serde_json::Map::len)).unwrap_or(0);
    let stop = size == 0 || random.below(8) == 0;
    let at = random.below(size);
    match value {
        Value::Array(elements) if stop && size > 0 && random.below(2) == 0 => {
            let element = elements[at].clone();
            if random.below(2) == 0 { elements.push(element) } else { drop(elements.remove(at)) }
        }
        Value::Object(members) if stop && size > 0 && random.below(2) == 0 => {
            let key = members.keys().nth(at).unwrap().clone();
            members.remove(&key);
        }
        _ if stop => *value = hostile(random),
        Value::Array(elements) => change(&mut elements[at], random),
        Value::Object(members) => change(members.values_mut().nth(at).unwrap(), random),
        _ => *value = hostile(random),
    }
}

fn hostile(random: &mut Random) -> Value {
    let values = [
        json!(0),
        json!(1),
        json!(2),
        json!(3),
        json!(5),
        json!(7),
        json!(-1),
        json!(255),
        json!(4096),
        json!(u32::MAX),
        json!(1_u64 << 32),
        json!(1_u64 << 40),
        json!(i64::MAX),
        json!(u64::MAX),
        json!(0.5),
        json!(1e30),
        json!(1e300),
        json!(-1e300),
        json!(null),
        json!(true),
        json!(""),
        json!("VEC4"),
        json!("SCALAR"),
        json!("MAT4"),
        json!("weights"),
        json!("scale"),
        json!("orthographic"),
        json!("CUBICSPLINE"),
        json!("data:;base64,AAAA"),
        json!("../../../dev/zero"),
        json!(5120),
        json!(5121),
        json!(5122),
        json!(5123),
        json!(5125),
        json!(5126),
        json!([]),
        json!({}),
        json!([0, 0, 0]),
        json!([1e300, 0, 0, 0]),
    ];
    values[random.below(values.len())].clone()
}

#[test]
fn damaged_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.exr");
    let pixels = (0..64 * 32).map(|i| [i as f32, 1.0, 0.5]).collect();
    image_io::write_exr(&file, &FloatImage { width: 64, height: 32, pixels }).unwrap();
    let exr = std::fs::read(&file).unwrap();
    let read = |file: &Path| image_io::read_image(file).is_ok();
    let good = survive("a.exr", 4000, |random| damage(&exr, 400, random), read);
    assert!((1..4000).contains(&good), "{good} of 4000 EXR files were read");
    let shipped = std::fs::read(asset("env/courtyard_512.exr")).unwrap();
    survive("a.exr", 100, |random| damage(&shipped, 2500, random), read);

    let header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1.0\n\n-Y 4 +X 8\n".to_vec();
    let line: &[u8] = &[2, 2, 0, 8, 136, 9, 8, 1, 2, 3, 4, 5, 6, 7, 8, 136, 1, 136, 129];
    let hdr = [&header, line, line, line, line].concat();
    let plain = put(&folder, "a.hdr", &hdr);
    image_io::read_environment(&plain).unwrap();
    let good = survive("a.hdr", 4000, |random| damage(&hdr, hdr.len(), random), read);
    assert!((1..4000).contains(&good), "{good} of 4000 Radiance files were read");

    let png = support::png();
    let good = survive("a.png", 4000, |random| damage(&png, png.len(), random), read);
    assert!(good < 4000, "damage to PNG files was never noticed");
}

#[test]
fn damaged_scene_files() {
    let text = "[medium]\nvisibility = 10.0\nalbedo = [0.5, 1, 0]\n[exposure]\nev = 2\n[camera]\n\
        from = [0, 0, 1]\nto = [0, 0, 0]\n[[emitter]]\ncenter = [1, 2, 3]\nradius = 0.5\nradiance = 3\n";
    let bytes = text.as_bytes();
    let good = survive("a.toml", 6000, |random| damage(bytes, bytes.len(), random), load);
    assert!((1..6000).contains(&good), "{good} of 6000 were read");
}
