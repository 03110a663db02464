//! Lobes of a scene's normal maps as files that asset pipelines hand on, with what each storage loses.

use std::path::{Path, PathBuf};

use airglow::math::statistics::relative_l2;
use airglow::normals::cache::PackedChain;
use airglow::normals::{
    Bench, Brdf, Directions, Mixture, NormalMap, Settings, Storage, WeightedLobe, blocks, chain, ktx2,
    octahedral, reference, shade,
};
use airglow_scene::Scene;
use glam::DVec3;
use serde::Serialize;

use crate::failure::{Failure, Outcome};
use crate::files;
use crate::host::device::Device;
use crate::report::normals::Map;

/// Texels of each level that errors are taken over, and lights of each.
const TEXELS: usize = 12;
const ROWS: usize = 8;
/// From level 2 on.
const LEVELS: usize = 4;
/// Exponents of the reflection.
const EXPONENTS: [f64; 2] = [50.0, 200.0];
const LOBES: usize = 4;

/// A file.
#[derive(Serialize)]
pub struct Baked {
    file: PathBuf,
    bytes: u64,
    kept: Vec<Kept>,
}

/// A way to store the lobes, in the file or beside it.
#[derive(Serialize)]
struct Kept {
    storage: String,
    bytes_a_texel_of_the_map: f64,
    /// Relative L2 error of the radiance against the map's own texels, at the exponents 50 and 200.
    errors: Vec<f64>,
}

/// Writes a KTX2 file for each map of a scene, in two BC5 layers a lobe.
pub fn write(device: &Device<'_>, scene: &Scene, folder: &Path) -> Outcome<Vec<Baked>> {
    let maps = Map::of_scenes(std::slice::from_ref(scene))?;
    maps.iter().map(|map| one(device, map, folder)).collect()
}

fn one(device: &Device<'_>, map: &Map, folder: &Path) -> Outcome<Baked> {
    let run = device.bench();
    let bench = Bench { context: device.context(), run: &run };
    let texels = map.normals.normals().len() as f64;
    let mut kept = Vec::new();
    let mut add = |storage: String, bytes: u64, lobes: &[Vec<Vec<WeightedLobe>>]| -> Outcome {
        let errors = errors(&map.normals, lobes)?;
        kept.push(Kept { storage, bytes_a_texel_of_the_map: bytes as f64 / texels, errors });
        Ok(())
    };
    let mut octahedral = None;
    for storage in Storage::ALL {
        let settings = Settings { storage, budget: Some(u64::MAX), ..Settings::default() };
        let levels = chain::levels(&map.normals, &settings).map_err(Failure::work)?;
        let texture = bench.texture(&map.normals, &settings).map_err(Failure::work)?;
        let Some(texture) = texture else {
            return Err(Failure::input(format!("{}: a single texel has no levels", map.name)));
        };
        let bytes = bench.bytes(&texture).map_err(Failure::work)?;
        let lobes = |(level, bytes): (&chain::Level, &Vec<u8>)| {
            let lobes: Vec<WeightedLobe> =
                storage.decode(bytes).into_iter().map(WeightedLobe::from).collect();
            by_texel(&lobes, level.size[0] * level.size[1])
        };
        let all: Vec<_> = levels.iter().zip(&bytes).map(lobes).collect();
        add(format!("{storage:?}"), texture.bytes, &all)?;
        if storage == Storage::Octahedral8 {
            octahedral = Some((levels, PackedChain { levels: bytes }));
        }
    }
    let (levels, chain) = octahedral.ok_or_else(|| Failure::work("no storage takes four bytes"))?;
    let compressed = ktx2::compressed(&levels, LOBES, &chain).map_err(Failure::work)?;
    let unpacked = levels.iter().zip(&compressed).map(|(level, bytes)| decompressed(level.size, bytes));
    add(
        "BC5".to_owned(),
        compressed.iter().map(|level| level.len() as u64).sum(),
        &unpacked.collect::<Outcome<Vec<_>>>()?,
    )?;
    let bytes = ktx2::file(levels[0].size, 2 * LOBES, &compressed).map_err(Failure::work)?;
    let stem = Path::new(&map.name).file_stem().map_or("map".into(), |stem| stem.to_string_lossy());
    let file = folder.join(format!("{stem}.ktx2"));
    files::write(&file, &bytes)?;
    Ok(Baked { file, bytes: bytes.len() as u64, kept })
}

/// Lobes that lie layer by layer, texel by texel.
fn by_texel(lobes: &[WeightedLobe], texels: usize) -> Vec<Vec<WeightedLobe>> {
    (0..texels).map(|texel| lobes.iter().skip(texel).step_by(texels).copied().collect()).collect()
}

/// The lobes of a level's blocks, texel by texel.
fn decompressed([width, height]: [usize; 2], bytes: &[u8]) -> Outcome<Vec<Vec<WeightedLobe>>> {
    let of_layer = |bytes: &[u8]| blocks::decode(width, height, bytes).map_err(Failure::work);
    let layers = bytes.chunks(bytes.len() / (2 * LOBES)).map(of_layer).collect::<Outcome<Vec<_>>>()?;
    let lobe = |pair: &[Vec<[f64; 2]>], texel: usize| {
        let [[x, y], [width, weight]] = [pair[0][texel], pair[1][texel]];
        octahedral::decode([x, y, width, weight])
    };
    Ok((0..width * height).map(|texel| layers.chunks(2).map(|pair| lobe(pair, texel)).collect()).collect())
}

/// The error of lobes by level and texel, over texels and lights spread evenly, at the highlights.
fn errors(map: &NormalMap, levels: &[Vec<Vec<WeightedLobe>>]) -> Outcome<Vec<f64>> {
    let of_exponent = |exponent: f64| {
        let brdf = Brdf::BlinnPhong { exponent };
        let (mut values, mut truths) = (Vec::new(), Vec::new());
        for (finer, texels) in levels.iter().enumerate().skip(1).take(LEVELS) {
            let width = map.size(finer + 1)[0];
            for at in 0..TEXELS {
                let texel = at * texels.len() / TEXELS;
                let footprint =
                    map.footprint(finer + 1, texel % width, texel / width).map_err(Failure::work)?;
                let mixture = Mixture::new(texels[texel].clone()).map_err(Failure::work)?;
                for row in 0..ROWS {
                    let normal = footprint[(row * footprint.len() / ROWS + at) % footprint.len()].mean;
                    let light = (normal + DVec3::new(0.4, 0.1 * row as f64 - 0.3, 0.2)).normalize();
                    let view = 2.0 * light.dot(normal) * normal - light;
                    let directions = Directions::new(light, view).map_err(Failure::work)?;
                    truths.push(reference::radiance(&footprint, brdf, directions));
                    values.push(shade::radiance(&mixture, brdf, directions));
                }
            }
        }
        relative_l2(&values, &truths).map_err(Failure::work)
    };
    EXPONENTS.into_iter().map(of_exponent).collect()
}

/// For people.
pub fn text(baked: &[Baked]) -> String {
    let mut text = String::new();
    for Baked { file, bytes, kept } in baked {
        text.push_str(&format!(
            "{}, {bytes} bytes; storage, bytes a texel of the map, error at 50 and 200\n",
            file.display()
        ));
        for Kept { storage, bytes_a_texel_of_the_map, errors } in kept {
            let errors: Vec<String> = errors.iter().map(|error| format!("{:6.1} %", 100.0 * error)).collect();
            text.push_str(&format!("  {storage:12} {bytes_a_texel_of_the_map:5.2} {}\n", errors.join(" ")));
        }
    }
    text
}
