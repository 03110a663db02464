//! Light for shadows: its products with the cosine of normals, and a sun-like peak set apart as a disc.
//!
//! Sun 2008, section 5.2.4: `L_H(N) = L * H(N)` of eq. 5.14 is tabulated and dotted with the visibility. `H(N)` is a sum of
//! basis functions of the normal, and so is `L_H(N)`: the table is that sum's matrix, which is exact for every normal.

use airglow_math::sh::product::TripleProduct;
use airglow_math::sh::zonal::clamped_cosine;
use airglow_math::sh::{coefficient_count, evaluate};
use airglow_math::sphere::equirect::{direction, texel_solid_angle};
use glam::DVec3;

use crate::ShadowError;
use crate::circle::Cap;
use crate::order::check_order;

/// Bands of a normal that the cosine has any share of, up to order 6: of the odd ones only the first.
const BANDS: [usize; 4] = [0, 1, 2, 4];

/// Steps to the middle of a peak.
const STEPS: usize = 4;

/// A light of uniform radiance that is seen as a small circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Unit vector towards its middle.
    pub direction: DVec3,
    /// Radians.
    pub angular_radius: f64,
    /// Irradiance of a surface that faces it, RGB.
    pub irradiance: [f64; 3],
}

/// The matrix of `L_H(N)`: for each basis function of the normal in bands 0, 1, 2 and 4, `order^2` RGB coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct Products {
    order: usize,
    /// Basis function of the normal, coefficients.
    columns: Vec<(usize, Vec<[f64; 3]>)>,
}

impl Products {
    /// Of `order^2` RGB coefficients of radiance in the space of the normals.
    ///
    /// # Errors
    /// [`ShadowError::Order`], [`ShadowError::Length`].
    pub fn new(order: usize, light: &[[f64; 3]]) -> Result<Self, ShadowError> {
        check_order(order)?;
        let count = coefficient_count(order);
        if light.len() != count {
            return Err(ShadowError::Length { what: "the light", expected: count, actual: light.len() });
        }
        let tensor = TripleProduct::new(order)?;
        let channel = |c: usize| tensor.matrix(&light.iter().map(|rgb| rgb[c]).collect::<Vec<_>>());
        let (matrices, factors) = ([channel(0)?, channel(1)?, channel(2)?], clamped_cosine(order)?);
        let column = |k: usize| {
            // 1 / pi of eq. 5.14: the colour of a white surface.
            let factor = factors[k.isqrt()] / std::f64::consts::PI;
            let at = |i: usize| std::array::from_fn(|c| factor * matrices[c][i * count + k]);
            (k, (0..count).map(at).collect())
        };
        let columns = (0..count).filter(|k| BANDS.contains(&k.isqrt())).map(column).collect();
        Ok(Self { order, columns })
    }

    /// The colour of a white diffuse surface of a unit normal with `order^2` coefficients of visibility.
    ///
    /// # Errors
    /// [`ShadowError::Math`] for another length.
    pub fn lit(&self, normal: DVec3, visibility: &[f64]) -> Result<[f64; 3], ShadowError> {
        let mut basis = vec![0.0; coefficient_count(self.order)];
        evaluate(self.order, normal, &mut basis)?;
        let mut lit = [0.0; 3];
        for (k, column) in &self.columns {
            for (rgb, seen) in column.iter().zip(visibility) {
                lit.iter_mut().zip(rgb).for_each(|(sum, value)| *sum += basis[*k] * value * seen);
            }
        }
        Ok(lit)
    }

    /// As the kernel reads it: RGB and 0, column by column, of the most columns any order has.
    pub(crate) fn table(&self) -> Vec<[f32; 4]> {
        let values = self.columns.iter().flat_map(|(_, column)| column);
        values.map(|[r, g, b]| [*r as f32, *g as f32, *b as f32, 0.0]).collect()
    }

    /// Bands.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }
}

impl Disc {
    /// The share of it that caps leave to be seen: of each what circles in the plane would, eased over their rims, and
    /// the product of all.
    #[must_use]
    pub fn seen(&self, caps: &[Cap]) -> f64 {
        caps.iter().map(|cap| 1.0 - self.covered(cap)).product()
    }

    fn covered(&self, cap: &Cap) -> f64 {
        let radius = (1.0 - cap.height).clamp(-1.0, 1.0).acos();
        let between = cap.axis.dot(self.direction).clamp(-1.0, 1.0).acos();
        let (near, far) = ((radius - self.angular_radius).abs(), radius + self.angular_radius);
        let t = ((between - near) / (far - near).max(1e-9)).clamp(0.0, 1.0);
        let whole = (radius / self.angular_radius.max(1e-9)).powi(2).min(1.0);
        whole * (1.0 - t * t * (3.0 - 2.0 * t))
    }

    /// The colour of a white diffuse surface that sees a share of it.
    #[must_use]
    pub fn lit(&self, normal: DVec3, seen: f64) -> [f64; 3] {
        let cosine = normal.dot(self.direction).max(0.0);
        self.irradiance.map(|value| value * cosine * seen / std::f64::consts::PI)
    }
}

/// How a peak is told from the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitSettings {
    /// Radians around the brightest texel in which it lies, above 0 to 0.5. Default 0.1.
    pub reach: f64,
    /// The least share of all light, by the mean of the channels, that is worth a disc; 0 to 1. Default 0.05.
    pub least: f64,
}

impl Default for SplitSettings {
    fn default() -> Self {
        Self { reach: 0.1, least: 0.05 }
    }
}

/// An equirectangular environment as a rest and, where it has a sun-like peak, a disc of what was taken away: texels near
/// the brightest are brought down to the brightest of the ring around them. Flux is kept in each channel.
///
/// # Errors
/// [`ShadowError::Length`] unless there are `width height` texels; [`ShadowError::Range`] for the settings, and for a size
/// of 0.
pub fn split(
    [width, height]: [usize; 2],
    texels: &[[f32; 3]],
    settings: &SplitSettings,
) -> Result<(Vec<[f32; 3]>, Option<Disc>), ShadowError> {
    let refuse = |what, value, range| Err(ShadowError::Range { what, value, range });
    if !(settings.reach > 0.0 && settings.reach <= 0.5) {
        return refuse("the reach of a peak", settings.reach, "above 0 to 0.5");
    }
    if !(0.0..=1.0).contains(&settings.least) {
        return refuse("the least share of a peak", settings.least, "0 to 1");
    }
    let expected = width.saturating_mul(height);
    if expected == 0 || texels.len() != expected {
        let (what, actual) = ("texels of the environment", texels.len());
        return Err(ShadowError::Length { what, expected: expected.max(1), actual });
    }
    let bright = |at: usize| mean(texels[at].map(f64::from));
    let towards = |at: usize| {
        let (u, v) = ((at % width) as f64 + 0.5, (at / width) as f64 + 0.5);
        direction(u / width as f64, v / height as f64)
    };
    let peak = (0..expected).reduce(|a, b| if bright(b) > bright(a) { b } else { a }).unwrap_or(0);
    // To the middle of what is bright there: the brightest texel may lie at the rim.
    let mut middle = towards(peak);
    for _ in 0..STEPS {
        let near = (0..expected).filter(|at| towards(*at).dot(middle) > settings.reach.cos());
        let sum: DVec3 = near.map(|at| bright(at) * towards(at)).sum();
        middle = sum.try_normalize().unwrap_or(middle);
    }
    let angle = |at: usize| towards(at).dot(middle).clamp(-1.0, 1.0).acos();
    let ring = (0..expected).filter(|at| (settings.reach..2.0 * settings.reach).contains(&angle(*at)));
    let level = ring.map(bright).fold(0.0, f64::max);
    let mut rest = texels.to_vec();
    let mut taken = Taken::default();
    let mut total = 0.0;
    for at in 0..expected {
        let solid_angle = texel_solid_angle(width, height, at / width)?;
        let here = bright(at);
        total += here * solid_angle;
        if here > level && angle(at) < settings.reach {
            rest[at] = texels[at].map(|value| (f64::from(value) * level / here) as f32);
            let excess: [f64; 3] = std::array::from_fn(|c| f64::from(texels[at][c]) - f64::from(rest[at][c]));
            taken.add(excess.map(|value| value * solid_angle), towards(at), solid_angle);
        }
    }
    match taken.disc() {
        Some((disc, flux)) if flux >= settings.least * total => Ok((rest, Some(disc))),
        _ => Ok((texels.to_vec(), None)),
    }
}

fn mean(rgb: [f64; 3]) -> f64 {
    rgb.iter().sum::<f64>() / 3.0
}

/// What was taken out of texels.
#[derive(Default)]
struct Taken {
    irradiance: [f64; 3],
    vector: DVec3,
    texels: Vec<(DVec3, f64)>,
    least: f64,
}

impl Taken {
    fn add(&mut self, flux: [f64; 3], towards: DVec3, solid_angle: f64) {
        self.irradiance.iter_mut().zip(flux).for_each(|(sum, value)| *sum += value);
        let weight = mean(flux);
        self.vector += weight * towards;
        self.texels.push((towards, weight));
        self.least = self.least.max((solid_angle / std::f64::consts::PI).sqrt());
    }

    /// The disc with the same spread, and its mean flux; a texel at least.
    fn disc(&self) -> Option<(Disc, f64)> {
        let direction = self.vector.try_normalize()?;
        let flux: f64 = self.texels.iter().map(|(_, weight)| weight).sum();
        // The mean square of the angle is half of a disc's squared radius.
        let square =
            |&(towards, weight): &(DVec3, f64)| weight * 2.0 * (1.0 - towards.dot(direction)).max(0.0);
        let mean = self.texels.iter().map(square).sum::<f64>() / flux;
        let angular_radius = (2.0 * mean).sqrt().max(self.least);
        Some((Disc { direction, angular_radius, irradiance: self.irradiance }, flux))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::{ambient, truth};

    #[test]
    fn products_light_surfaces_as_the_integral_does() {
        for order in 3..=6 {
            let mut light = vec![[0.0; 3]; order * order];
            light[0] = [std::f64::consts::PI.sqrt() * 2.0; 3];
            let products = Products::new(order, &light).unwrap();
            let cap = Cap { axis: DVec3::Y, height: 0.3 };
            let seen = truth(order, 200, &[cap]).unwrap();
            for normal in [DVec3::Y, DVec3::new(0.6, 0.0, -0.8), DVec3::new(0.0, -1.0, 0.0)] {
                let (found, expected) =
                    (products.lit(normal, &seen).unwrap(), ambient(order, &seen, normal).unwrap());
                assert!((found[1] - expected).abs() < 1e-12, "{order}: {found:?} and {expected}");
            }
        }
        assert!(Products::new(4, &[[1.0; 3]; 9]).is_err() && Products::new(2, &[]).is_err());
    }

    #[test]
    fn a_peak_becomes_a_disc_and_flux_is_kept() {
        let (width, height) = (128, 64);
        let sun = DVec3::new(0.4, 0.7, -0.6).normalize();
        let texel = |at: usize| {
            let (x, y) = (at % width, at / width);
            let d = direction((x as f64 + 0.5) / 128.0, (y as f64 + 0.5) / 64.0);
            if d.dot(sun).acos() < 0.06 { [1e5, 8e4, 5e4] } else { [0.5, 0.6, 0.8 + 0.1 * d.y as f32] }
        };
        let texels: Vec<[f32; 3]> = (0..width * height).map(texel).collect();
        let (rest, disc) = split([width, height], &texels, &SplitSettings::default()).unwrap();
        let disc = disc.unwrap();
        assert!(disc.direction.dot(sun).acos() < 0.02, "{disc:?}");
        assert!((disc.angular_radius / 0.06 - 1.0).abs() < 0.3, "{disc:?}");
        for c in 0..3 {
            let flux = |texels: &[[f32; 3]]| -> f64 {
                let of = |at: usize| {
                    texel_solid_angle(width, height, at / width).unwrap() * f64::from(texels[at][c])
                };
                (0..texels.len()).map(of).sum()
            };
            let (all, kept) = (flux(&texels), flux(&rest) + disc.irradiance[c]);
            assert!((kept / all - 1.0).abs() < 1e-6, "{kept} of {all}");
        }
        assert!(rest.iter().all(|rgb| rgb[0] < 1.0));
        let (same, none) = split([width, height], &rest, &SplitSettings::default()).unwrap();
        assert!(none.is_none() && same == rest, "{none:?}");
        assert!(split([2, 2], &texels, &SplitSettings::default()).is_err());
        assert!(split([0, 0], &[], &SplitSettings::default()).is_err());
    }

    #[test]
    fn a_disc_is_hidden_by_what_stands_before_it() {
        let disc = Disc { direction: DVec3::Y, angular_radius: 0.05, irradiance: [1.0; 3] };
        let cap =
            |x: f64, radius: f64| Cap { axis: DVec3::new(x.sin(), x.cos(), 0.0), height: 1.0 - radius.cos() };
        assert!(disc.seen(&[cap(0.0, 0.3)]) < 1e-9);
        assert!((disc.seen(&[cap(0.3, 0.3)]) - 0.5).abs() < 0.01);
        assert!((disc.seen(&[cap(0.4, 0.3), cap(1.0, 0.2)]) - 1.0).abs() < 1e-9);
        assert!((disc.seen(&[cap(0.0, 0.025)]) - 0.75).abs() < 1e-9);
        assert_eq!(disc.lit(-DVec3::Y, 1.0), [0.0; 3]);
    }
}
