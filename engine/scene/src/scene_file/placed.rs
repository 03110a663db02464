//! Files that a scene file places.

use std::path::PathBuf;

use glam::{Mat4, Vec3};
use serde::Deserialize;
use toml::Spanned;

use super::values::{Albedo, Fraction, Rgb, Rotation, Scale, Times, Vector};
use crate::material::{Material, MaterialClass};

/// `[[gltf]]` and `[[instance]]`: a file and where it goes.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Placed {
    pub(super) file: PathBuf,
    pub(super) mesh: Option<Spanned<String>>,
    /// How often each triangle is cut into four.
    #[serde(default)]
    pub(super) subdivide: Times,
    pub(super) translation: Option<Vector>,
    #[serde(default)]
    pub(super) rotation: Rotation,
    pub(super) scale: Option<Scale>,
    pub(super) material: Option<MaterialTable>,
}

impl Placed {
    /// Scale, then rotation, then translation.
    pub(super) fn components(&self) -> (Vec3, glam::Quat, Vec3) {
        let scale = self.scale.map_or(Vec3::ONE, Vec3::from);
        (scale, self.rotation.0, self.translation.map_or(Vec3::ZERO, Vec3::from))
    }

    pub(super) fn transform(&self) -> Mat4 {
        let (scale, rotation, translation) = self.components();
        Mat4::from_scale_rotation_translation(scale, rotation, translation)
    }
}

/// `material`: one surface for all that is placed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    base_color: Option<Albedo>,
    metallic: Option<Fraction>,
    roughness: Option<Fraction>,
    emissive: Option<Rgb>,
}

impl MaterialTable {
    pub(super) fn material(&self, name: String) -> Material {
        let [r, g, b] = self.base_color.map_or([1.0; 3], Into::into);
        let metallic = self.metallic.map_or(0.0, |value| value.0);
        let roughness = self.roughness.map_or(1.0, |value| value.0);
        Material {
            name,
            class: MaterialClass::of(metallic, roughness),
            base_color: [r, g, b, 1.0],
            metallic,
            roughness,
            emissive: self.emissive.map_or([0.0; 3], Into::into),
            ..Material::default()
        }
    }
}
