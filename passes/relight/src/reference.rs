//! The f64 truth of every kernel in this room.
//!
//! Sloan, Kautz, Snyder, "Precomputed Radiance Transfer" (2002); Sun, "Analytic, Wavelet and Frequency Based
//! Mathematical Models for Real-Time Rendering" (2008), sections 2.5 and 5.2.1, eqs. 5.8-5.10 and 5.14. The
//! projection of an environment, rotations and products are those of `airglow-math`.

use airglow_math::sh::product::TripleProduct;
use airglow_math::sh::rotation::Rotation;
use airglow_math::sh::zonal;
use glam::{DQuat, DVec3};

use crate::RelightError;
use crate::rotation::{Orientation, object_space};

/// SH RGB of one light or one vertex: order^2 coefficients.
pub type Sh = Vec<[f64; 3]>;

/// The light in the frame of an instance: the environment's vector turned by `instance^-1 environment`, then inverted
/// where the instance is: `Y_lm(-s) = (-1)^l Y_lm(s)`.
///
/// # Errors
/// [`RelightError::Math`] for a zero or non-finite quaternion or a wrong length.
pub fn light(
    order: usize,
    environment: &[[f64; 3]],
    turn: DQuat,
    instance: impl Into<Orientation>,
) -> Result<Sh, RelightError> {
    let instance = instance.into();
    let rotation = Rotation::from_quaternion(order, object_space(turn, instance.rotation)?)?;
    let mut light = rotation.apply_rgb(environment)?;
    for l in 0..order {
        let sign = instance.band_sign(l);
        light[l * l..(l + 1) * (l + 1)].as_flattened_mut().iter_mut().for_each(|value| *value *= sign);
    }
    Ok(light)
}

/// The transfer vector of a vertex that nothing shadows: the clamped cosine about its normal over pi (Sun 2008,
/// eqs. 2.21-2.25 and 5.14); zero for a zero normal.
///
/// # Errors
/// [`RelightError::Math`] for an order out of range.
pub fn unshadowed(order: usize, normal: DVec3) -> Result<Vec<f64>, RelightError> {
    let mut transfer = vec![0.0; order * order];
    let largest = normal.abs().max_element();
    if largest > 0.0 {
        let factors: Vec<f64> =
            zonal::clamped_cosine(order)?.into_iter().map(|factor| factor / std::f64::consts::PI).collect();
        zonal::rotate_to_direction(&factors, (normal / largest).normalize(), &mut transfer)?;
    }
    Ok(transfer)
}

/// The colour of a vertex without dynamic visibility: t_p . l for each channel (Sun 2008, section 2.5).
#[must_use]
pub fn colour(transfer: &[f64], light: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (t, l) in transfer.iter().zip(light) {
        for (sum, l) in sum.iter_mut().zip(l) {
            *sum += t * l;
        }
    }
    sum
}

/// The colour of a vertex with dynamic visibility: the triple product <t, l, v> (Sun 2008, section 5.2.1).
///
/// # Errors
/// [`RelightError::Math`] for a wrong length.
pub fn shadowed_colour(
    tensor: &TripleProduct,
    transfer: &[f64],
    light: &[[f64; 3]],
    visibility: &[f64],
) -> Result<[f64; 3], RelightError> {
    let mut product = vec![0.0; transfer.len()];
    tensor.product(transfer, visibility, &mut product)?;
    Ok(colour(&product, light))
}

/// The incident radiance with shadow in it: M_l v, where v is the SH product of the visibilities that are there
/// (Sun 2008, eqs. 5.8 and 5.10 and section 5.2.1).
///
/// # Errors
/// [`RelightError::Math`] for a wrong length.
pub fn incident(
    tensor: &TripleProduct,
    light: &[[f64; 3]],
    baked: Option<&[f64]>,
    dynamic: Option<&[f64]>,
) -> Result<Sh, RelightError> {
    let mut seen = vec![0.0; light.len()];
    match (baked, dynamic) {
        (Some(a), Some(b)) => tensor.product(a, b, &mut seen)?,
        (Some(one), None) | (None, Some(one)) => seen.copy_from_slice(one),
        // Nothing blocks: visibility is 1.
        (None, None) => return Ok(light.to_vec()),
    }
    let mut result = vec![[0.0; 3]; light.len()];
    let mut product = vec![0.0; light.len()];
    for channel in 0..3 {
        let plane: Vec<f64> = light.iter().map(|rgb| rgb[channel]).collect();
        tensor.product(&plane, &seen, &mut product)?;
        for (rgb, value) in result.iter_mut().zip(&product) {
            rgb[channel] = *value;
        }
    }
    Ok(result)
}
