//! What changes from frame to frame without a new plan: emitters and distant light.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::gpu::{EmitterSphere, EmitterTriangle};
use crate::{RadianceError, Sphere, Triangle, check, check_spheres};

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
}

impl Lights<'_> {
    /// All emitters as triangles, those that stand for spheres last.
    #[must_use]
    pub fn triangles(&self) -> Vec<Triangle> {
        let spheres = self.spheres.iter().flat_map(Sphere::triangles);
        self.emitters.iter().copied().chain(spheres).collect()
    }

    /// Whether anything near gives light.
    pub(crate) fn emit(&self) -> bool {
        self.emitters.iter().any(Triangle::emits)
            || self.spheres.iter().any(|sphere| sphere.radiance.max_element() > 0.0)
    }
}

/// The lights of a declared frame, to be changed before its plan is recorded again. Clones are the same one.
#[derive(Clone, Debug)]
pub struct Control {
    coefficients: usize,
    packed: Arc<Mutex<Packed>>,
}

/// Lights as kernels read them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Packed {
    /// Those that stand for the spheres last.
    pub triangles: Vec<EmitterTriangle>,
    /// Triangles that are no part of a sphere.
    pub flat_count: u32,
    pub spheres: Vec<EmitterSphere>,
    pub sphere_count: u32,
    pub distant: Vec<[f32; 4]>,
}

impl Control {
    pub(crate) fn new(coefficients: usize, lights: &Lights<'_>) -> Result<Self, RadianceError> {
        let control = Self { coefficients, packed: Arc::default() };
        control.set(lights)?;
        Ok(control)
    }

    /// Sets the lights that count from the next recording on. On an error the old ones stay. While emitters
    /// stay, no sample is taken again.
    ///
    /// # Errors
    /// [`RadianceError::Value`] for an emitter or distant light that is not finite; [`RadianceError::Length`] unless there
    /// is no distant light or order squared of it.
    pub fn set(&self, lights: &Lights<'_>) -> Result<(), RadianceError> {
        check(lights.emitters)?;
        check_spheres(lights.spheres)?;
        let (expected, actual) = (self.coefficients, lights.distant.len());
        if actual != 0 && actual != expected {
            return Err(RadianceError::Length { what: "the distant light", expected, actual });
        }
        let bad = |light: &[f32; 3]| light.iter().any(|x| !x.is_finite());
        if let Some(index) = lights.distant.iter().position(bad) {
            let value = format!("{:?}", lights.distant[index]);
            return Err(RadianceError::Value { what: "coefficient of the distant light", index, value });
        }
        let mut distant = vec![[0.0; 4]; self.coefficients];
        distant.iter_mut().zip(lights.distant).for_each(|(to, [r, g, b])| *to = [*r, *g, *b, 0.0]);
        // A buffer cannot be empty: one of no size and no light stands for none.
        let mut triangles: Vec<_> = lights.triangles().iter().map(EmitterTriangle::from).collect();
        let mut spheres: Vec<_> = lights.spheres.iter().map(EmitterSphere::from).collect();
        let (flat_count, sphere_count) = (lights.emitters.len() as u32, spheres.len() as u32);
        or_nothing(&mut triangles);
        or_nothing(&mut spheres);
        *self.lock() = Packed { triangles, flat_count, spheres, sphere_count, distant };
        Ok(())
    }

    pub(crate) fn lock(&self) -> MutexGuard<'_, Packed> {
        self.packed.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn or_nothing<T: Default>(list: &mut Vec<T>) {
    if list.is_empty() {
        list.push(T::default());
    }
}
