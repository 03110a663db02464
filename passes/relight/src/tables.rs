//! Constant tables the kernels read, made in f64 and rounded once.

use airglow_math::sh::product::TripleProduct;
use airglow_math::sphere::equirect::EquirectBasis;
use glam::{DMat3, DQuat, DVec3};

use crate::RelightError;

/// The integrals of the basis over the columns and rows of an equirectangular map, as f32: the layouts of
/// [`EquirectBasis::columns`] and [`EquirectBasis::rows`].
pub(crate) struct MapTables {
    pub columns: Vec<f32>,
    pub rows: Vec<f32>,
}

impl MapTables {
    pub(crate) fn new(order: usize, width: u32, height: u32) -> Result<Self, RelightError> {
        let basis = EquirectBasis::new(order, width as usize, height as usize)?;
        let round = |values: &[f64]| values.iter().map(|value| *value as f32).collect();
        Ok(Self { columns: round(basis.columns()), rows: round(basis.rows()) })
    }
}

/// The rotation from the frame of an equirectangular map, in which a direction d has the components
/// (-d.z, -d.x, d.y), to the frame of the convention.
pub(crate) fn map_frame() -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(DVec3::NEG_Z, DVec3::NEG_X, DVec3::Y))
}

/// The sparse triple-product tensor as `tensor.glsl` reads it: where the entries of each coefficient begin, then
/// the entries, j in the low half and k in the high half of a word followed by the bits of gamma.
pub(crate) fn tensor(order: usize) -> Result<Vec<u32>, RelightError> {
    let tensor = TripleProduct::new(order)?;
    let count = order * order;
    let mut words = vec![0; count + 1];
    for entry in tensor.entries() {
        words[entry.k as usize + 1] += 1;
    }
    for i in 0..count {
        words[i + 1] += words[i];
    }
    for entry in tensor.entries() {
        words.extend([entry.i | entry.j << 16, (entry.gamma as f32).to_bits()]);
    }
    Ok(words)
}

/// Counts the values that `wrong` picks out: how many, and the first.
pub(crate) fn count_wrong<T: Copy>(values: &[T], wrong: impl Fn(T) -> bool) -> Option<(usize, usize)> {
    let first = values.iter().position(|value| wrong(*value))?;
    let count = values[first..].iter().filter(|value| wrong(**value)).count();
    Some((count, first))
}

/// Refuses an environment that would poison every coefficient: texels that are NaN, infinite or negative.
///
/// The pass itself sees only the image on the device; a host calls this on the texels before it uploads them.
///
/// # Errors
/// [`RelightError::Length`] unless there are `width * height` texels, [`RelightError::Values`] with the count of
/// bad texels and the first of them.
pub fn check_environment(
    name: &str,
    width: u32,
    height: u32,
    texels: &[[f32; 3]],
) -> Result<(), RelightError> {
    let expected = width as usize * height as usize;
    if texels.len() != expected {
        let (name, what, actual) = (name.to_owned(), "texels", texels.len());
        return Err(RelightError::Length { name, what, expected, actual });
    }
    let not_finite = count_wrong(texels, |texel| texel.into_iter().any(|c| !c.is_finite()));
    let negative = count_wrong(texels, |texel| texel.into_iter().any(|c| c < 0.0));
    let (problem, (count, first)) = match (not_finite, negative) {
        (Some(found), _) => ("NaN or infinite", found),
        (None, Some(found)) => ("negative", found),
        (None, None) => return Ok(()),
    };
    Err(RelightError::Values { name: name.to_owned(), what: "texels", problem, count, first })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tensor_has_the_known_number_of_entries() {
        for (order, entries) in [(1, 1), (2, 10), (3, 83), (4, 353), (5, 1158), (6, 2907)] {
            let words = tensor(order).unwrap();
            let count = order * order;
            assert_eq!(words[count], entries, "order {order}");
            assert_eq!(words.len(), count + 1 + 2 * entries as usize);
        }
    }

    #[test]
    fn nan_and_negative_texels_are_refused_with_their_count() {
        let mut texels = vec![[1.0; 3]; 12];
        assert!(check_environment("sky", 4, 3, &texels).is_ok());
        texels[5][1] = f32::NAN;
        texels[7][2] = f32::INFINITY;
        let message = check_environment("sky", 4, 3, &texels).unwrap_err().to_string();
        assert!(message.contains("2 of the texels") && message.contains("the first at 5"), "{message}");
        texels[5][1] = 0.0;
        texels[7][2] = -1.0;
        let message = check_environment("sky", 4, 3, &texels).unwrap_err().to_string();
        assert!(message.contains("negative") && message.contains("the first at 7"), "{message}");
        assert!(check_environment("sky", 4, 4, &texels).is_err());
    }
}
