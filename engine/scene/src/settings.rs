//! What a scene file says about quality, with the defaults.

use serde::Deserialize;

/// What the light transport is computed with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Bands of spherical harmonics of the transfer vectors, 1 to 6: order^2 coefficients.
    pub order: u32,
    /// Rays for each vertex, 1 to 65536.
    pub rays: u32,
    /// How transfer vectors are kept on the GPU.
    pub storage: Storage,
    /// What casts shadows on what.
    pub shadow: Shadow,
}

impl Default for Quality {
    /// Order 4, 1024 rays, f32, shadows of the whole scene.
    fn default() -> Self {
        Self { order: 4, rays: 1024, storage: Storage::F32, shadow: Shadow::Scene }
    }
}

/// Number format of transfer vectors on the GPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Storage {
    /// 4 bytes.
    F32,
    /// 2 bytes.
    F16,
}

/// What casts shadows on what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Shadow {
    /// Every instance on every instance: one bake for each instance.
    Scene,
    /// Each mesh on itself: one bake for each mesh, shared by its instances.
    Object,
    /// Nothing on nothing.
    Unshadowed,
}
