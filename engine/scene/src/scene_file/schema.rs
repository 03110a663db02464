//! The tables of a scene file, as this crate's README describes them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use airglow_math::{MathError, Preset};
use glam::Vec3;
use serde::Deserialize;
use toml::Spanned;

use super::figure::FigureTable;
use super::placed::Placed;
use super::values::{Albedo, Finite, MeanCosine, NotNegative, Positive, Rgb, Rotation, Vector, ViewDegrees};
use crate::exposure::{Exposure, scale_of_ev};
use crate::light::{Blocker, Emitter, EmitterShape, Medium};
use crate::presets::{LIGHT_TRANSPORT, Presets};
use crate::settings::{Quality, Shadow, Storage};

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    #[serde(default)]
    pub(super) gltf: Vec<Placed>,
    #[serde(default)]
    pub(super) instance: Vec<Placed>,
    #[serde(default)]
    pub(super) figure: Vec<FigureTable>,
    pub(super) environment: Option<EnvironmentTable>,
    pub(super) medium: Option<MediumTable>,
    #[serde(default)]
    pub(super) emitter: Vec<EmitterTable>,
    #[serde(default)]
    pub(super) blocker: Vec<BlockerTable>,
    pub(super) camera: Option<CameraTable>,
    #[serde(default)]
    pub(super) exposure: ExposureTable,
    #[serde(default)]
    pub(super) quality: QualityTable,
}

/// `[environment]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnvironmentTable {
    pub(super) file: PathBuf,
    #[serde(default)]
    pub(super) rotation: Rotation,
    pub(super) scale: Option<NotNegative>,
    pub(super) distance: Option<NotNegative>,
}

/// `[medium]`.
#[derive(Debug, Deserialize)]
#[serde(try_from = "MediumFields")]
pub(super) struct MediumTable(pub(super) Medium);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MediumFields {
    extinction: Option<Rgb>,
    visibility: Option<Positive>,
    albedo: Option<Albedo>,
    anisotropy: Option<MeanCosine>,
}

impl TryFrom<MediumFields> for MediumTable {
    type Error = &'static str;

    fn try_from(fields: MediumFields) -> Result<Self, Self::Error> {
        let extinction = match (fields.extinction, fields.visibility) {
            (Some(extinction), None) => extinction.into(),
            (None, Some(visibility)) => [Medium::extinction_of_visibility(visibility.0); 3],
            _ => return Err("a medium has either extinction (1/m) or visibility (m)"),
        };
        Ok(Self(Medium {
            extinction,
            albedo: fields.albedo.map_or([1.0; 3], Into::into),
            anisotropy: fields.anisotropy.map_or(0.0, |value| value.0),
        }))
    }
}

/// `[[emitter]]`.
#[derive(Debug, Deserialize)]
#[serde(try_from = "EmitterFields")]
pub(super) struct EmitterTable {
    name: Option<String>,
    center: Vector,
    shape: EmitterShape,
    radiance: Rgb,
    to: Option<Vector>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EmitterFields {
    name: Option<String>,
    center: Vector,
    radius: Option<Positive>,
    size: Option<[Positive; 3]>,
    radiance: Rgb,
    to: Option<Vector>,
}

impl TryFrom<EmitterFields> for EmitterTable {
    type Error = &'static str;

    fn try_from(fields: EmitterFields) -> Result<Self, Self::Error> {
        let shape = match (fields.radius, fields.size) {
            (Some(radius), None) => EmitterShape::Sphere { radius: radius.0 },
            (None, Some(size)) => EmitterShape::Box { size: size.map(|side| side.0) },
            _ => {
                return Err("an emitter has either a radius (m) of a sphere or the size (m, three) of a box");
            }
        };
        Ok(Self { name: fields.name, center: fields.center, shape, radiance: fields.radiance, to: fields.to })
    }
}

impl EmitterTable {
    pub(super) fn emitter(self, index: usize) -> Emitter {
        Emitter {
            name: self.name.unwrap_or_else(|| format!("emitter {index}")),
            center: Vec3::from(self.center).into(),
            shape: self.shape,
            radiance: self.radiance.into(),
            to: self.to.map(|to| Vec3::from(to).into()),
        }
    }
}

/// `[[blocker]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BlockerTable {
    name: Option<String>,
    center: Vector,
    radius: Positive,
}

impl BlockerTable {
    pub(super) fn blocker(self, index: usize) -> Blocker {
        Blocker {
            name: self.name.unwrap_or_else(|| format!("blocker {index}")),
            center: Vec3::from(self.center).into(),
            radius: self.radius.0,
        }
    }
}

/// `[camera]`: one of the files', or a new one.
#[derive(Debug, Deserialize)]
#[serde(try_from = "CameraFields")]
pub(super) enum CameraTable {
    Named(Spanned<String>),
    Stated { from: Vec3, to: Vec3, up: Vec3, vertical_degrees: f32, near: f32, far: Option<f32> },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraFields {
    name: Option<Spanned<String>>,
    from: Option<Vector>,
    to: Option<Vector>,
    up: Option<Vector>,
    vertical_degrees: Option<ViewDegrees>,
    near: Option<Positive>,
    far: Option<Positive>,
}

impl TryFrom<CameraFields> for CameraTable {
    type Error = &'static str;

    fn try_from(fields: CameraFields) -> Result<Self, Self::Error> {
        const EITHER: &str = "a camera has either the name of one in the glTF files, or from and to";
        let alone = fields.up.is_none()
            && fields.vertical_degrees.is_none()
            && fields.near.is_none()
            && fields.far.is_none();
        let (from, to) = match (fields.name, fields.from, fields.to) {
            (Some(name), None, None) if alone => return Ok(Self::Named(name)),
            (None, Some(from), Some(to)) => (Vec3::from(from), Vec3::from(to)),
            _ => return Err(EITHER),
        };
        let up = fields.up.map_or(Vec3::Y, Vec3::from);
        if (from - to).cross(up).try_normalize().is_none() {
            return Err("a camera's from and to must differ, and not only along up");
        }
        let near = fields.near.map_or(0.01 * from.distance(to), |near| near.0);
        let far = fields.far.map(|far| far.0);
        if far.is_some_and(|far| far <= near) {
            return Err("a camera's far plane must lie beyond its near plane");
        }
        let vertical_degrees = fields.vertical_degrees.map_or(45.0, |degrees| degrees.0);
        Ok(Self::Stated { from, to, up, vertical_degrees, near, far })
    }
}

/// `[exposure]`.
#[derive(Debug, Default, Deserialize)]
#[serde(try_from = "ExposureFields")]
pub(super) struct ExposureTable(pub(super) Exposure);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ExposureFields {
    key: Option<Positive>,
    ev: Option<Finite>,
    scale: Option<Positive>,
}

impl TryFrom<ExposureFields> for ExposureTable {
    type Error = &'static str;

    fn try_from(fields: ExposureFields) -> Result<Self, Self::Error> {
        let exposure = match (fields.key, fields.ev, fields.scale) {
            (None, None, None) => Exposure::default(),
            (Some(key), None, None) => Exposure::Automatic { key: key.0 },
            (None, Some(ev), None) if ev.0.abs() <= 100.0 => Exposure::Fixed { scale: scale_of_ev(ev.0) },
            (None, Some(_), None) => return Err("ev is a number of stops from -100 to 100"),
            (None, None, Some(scale)) => Exposure::Fixed { scale: scale.0 },
            _ => return Err("exposure has one of key (automatic), ev (stops) and scale"),
        };
        Ok(Self(exposure))
    }
}

/// `[quality]`.
#[derive(Debug, Default, Deserialize)]
#[serde(try_from = "QualityFields")]
pub(super) struct QualityTable {
    pub(super) quality: Quality,
    pub(super) presets: Presets,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct QualityFields {
    preset: Option<PresetName>,
    #[serde(default)]
    presets: BTreeMap<String, PresetName>,
    order: Option<u32>,
    rays: Option<u32>,
    storage: Option<Storage>,
    shadow: Option<Shadow>,
}

/// A preset by its name.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "String")]
struct PresetName(Preset);

impl TryFrom<String> for PresetName {
    type Error = MathError;

    fn try_from(name: String) -> Result<Self, MathError> {
        name.parse().map(Self)
    }
}

impl TryFrom<QualityFields> for QualityTable {
    type Error = &'static str;

    fn try_from(fields: QualityFields) -> Result<Self, Self::Error> {
        let rooms = fields.presets.into_iter().map(|(room, PresetName(preset))| (room, preset)).collect();
        let presets = Presets { all: fields.preset.map(|PresetName(preset)| preset), rooms };
        let default = presets.of(LIGHT_TRANSPORT).map_or_else(Quality::default, Quality::from);
        let order = fields.order.unwrap_or(default.order);
        let rays = fields.rays.unwrap_or(default.rays);
        if !(1..=6).contains(&order) {
            return Err("order is a whole number from 1 to 6");
        }
        if !(1..=65_536).contains(&rays) {
            return Err("rays is a whole number from 1 to 65536");
        }
        let storage = fields.storage.unwrap_or(default.storage);
        let shadow = fields.shadow.unwrap_or(default.shadow);
        Ok(Self { quality: Quality { order, rays, storage, shadow }, presets })
    }
}
