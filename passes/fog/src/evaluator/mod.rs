//! The airlight of one light along one stretch of a ray, in f32: the arithmetic that the shaders repeat line by line.
//!
//! Stands on Sun, thesis (2008), section 3.3, freed of its angles. With Δ the distance along the ray from the light's
//! foot, h the light's offset from the ray and d = √(h² + Δ²), the path of light over a point of the ray is its foot's
//! distance plus m = Δ + d, and dx/d² = 2 dm/(h² + m²). So
//!
//! ```text
//! ∫ exp(-β (x + d)) / d² dx = exp(-β path) K,    K = 2 ∫ exp(-β q) / (h² + (m + q)²) dq,   q from 0 to excess
//! ```
//!
//! where `path` is the optical path over the stretch's near end and `excess` how much longer the one over its far end
//! is: no exponent is positive, no angle appears, and no two terms cancel. [`taps`] gives K for any phase function and
//! hook, [`poles`] in closed form for an isotropic, homogeneous medium. [`lobe`] gives what a surface reflects of the glow.
//!
//! Only operations of GLSL are used, none of them trigonometric.

pub mod lobe;
pub mod poles;
pub mod taps;

#[cfg(test)]
mod tests;

/// Stands for an unbounded length: the square of its ratio to a millimetre stays finite.
pub const INFINITE: f32 = 1e15;

/// Offsets below this part of the light's distance along the ray are raised to it: airlight diverges on a ray through
/// a point light.
const SMALLEST_ANGLE: f32 = 1e-8;

/// The same for a light at the eye, in metres.
const SMALLEST_OFFSET: f32 = 1e-12;

/// Where a light lies as seen from a ray.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Distance from the eye, in metres.
    pub distance: f32,
    /// Distance of its foot along the ray; negative behind the eye.
    pub along: f32,
    /// Distance from the ray, the length of the rejection (or cross product), never `√(distance² - along²)`.
    pub offset: f32,
    /// Radius of the lamp, 0 for a point.
    ///
    /// The irradiance at distance d of a uniform disc of this radius that faces the point is I/(d² + radius²), exactly;
    /// the path is that to its rim. So a lamp is a point light moved off the ray by its radius, and its airlight is
    /// finite on every ray.
    pub radius: f32,
}

/// One stretch of a ray, in metres; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// h, the light's offset from the ray, its radius included.
    pub offset: f32,
    /// m at the near end.
    pub start: f32,
    /// √(h² + m²), the distance on which the integrand falls.
    pub scale: f32,
    /// Length of the path over the near end: from the eye along the ray, then to the light.
    pub path: f32,
    /// How much longer the path over the far end is.
    pub excess: f32,
}

impl Segment {
    /// The stretch of `length` metres (up to [`INFINITE`]) that begins `near` metres from the eye.
    ///
    /// The length is asked for because the difference of two distances along the ray would lose it.
    pub fn new(light: Light, near: f32, length: f32) -> Self {
        let ahead = near - light.along;
        let floor = SMALLEST_ANGLE * ahead.abs() + SMALLEST_OFFSET;
        let offset = (light.offset * light.offset + light.radius * light.radius).sqrt().max(floor);
        let near_distance = (offset * offset + ahead * ahead).sqrt();
        let beyond = ahead + length;
        let far_distance = (offset * offset + beyond * beyond).sqrt();
        let start = path_beyond_foot(offset, ahead, near_distance);
        let end = path_beyond_foot(offset, beyond, far_distance);
        let path = if near == 0.0 && light.radius == 0.0 { light.distance } else { near + near_distance };
        let excess = length * ((start + end) / (near_distance + far_distance));
        Self { offset, start, scale: (offset * offset + start * start).sqrt(), path, excess }
    }
}

/// m = Δ + d without cancellation before the foot.
fn path_beyond_foot(offset: f32, ahead: f32, distance: f32) -> f32 {
    if ahead >= 0.0 { ahead + distance } else { offset * offset / (distance - ahead) }
}

/// `exp(-extinction * length)` to 2e-7 relative, though its exponent's rounding alone would cost up to 5e-6.
pub fn transmittance(extinction: f32, length: f32) -> f32 {
    let depth = extinction * length;
    let lost = extinction.mul_add(length, -depth);
    exp_negative(depth) * (1.0 - lost)
}

/// `exp(-x)` for x >= 0 as 2^-n exp(-r), whatever the precision of the hardware's `exp` for large arguments.
fn exp_negative(x: f32) -> f32 {
    // ln 2 in two parts, the first of few digits, so that n times it is exact.
    const LN_2_HIGH: f32 = 0.693_359_4;
    const LN_2_LOW: f32 = -2.121_944_4e-4;
    let n = (x.min(150.0) * std::f32::consts::LOG2_E).round();
    let r = (x - n * LN_2_HIGH) - n * LN_2_LOW;
    (-r).exp() * (-n).exp2()
}
