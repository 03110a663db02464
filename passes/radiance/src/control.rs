//! What changes from frame to frame without a new plan: emitters and distant light.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::RadianceError;
use crate::gpu::{EmitterSphere, EmitterTriangle, Surfaces};
use crate::lights::Lights;

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
    /// What is more of triangles than corners and one radiance.
    pub surfaces: Surfaces,
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
    /// [`RadianceError::Value`] for an emitter, picture or distant light that is not finite; [`RadianceError::Length`] unless
    /// there is no distant light or order squared of it, and for pictures whose size is another.
    pub fn set(&self, lights: &Lights<'_>) -> Result<(), RadianceError> {
        lights.check()?;
        lights.check_distant(self.coefficients)?;
        let mut distant = vec![[0.0; 4]; self.coefficients];
        distant.iter_mut().zip(lights.distant).for_each(|(to, [r, g, b])| *to = [*r, *g, *b, 0.0]);
        // A buffer cannot be empty: one of no size and no light stands for none.
        let mut triangles: Vec<_> = lights.triangles().iter().map(EmitterTriangle::from).collect();
        let mut spheres: Vec<_> = lights.spheres.iter().map(EmitterSphere::from).collect();
        let (flat_count, sphere_count) = (lights.emitters.len() as u32, spheres.len() as u32);
        or_nothing(&mut triangles);
        or_nothing(&mut spheres);
        let surfaces = Surfaces::new(lights)?;
        *self.lock() = Packed { triangles, flat_count, spheres, sphere_count, distant, surfaces };
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
