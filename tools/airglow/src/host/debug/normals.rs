//! What normal maps hold under each pixel: the level looked up there, and the lobes of its texel.

use airglow::normals::bench::LevelLobes;
use airglow::normals::{Bench, Settings, WeightedLobe};
use airglow_scene::Texture;
use glam::{DVec3, Vec2};

use super::{Shown, View};
use crate::compare::legend::Values;
use crate::failure::{Failure, Outcome};
use crate::host::mapped;

/// The views.
pub const VIEWS: [View; 3] = [
    View { name: "normals-level", title: "level of the normal map that is looked up", high: None },
    View { name: "normals-lobes", title: "lobes with a hundredth of the weight or more", high: Some(6.0) },
    View { name: "normals-spread", title: "1 - length of the mean normal", high: None },
];

/// Places along the longer side of a footprint, at most: `MAPPED_TAPS` of `host/mapped.glsl`.
const TAPS: f32 = 8.0;
/// The weight from which a lobe counts.
const SEEN: f64 = 0.01;

/// A material's map.
struct Map {
    size: Vec2,
    /// From level 1 on.
    levels: Vec<LevelLobes>,
}

/// The values of one of them.
pub fn values(shown: &Shown<'_>, name: &str) -> Outcome<Values> {
    let maps = maps(shown)?;
    let pixels = shown.numbers(coordinates(shown)?)?;
    let value = |pixel: usize| {
        let (map, at, level) = shown.looked_up(&pixels, &maps, pixel)?;
        if name == "normals-level" {
            return Some(level);
        }
        let texel = texel(map, at, level);
        Some(match name {
            "normals-lobes" => texel.iter().filter(|lobe| lobe.weight >= SEEN).count() as f32,
            _ => {
                let weight: f64 = texel.iter().map(|lobe| lobe.weight).sum();
                let moment: DVec3 = texel.iter().map(|lobe| lobe.moment).sum();
                if weight > 0.0 { (1.0 - moment.length() / weight).max(0.0) as f32 } else { 0.0 }
            }
        })
    };
    let width = shown.settings.size[0] as usize;
    Ok(Values { width, values: (0..pixels.len()).map(value).collect() })
}

/// Texture coordinates of each vertex, moved to be positive, and the number of its instance from 1 on.
fn coordinates(shown: &Shown<'_>) -> Outcome<Vec<Vec<[f32; 3]>>> {
    let of = |(number, instance): (usize, &airglow_scene::Instance)| {
        let uv = &shown.scene.meshes[instance.mesh].uv0;
        let low = uv.iter().copied().map(Vec2::from).fold(Vec2::ZERO, Vec2::min).floor();
        let moved = |uv: &[f32; 2]| [uv[0] - low.x, uv[1] - low.y, (number + 1) as f32];
        match uv.is_empty() {
            true => {
                shown.everywhere(number, 0.0).into_iter().map(|_| [0.0, 0.0, (number + 1) as f32]).collect()
            }
            false => uv.iter().map(moved).collect(),
        }
    };
    Ok(shown.scene.instances.iter().enumerate().map(of).collect())
}

/// The map of each material, fitted as the scene's preset says or by default.
fn maps(shown: &Shown<'_>) -> Outcome<Vec<Option<Map>>> {
    let settings = shown.scene.presets.of("normals").map_or_else(Settings::default, Settings::from);
    let run = shown.device.bench();
    let bench = Bench { context: shown.device.context(), run: &run };
    let of = |material: &airglow_scene::Material| -> Outcome<Option<Map>> {
        let Some(Texture { image, .. }) = material.normal_texture else { return Ok(None) };
        let Some(image) = shown.scene.images.get(image) else { return Ok(None) };
        let normals = mapped::normals(image, material.normal_scale)?;
        let size = Vec2::new(image.width as f32, image.height as f32);
        let levels = bench.build(&normals, &settings).map_err(Failure::work)?;
        Ok((!levels.is_empty()).then_some(Map { size, levels }))
    };
    let maps = shown.scene.materials.iter().map(of).collect::<Outcome<Vec<_>>>()?;
    match maps.iter().all(Option::is_none) {
        true => Err(Failure::input("the scene has no normal map")),
        false => Ok(maps),
    }
}

impl Shown<'_> {
    /// The map that a pixel looks up, where, and at which level; none where there is no map.
    fn looked_up<'m>(
        &self,
        pixels: &[[f32; 3]],
        maps: &'m [Option<Map>],
        pixel: usize,
    ) -> Option<(&'m Map, Vec2, f32)> {
        let width = self.settings.size[0] as usize;
        let [u, v, number] = *pixels.get(pixel)?;
        let instance = self.scene.instances.get((number.round() as usize).checked_sub(1)?)?;
        let map = maps.get(instance.material)?.as_ref()?;
        let at = Vec2::new(u, v);
        // How far the next pixels on the same surface are, in texels of the map.
        let step = |next: usize| {
            let [u, v, same] = *pixels.get(next)?;
            ((same - number).abs() < 0.5).then(|| ((Vec2::new(u, v) - at) * map.size).length())
        };
        // Of both sides the nearer: the other may lie beyond a seam.
        let nearer = |one: Option<f32>, other: Option<f32>| one.into_iter().chain(other).reduce(f32::min);
        let right = if (pixel + 1).is_multiple_of(width) { None } else { step(pixel + 1) };
        let left = if pixel.is_multiple_of(width) { None } else { step(pixel - 1) };
        let across = nearer(left, right)?;
        let along = nearer(step(pixel + width), pixel.checked_sub(width).and_then(step))?;
        // As `mapped_at` of `host/mapped.glsl` has it, which takes several places along the longer side.
        let longer = across.max(along);
        let taps = (longer / across.min(along).max(1e-3)).ceil().clamp(1.0, TAPS);
        let level = (longer / taps).max(1e-6).log2();
        Some((map, at, level.clamp(0.0, map.levels.len() as f32)))
    }
}

/// The lobes of the texel that a place falls into, of the level from 1 on that is nearest.
fn texel(map: &Map, at: Vec2, level: f32) -> Vec<WeightedLobe> {
    let level = &map.levels[(level.round() as usize).clamp(1, map.levels.len()) - 1];
    let place = |at: f32, size: usize| ((at - at.floor()) * size as f32) as usize % size;
    let texel = place(at.y, level.size[1]) * level.size[0] + place(at.x, level.size[0]);
    let count = level.lobes.len() / (level.size[0] * level.size[1]);
    level.lobes[texel * count..][..count].iter().map(|&lobe| lobe.into()).collect()
}
