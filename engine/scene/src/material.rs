//! Surfaces: glTF's metallic-roughness model in linear units, and the class a lighting pass picks by.

/// A surface. Colours are linear Rec. 709; each factor multiplies its texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The file's name, or `material N`.
    pub name: String,
    /// What kind of reflection the factors add up to; see [`MaterialClass`].
    pub class: MaterialClass,
    /// Linear base colour (albedo of a dielectric, specular colour of a metal) and alpha, each in [0, 1].
    pub base_color: [f32; 4],
    /// Base colour texture, sRGB-encoded; alpha is linear.
    pub base_color_texture: Option<Texture>,
    /// 0 for a dielectric, 1 for a metal.
    pub metallic: f32,
    /// Perceptual roughness in [0, 1]; the width of GGX is its square.
    pub roughness: f32,
    /// Roughness in green, metallic in blue; linear.
    pub metallic_roughness_texture: Option<Texture>,
    /// Tangent-space normals, RGB = xyz * 0.5 + 0.5, green up (+Y), linear.
    pub normal_texture: Option<Texture>,
    /// Multiplies x and y of the normal texture.
    pub normal_scale: f32,
    /// Emitted radiance, W/sr/m2: emissive factor times KHR_materials_emissive_strength.
    pub emissive: [f32; 3],
    /// Multiplies `emissive`; sRGB-encoded.
    pub emissive_texture: Option<Texture>,
    /// What alpha means.
    pub alpha: AlphaMode,
    /// The back is seen and lit too.
    pub double_sided: bool,
}

impl Default for Material {
    /// White, Lambertian, opaque, one-sided: what a primitive without a material gets.
    ///
    /// glTF's own default is metallic; a mesh that says nothing is better shown as plaster.
    fn default() -> Self {
        Self {
            name: "default".into(),
            class: MaterialClass::Lambert,
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
        }
    }
}

/// Roughness from which a dielectric counts as [`MaterialClass::Lambert`].
pub const LAMBERT_ROUGHNESS: f32 = 0.9;

/// The class of a surface, from its factors: a texture only makes a surface smoother or less metallic than
/// its factor says, so the factor decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MaterialClass {
    /// Metallic below 0.5 and roughness at least [`LAMBERT_ROUGHNESS`]: diffuse transfer is enough.
    Lambert,
    /// Metallic below 0.5 and smoother: a diffuse and a specular lobe.
    Glossy,
    /// Metallic 0.5 or more: a specular lobe only.
    Metal,
    /// KHR_materials_unlit: the base colour is the picture; no pass lights it.
    Unlit,
}

impl MaterialClass {
    /// The class of a lit surface with these factors, each in [0, 1].
    pub fn of(metallic: f32, roughness: f32) -> Self {
        if metallic >= 0.5 {
            Self::Metal
        } else if roughness >= LAMBERT_ROUGHNESS {
            Self::Lambert
        } else {
            Self::Glossy
        }
    }
}

/// What the alpha of the base colour means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Nothing: the surface is opaque.
    Opaque,
    /// The surface is a hole where alpha is below the cutoff, for bake rays too.
    Mask {
        /// In [0, 1].
        cutoff: f32,
    },
    /// Blended over what lies behind. Not supported: drawn as opaque, with a warning.
    Blend,
}

/// An image read through texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Index into [`crate::Scene::images`].
    pub image: usize,
    /// Wrapping along u and v.
    pub wrap: [Wrap; 2],
    /// Between texels: the nearest one (true) or linear interpolation (false).
    pub nearest: bool,
    /// Rows of the affine map of KHR_texture_transform: u' = row0 . (u, v, 1), v' = row1 . (u, v, 1).
    pub transform: [[f32; 3]; 2],
}

/// The identity of [`Texture::transform`].
pub const IDENTITY_UV: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

impl Texture {
    /// Texture coordinates after [`Texture::transform`].
    pub fn transformed(&self, uv: [f32; 2]) -> [f32; 2] {
        self.transform.map(|row| row[0] * uv[0] + row[1] * uv[1] + row[2])
    }
}

/// What lies outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image again, every other one mirrored.
    MirroredRepeat,
    /// The colour of the edge.
    ClampToEdge,
}
