//! What a receiver is lit by.

use crate::{Picture, RadianceError, Shown, Sphere, Triangle, check, check_spheres};

/// What a receiver is lit by.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lights<'a> {
    /// Triangles that emit or block, in the space of the receiver's positions.
    pub emitters: &'a [Triangle],
    /// Spheres that emit or block: in closed form where nothing overlaps, else as [`Sphere::triangles`].
    pub spheres: &'a [Sphere],
    /// Light from far away about the axes of that space, SH RGB, order squared of them, which every vertex gets as well:
    /// its transfer knows what shadows it. Empty for none.
    pub distant: &'a [[f32; 3]],
    /// Triangles that emit what they show of [`pictures`](Self::pictures), which rays read where they meet them.
    pub shown: &'a [Shown],
    /// What they show.
    pub pictures: &'a [Picture<'a>],
    /// By how much the medium between dims the light of emitters, 1/m: a factor exp(-extinction distance).
    pub extinction: [f32; 3],
}

impl Lights<'_> {
    /// Nothing.
    pub const NONE: Self =
        Self { emitters: &[], spheres: &[], distant: &[], shown: &[], pictures: &[], extinction: [0.0; 3] };

    /// All emitters as triangles: those of uniform radiance, then the means of those that show pictures, then those that stand
    /// for spheres. A picture that is not there is left out.
    #[must_use]
    pub fn triangles(&self) -> Vec<Triangle> {
        let shown = self.shown.iter().filter_map(|shown| Some(shown.mean(self.pictures.get(shown.picture)?)));
        let spheres = self.spheres.iter().flat_map(Sphere::triangles);
        self.emitters.iter().copied().chain(shown).chain(spheres).collect()
    }

    /// Refuses what [`Control::set`](crate::Control::set) refuses of emitters.
    pub(crate) fn check(&self) -> Result<(), RadianceError> {
        check(self.emitters)?;
        check_spheres(self.spheres)?;
        self.pictures.iter().try_for_each(Picture::check)?;
        Shown::check(self.shown, self.pictures.len())?;
        match self.extinction.iter().all(|x| x.is_finite() && *x >= 0.0) {
            true => Ok(()),
            false => {
                let value = format!("{:?}", self.extinction);
                Err(RadianceError::setting("the medium's extinction", value, "finite numbers, zero or more"))
            }
        }
    }

    pub(crate) fn check_distant(&self, coefficients: usize) -> Result<(), RadianceError> {
        let (expected, actual) = (coefficients, self.distant.len());
        if actual != 0 && actual != expected {
            return Err(RadianceError::Length { what: "the distant light", expected, actual });
        }
        let bad = |light: &[f32; 3]| light.iter().any(|x| !x.is_finite());
        if let Some(index) = self.distant.iter().position(bad) {
            let value = format!("{:?}", self.distant[index]);
            return Err(RadianceError::Value { what: "coefficient of the distant light", index, value });
        }
        Ok(())
    }

    /// Whether anything near gives light.
    pub(crate) fn emit(&self) -> bool {
        self.emitters.iter().any(Triangle::emits)
            || self.spheres.iter().any(|sphere| sphere.radiance.max_element() > 0.0)
            || self.shown.iter().any(|shown| {
                self.pictures
                    .get(shown.picture)
                    .is_some_and(|picture| picture.texels.iter().flatten().any(|x| *x > 0.0))
            })
    }
}
