//! What a bake depends on, as one hash.

use glam::{Mat4, Vec3};

use crate::{BelowHorizon, Mesh, Occluder, Settings};

/// Version of the layout and of the meaning of the numbers in it. It rises whenever a bake of the same input
/// would come out differently.
pub const SCHEMA: u32 = 1;

/// BLAKE3 of the schema, the settings, the mesh and the occluders in reach. Equal keys mean equal bakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CacheKey(blake3::Hash);

impl CacheKey {
    /// Hashes the arguments of a bake. Occluders whose bounds the mesh's vertices cannot reach are left out:
    /// moving something far away does not spoil a bake of short reach. Faulty arguments get a key too; the bake
    /// refuses them.
    #[must_use]
    pub fn new(mesh: &Mesh<'_>, transform: Mat4, occluders: &[Occluder<'_>], settings: &Settings) -> Self {
        let mut hasher = Hasher::default();
        hasher.text("airglow bake");
        hasher.number(SCHEMA.into());
        hasher.settings(settings);
        hasher.values(mesh.positions.as_flattened());
        hasher.values(mesh.normals.as_flattened());
        hasher.values(mesh.indices);
        hasher.values(&transform.to_cols_array());
        let reached = Bounds::of(mesh.positions, transform).grown(settings.reach);
        for occluder in occluders {
            if reached.meets(&Bounds::of(occluder.positions, occluder.transform)) {
                hasher.occluder(occluder);
            }
        }
        Self(hasher.0.finalize())
    }

    /// The hash as 64 hexadecimal digits: a good file name.
    #[must_use]
    pub fn to_hex(&self) -> String {
        self.0.to_hex().to_string()
    }
}

#[derive(Default)]
struct Hasher(blake3::Hasher);

impl Hasher {
    fn number(&mut self, number: u64) {
        self.0.update(&number.to_le_bytes());
    }

    /// Every slice is preceded by its length, so that no two inputs give one stream.
    fn values<T: bytemuck::NoUninit>(&mut self, values: &[T]) {
        self.number(values.len() as u64);
        self.0.update(bytemuck::cast_slice(values));
    }

    fn text(&mut self, text: &str) {
        self.values(text.as_bytes());
    }

    fn settings(&mut self, settings: &Settings) {
        let below = match settings.visibility {
            None => 0,
            Some(BelowHorizon::Mean) => 1,
            Some(BelowHorizon::Visible) => 2,
            Some(BelowHorizon::Blocked) => 3,
        };
        let numbers = [settings.order as u64, settings.rays.into(), below, settings.seed.into()];
        numbers.into_iter().for_each(|number| self.number(number));
        self.values(&[settings.reach]);
    }

    fn occluder(&mut self, occluder: &Occluder<'_>) {
        self.values(occluder.positions.as_flattened());
        self.values(occluder.indices);
        self.values(&occluder.transform.to_cols_array());
        match occluder.mask {
            Some(mask) => self.values(mask.key),
            None => self.number(u64::MAX),
        }
    }
}

/// Axis-aligned bounds in the space baked in.
struct Bounds {
    min: Vec3,
    max: Vec3,
}

impl Bounds {
    fn of(positions: &[[f32; 3]], transform: Mat4) -> Self {
        let empty = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };
        positions
            .iter()
            .map(|p| transform.transform_point3(Vec3::from(*p)))
            .fold(empty, |bounds, point| Self { min: bounds.min.min(point), max: bounds.max.max(point) })
    }

    /// Grown by the reach and by a margin for rounding.
    fn grown(self, reach: f32) -> Self {
        let margin = reach + 1e-5 * self.min.abs().max(self.max.abs()).max_element();
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// False only where a gap is certain: bounds that are NaN meet everything.
    fn meets(&self, other: &Self) -> bool {
        !(self.min.cmpgt(other.max).any() || self.max.cmplt(other.min).any())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    const UP: [[f32; 3]; 3] = [[0.0, 0.0, 1.0]; 3];

    fn mesh() -> Mesh<'static> {
        Mesh { name: "triangle", positions: &TRIANGLE, normals: &UP, indices: &[0, 1, 2] }
    }

    #[test]
    fn every_input_counts() {
        let base = CacheKey::new(&mesh(), Mat4::IDENTITY, &[mesh().occluder()], &Settings::default());
        let key =
            |settings: Settings| CacheKey::new(&mesh(), Mat4::IDENTITY, &[mesh().occluder()], &settings);
        assert_eq!(base, key(Settings::default()));
        let changed = [
            key(Settings { order: 5, ..Settings::default() }),
            key(Settings { rays: 255, ..Settings::default() }),
            key(Settings { seed: 1, ..Settings::default() }),
            key(Settings { reach: 1.0, ..Settings::default() }),
            key(Settings { visibility: Some(BelowHorizon::Mean), ..Settings::default() }),
            key(Settings { visibility: Some(BelowHorizon::Blocked), ..Settings::default() }),
            CacheKey::new(
                &mesh(),
                Mat4::from_scale(Vec3::splat(2.0)),
                &[mesh().occluder()],
                &Settings::default(),
            ),
            CacheKey::new(&mesh(), Mat4::IDENTITY, &[], &Settings::default()),
            CacheKey::new(
                &Mesh { indices: &[0, 2, 1], ..mesh() },
                Mat4::IDENTITY,
                &[mesh().occluder()],
                &Settings::default(),
            ),
        ];
        for (i, one) in changed.iter().enumerate() {
            assert!(*one != base && !changed[..i].contains(one), "change {i} does not show in the key");
        }
    }

    #[test]
    fn only_occluders_in_reach_count() {
        let far = |x| mesh().occluder_at(Mat4::from_translation(Vec3::new(x, 0.0, 0.0)));
        let key = |x, reach| {
            CacheKey::new(&mesh(), Mat4::IDENTITY, &[far(x)], &Settings { reach, ..Settings::default() })
        };
        assert_eq!(key(10.0, 2.0), key(20.0, 2.0));
        assert_ne!(key(10.0, 2.0), key(2.5, 2.0));
        assert_ne!(key(10.0, f32::INFINITY), key(20.0, f32::INFINITY));
    }
}
