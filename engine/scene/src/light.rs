//! Light sources: the punctual ones of glTF and what a scene file adds.

/// A point, spot or directional light of KHR_lights_punctual, in world space.
///
/// glTF counts photometrically; candela are read as W/sr and lux as W/m2, one to one and for each of red,
/// green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The file's name, or `light N`.
    pub name: String,
    /// The node that places it.
    pub node: usize,
    /// Its shape and strength.
    pub kind: LightKind,
}

/// Shape and strength of a [`Light`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Shines alike in all directions.
    Point {
        /// Metres, world space.
        position: [f32; 3],
        /// Radiant intensity, W/sr.
        intensity: [f32; 3],
        /// Metres from which on nothing arrives; `None` for no end.
        range: Option<f32>,
    },
    /// Shines in a cone.
    Spot {
        /// Metres, world space.
        position: [f32; 3],
        /// Unit axis of the cone, away from the light.
        direction: [f32; 3],
        /// Radiant intensity inside the inner cone, W/sr.
        intensity: [f32; 3],
        /// Metres from which on nothing arrives; `None` for no end.
        range: Option<f32>,
        /// Half angle of full intensity, radians, 0 <= inner < outer.
        inner: f32,
        /// Half angle from which on nothing arrives, radians, at most pi / 2.
        outer: f32,
    },
    /// Shines from infinitely far away.
    Directional {
        /// Unit direction in which the light travels.
        direction: [f32; 3],
        /// Irradiance on a surface that faces it, W/m2.
        irradiance: [f32; 3],
    },
}

/// A glowing sphere or box near the surfaces, from a scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct Emitter {
    /// For people.
    pub name: String,
    /// Metres, world space.
    pub center: [f32; 3],
    /// Its shape about the centre.
    pub shape: EmitterShape,
    /// Radiance of its surface, W/sr/m2, not negative.
    pub radiance: [f32; 3],
    /// Where its centre is at the end of its way, if it moves: metres, world space.
    pub to: Option<[f32; 3]>,
}

/// Shape of an [`Emitter`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EmitterShape {
    /// A sphere.
    Sphere {
        /// Metres, positive.
        radius: f32,
    },
    /// A box along the axes of the world.
    Box {
        /// Metres along x, y and z, positive.
        size: [f32; 3],
    },
}

/// A sphere that stops light without being drawn, from a scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocker {
    /// For people.
    pub name: String,
    /// Metres, world space.
    pub center: [f32; 3],
    /// Metres, positive.
    pub radius: f32,
}

/// Contrast that is left at the visibility distance (Koschmieder's law).
pub const VISIBILITY_CONTRAST: f32 = 0.02;

/// A homogeneous medium that fills the scene, from a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Extinction coefficient for red, green and blue, 1/m, not negative.
    pub extinction: [f32; 3],
    /// Scattering albedo (scattering / extinction) in [0, 1].
    pub albedo: [f32; 3],
    /// Mean cosine g of the Henyey-Greenstein phase function, -0.999 to 0.999; 0 is isotropic.
    pub anisotropy: f32,
}

impl Medium {
    /// Extinction, 1/m, of a medium in which [`VISIBILITY_CONTRAST`] is left after `visibility` metres.
    pub fn extinction_of_visibility(visibility: f32) -> f32 {
        -VISIBILITY_CONTRAST.ln() / visibility
    }
}
