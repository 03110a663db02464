//! Numbers and shapes of a scene file. Each refuses what it cannot mean while it is parsed, so that the message
//! carries the line.

use glam::{Quat, Vec3};
use serde::Deserialize;

/// A kind of number with the range it allows.
macro_rules! number {
    ($(#[$doc:meta])* $name:ident, $expected:literal, $test:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(try_from = "f64")]
        pub(super) struct $name(pub(super) f32);

        impl TryFrom<f64> for $name {
            type Error = String;

            fn try_from(stated: f64) -> Result<Self, String> {
                let value = stated as f32;
                let test: fn(f32) -> bool = $test;
                if value.is_finite() && test(value) {
                    Ok(Self(value))
                } else {
                    Err(format!("{stated} found, {} expected", $expected))
                }
            }
        }
    };
}

number!(
    /// Any number.
    Finite,
    "a finite number",
    |_| true
);
number!(
    /// Above 0.
    Positive,
    "a positive number",
    |value| value > 0.0
);
number!(
    /// 0 or above.
    NotNegative,
    "a number not below 0",
    |value| value >= 0.0
);
number!(
    /// From 0 to 1.
    Fraction,
    "a number from 0 to 1",
    |value| (0.0..=1.0).contains(&value)
);
number!(
    /// The mean cosine of a phase function: nearer to 1 it is a beam.
    MeanCosine,
    "a number from -0.999 to 0.999",
    |value| (-0.999..=0.999).contains(&value)
);
number!(
    /// An angle of view.
    ViewDegrees,
    "an angle above 0 and below 180 degrees",
    |value| value > 0.0 && value < 180.0
);
number!(
    /// Anything but 0.
    NotZero,
    "a number other than 0",
    |value| value != 0.0
);

/// How often something is done.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(try_from = "u32")]
pub(super) struct Times(pub(super) u32);

impl TryFrom<u32> for Times {
    type Error = String;

    fn try_from(stated: u32) -> Result<Self, String> {
        if stated <= 6 {
            Ok(Self(stated))
        } else {
            Err(format!("{stated} found, a number from 0 to 6 expected"))
        }
    }
}

/// A point or a direction.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) struct Vector([Finite; 3]);

impl From<Vector> for Vec3 {
    fn from(vector: Vector) -> Self {
        vector.0.map(|value| value.0).into()
    }
}

/// Radiance, coefficients and the like: red, green and blue, or one number for all three.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number not below 0, or three of them: [red, green, blue]")]
pub(super) enum Rgb {
    Same(NotNegative),
    Each([NotNegative; 3]),
}

impl From<Rgb> for [f32; 3] {
    fn from(rgb: Rgb) -> Self {
        match rgb {
            Rgb::Same(value) => [value.0; 3],
            Rgb::Each(values) => values.map(|value| value.0),
        }
    }
}

/// Albedos: red, green and blue, or one number for all three, each from 0 to 1.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number from 0 to 1, or three of them: [red, green, blue]")]
pub(super) enum Albedo {
    Same(Fraction),
    Each([Fraction; 3]),
}

impl From<Albedo> for [f32; 3] {
    fn from(albedo: Albedo) -> Self {
        match albedo {
            Albedo::Same(value) => [value.0; 3],
            Albedo::Each(values) => values.map(|value| value.0),
        }
    }
}

/// Scales along the axes, or one for all three; negative ones mirror.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number other than 0, or three of them: [x, y, z]")]
pub(super) enum Scale {
    Same(NotZero),
    Each([NotZero; 3]),
}

impl From<Scale> for Vec3 {
    fn from(scale: Scale) -> Self {
        match scale {
            Scale::Same(value) => Self::splat(value.0),
            Scale::Each(values) => values.map(|value| value.0).into(),
        }
    }
}

/// `{ yaw = degrees }`, about +Y and counter-clockwise from above, or `{ axis = [x, y, z], degrees = angle }`.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(try_from = "RotationFields")]
pub(super) struct Rotation(pub(super) Quat);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RotationFields {
    yaw: Option<Finite>,
    axis: Option<Vector>,
    degrees: Option<Finite>,
}

impl TryFrom<RotationFields> for Rotation {
    type Error = &'static str;

    fn try_from(fields: RotationFields) -> Result<Self, Self::Error> {
        let (axis, degrees) = match (fields.yaw, fields.axis, fields.degrees) {
            (Some(yaw), None, None) => (Vec3::Y, yaw),
            (None, Some(axis), Some(degrees)) => (axis.into(), degrees),
            _ => return Err("a rotation is { yaw = degrees } or { axis = [x, y, z], degrees = angle }"),
        };
        let axis = axis.try_normalize().ok_or("the axis of a rotation must not be zero")?;
        Ok(Self(Quat::from_axis_angle(axis, degrees.0.to_radians())))
    }
}
