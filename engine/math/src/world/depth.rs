//! What a depth value of the host's stands for.

use crate::MathError;

/// How a camera's depth buffer, 0 to 1 as Vulkan stores it, is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    /// Whether 1 is near and 0 is far.
    pub reversed: bool,
    /// View distance of the near plane, in the host's units: above 0.
    pub near: f64,
    /// View distance of the far plane, in the host's units, beyond the near plane; `None` for an infinite one, which
    /// only a perspective has.
    pub far: Option<f64>,
    /// Whether the projection is orthographic, with depth linear in view distance.
    pub orthographic: bool,
}

impl Depth {
    /// What turns a depth value into a view distance:
    /// `distance = (c[0] + c[1] depth) / (c[2] + c[3] depth)`, along the view's axis and not along the ray,
    /// `scale` times that in the host's units.
    #[must_use]
    pub fn coefficients(&self, scale: f64) -> [f64; 4] {
        let ends = |near: f64, far: f64| match self.reversed {
            true => [far, near - far],
            false => [near, far - near],
        };
        if self.orthographic {
            let [constant, slope] = ends(self.near, self.far.unwrap_or(f64::INFINITY));
            return [scale * constant, scale * slope, 1.0, 0.0];
        }
        // A perspective is linear in one over the distance.
        let [constant, slope] = ends(1.0 / self.near, self.far.map_or(0.0, |far| 1.0 / far));
        [scale, 0.0, constant, slope]
    }

    /// The view distance of a depth value, in the host's units; infinite at the far end of an infinite perspective.
    #[must_use]
    pub fn view_distance(&self, depth: f64) -> f64 {
        let [a, b, c, d] = self.coefficients(1.0);
        (a + b * depth) / (c + d * depth)
    }

    /// The depth value of a view distance in the host's units.
    #[must_use]
    pub fn value(&self, view_distance: f64) -> f64 {
        let [a, b, c, d] = self.coefficients(1.0);
        (a - c * view_distance) / (d * view_distance - b)
    }

    /// The value of what is farthest, which a host clears its buffer to.
    #[must_use]
    pub fn farthest(&self) -> f64 {
        if self.reversed { 0.0 } else { 1.0 }
    }

    /// Refuses planes that make no projection.
    ///
    /// # Errors
    /// [`MathError::Range`].
    pub fn check(&self) -> Result<(), MathError> {
        let refuse = |what, value, range| Err(MathError::Range { what, value, range });
        if !self.near.is_finite() || self.near <= 0.0 {
            return refuse("the near plane", self.near, "a finite distance above 0");
        }
        match self.far {
            Some(far) if !far.is_finite() || far <= self.near => {
                refuse("the far plane", far, "a finite distance beyond the near plane, or none")
            }
            None if self.orthographic => {
                refuse("the far plane of an orthographic view", f64::INFINITY, "a finite distance")
            }
            _ => Ok(()),
        }
    }
}

impl Default for Depth {
    fn default() -> Self {
        Self { reversed: false, near: 0.1, far: Some(1000.0), orthographic: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEAR: f64 = 0.25;
    const FAR: f64 = 40.0;

    type Value = fn(f64) -> f64;

    /// Each kind with the depth of its projection matrix, written out.
    fn closed_forms() -> [(Depth, Value); 6] {
        let depth = |reversed, far, orthographic| Depth { reversed, near: NEAR, far, orthographic };
        [
            (depth(false, Some(FAR), false), |z| FAR * (z - NEAR) / (z * (FAR - NEAR))),
            (depth(true, Some(FAR), false), |z| NEAR * (FAR - z) / (z * (FAR - NEAR))),
            (depth(false, None, false), |z| 1.0 - NEAR / z),
            (depth(true, None, false), |z| NEAR / z),
            (depth(false, Some(FAR), true), |z| (z - NEAR) / (FAR - NEAR)),
            (depth(true, Some(FAR), true), |z| (FAR - z) / (FAR - NEAR)),
        ]
    }

    #[test]
    fn distances_are_those_of_the_projection_matrices() {
        for (depth, value) in closed_forms() {
            depth.check().unwrap();
            for z in [NEAR, 0.3, 1.0, 7.5, 39.0, FAR] {
                let (found, expected) = (depth.value(z), value(z));
                assert!((found - expected).abs() < 1e-14, "{depth:?} at {z}: {found} {expected}");
                let found = depth.view_distance(expected);
                assert!((found - z).abs() < 1e-11 * z, "{depth:?}: {found} instead of {z}");
            }
            let farthest = depth.view_distance(depth.farthest());
            match depth.far {
                Some(far) => assert!((farthest - far).abs() < 1e-9, "{depth:?}: {farthest}"),
                None => assert_eq!(farthest, f64::INFINITY, "{depth:?}"),
            }
            let [a, b, c, d] = depth.coefficients(0.01);
            let (scaled, whole) = ((a + b * 0.3) / (c + d * 0.3), depth.view_distance(0.3));
            assert!((scaled - 0.01 * whole).abs() < 1e-14 * whole, "{depth:?}: {scaled} {whole}");
        }
    }

    #[test]
    fn planes_that_make_no_projection_are_refused() {
        let good = Depth::default();
        let bad = [
            Depth { near: 0.0, ..good },
            Depth { near: f64::NAN, ..good },
            Depth { far: Some(0.1), ..good },
            Depth { far: Some(f64::INFINITY), ..good },
            Depth { far: None, orthographic: true, ..good },
        ];
        good.check().unwrap();
        for depth in bad {
            assert!(depth.check().is_err(), "{depth:?}");
        }
    }
}
