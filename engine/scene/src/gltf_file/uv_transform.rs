//! KHR_texture_transform: where a material's texture lies on its coordinates.

use serde_json::Value;

/// The transform as the file states it.
#[derive(Clone, Copy)]
pub(super) struct UvTransform {
    offset: [f32; 2],
    rotation: f32,
    scale: [f32; 2],
    pub(super) set: Option<u32>,
}

impl From<gltf::texture::TextureTransform<'_>> for UvTransform {
    fn from(transform: gltf::texture::TextureTransform<'_>) -> Self {
        Self {
            offset: transform.offset(),
            rotation: transform.rotation(),
            scale: transform.scale(),
            set: transform.tex_coord(),
        }
    }
}

impl UvTransform {
    /// The transform of the normal texture of `material`, a material's JSON, which the gltf crate does not read.
    pub(super) fn of_normal_texture(material: &Value) -> Result<Option<Self>, serde_json::Error> {
        let Some(found) = material.pointer("/normalTexture/extensions/KHR_texture_transform") else {
            return Ok(None);
        };
        let read: gltf::json::extensions::texture::TextureTransform = serde_json::from_value(found.clone())?;
        let (offset, rotation, scale) = (read.offset.0, read.rotation.0, read.scale.0);
        Ok(Some(Self { offset, rotation, scale, set: read.tex_coord }))
    }

    /// Translation * rotation * scale, as the extension defines them.
    pub(super) fn affine(&self) -> [[f32; 3]; 2] {
        let ([x, y], [u, v]) = (self.offset, self.scale);
        let (sine, cosine) = self.rotation.sin_cos();
        [[cosine * u, sine * v, x], [-sine * u, cosine * v, y]]
    }
}
