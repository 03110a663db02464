//! GGX seen through a lobe of normals: `1 / (1 + y)^2` blurred by a Gaussian, which has no closed form.
//!
//! `1 / (1 + y)^2 = Int u e^(-u) e^(-u y) du` is a blend of Gaussians of all widths, of which a blur makes
//! `Int u e^(-u) w e^(-u w y) du`, `w = 1 / (1 + u blur)`. The square of one over a quadratic follows it from no blur, where
//! it is exact, to a Gaussian; its coefficients are polynomials, fitted to the integrals over lobes of concentrations 1 to
//! 3000 of GGX with alpha from 0.03 to 0.7. `shaders/glsl/normals/microfacet.glsl` has the same numbers.

/// `sharp height / (1 + slope z + bend z^2)^2`, with `z = sharp y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blurred {
    /// `1 / (1 + blur)`, 0 to 1; the blur is twice the variance across of what blurs, in units of y.
    pub sharp: f64,
    /// On the axis.
    pub height: f64,
    /// How fast it falls there.
    pub slope: f64,
    /// How much faster it falls farther out.
    pub bend: f64,
}

impl Blurred {
    /// By so much.
    #[must_use]
    pub fn of(sharp: f64) -> Self {
        let blur = 1.0 - sharp;
        let rise = 1.66876 + sharp * (-4.13404 + sharp * (6.26377 - 3.24422 * sharp));
        Self {
            sharp,
            height: 1.0 - blur * sharp * rise,
            slope: 1.0 - blur * (0.54523 + 0.84634 * sharp),
            bend: 0.18006 * blur,
        }
    }

    /// The value at y, and the part of the Gaussian's own offset that is left to the mean of its product with what it
    /// blurs, 0 to 1: where the logarithm of the value grows.
    #[must_use]
    pub fn at(&self, y: f64) -> (f64, f64) {
        let z = self.sharp * y;
        let fall = 1.0 / (1.0 + z * (self.slope + self.bend * z));
        let own = 1.0 - 2.0 * (1.0 - self.sharp) * fall * (self.slope + 2.0 * self.bend * z);
        (self.sharp * self.height * fall * fall, own.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral and the part left, by the trapezoidal rule in ln u.
    fn quadrature(blur: f64, y: f64) -> (f64, f64) {
        let (mut sum, mut moved) = (0.0, 0.0);
        for i in 0..2000 {
            let u = (-14.0 + 18.0 * f64::from(i) / 2000.0_f64).exp();
            let w = 1.0 / (1.0 + u * blur);
            let value = u * u * (-u - u * w * y).exp() * w * 18.0 / 2000.0;
            sum += value;
            moved += value * u * w;
        }
        (sum, 1.0 - blur * moved / sum)
    }

    #[test]
    fn a_blurred_ggx_is_the_integral() {
        let (mut worst, mut farthest): (f64, f64) = (0.0, 0.0);
        for blur in [0.0, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0, 1e5] {
            let blurred = Blurred::of(1.0 / (1.0 + blur));
            let peak = quadrature(blur, 0.0).0;
            for i in 0..=40 {
                let y = 0.15 * f64::from(i) * (1.0 + blur);
                let (value, own) = blurred.at(y);
                let (truth, left) = quadrature(blur, y);
                let error = (value - truth).abs() / peak;
                println!("blur {blur}, y {y:.2}: {value:.4e} of {truth:.4e}, left {own:.3} of {left:.3}");
                worst = worst.max(error);
                // Where something is reflected.
                farthest = farthest.max((own - left).abs() * truth / peak);
                assert!(error < 0.04, "blur {blur}, y {y}: {value} is not {truth}");
            }
        }
        println!("value within {worst:.3} of the peak, part left within {farthest:.3}");
        assert!(worst < 0.04 && farthest < 0.1, "{worst} {farthest}");
    }
}
