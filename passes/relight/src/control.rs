//! What of the light changes from frame to frame without a new plan: rotations, pre-exposure, a filter, and whether the
//! environment is projected.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_math::World;
use glam::DQuat;

use crate::RelightError;
use crate::order::MAX_ORDER;
use crate::rotation::{LightFrame, OPEN, Orientation, Turn};
use crate::tables::count_wrong;

/// A poisoned lock means a panic elsewhere while the data was whole: go on with it.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The rotations of a prepared frame, its pre-exposure and the filter of its light. A plan that is recorded again reads what was set last.
#[derive(Clone, Debug)]
pub struct Rotations {
    current: Arc<Mutex<Current>>,
}

#[derive(Debug)]
struct Current {
    frame: LightFrame,
    /// From the light to the object space of each instance.
    turns: Vec<Turn>,
    /// Bands of the light.
    order: usize,
}

impl Rotations {
    pub(crate) fn new(
        frame: LightFrame,
        light: DQuat,
        instances: &[Orientation],
        order: usize,
    ) -> Result<Self, RelightError> {
        let turns = turns(&frame, light, instances)?;
        Ok(Self { current: Arc::new(Mutex::new(Current { frame, turns, order })) })
    }

    /// One fixed rotation by a unit quaternion.
    pub(crate) fn fixed(rotation: DQuat) -> Self {
        let frame = LightFrame { orientation: Orientation::IDENTITY, factor: 1.0, filter: OPEN };
        let turns = vec![Turn::new(rotation, false)];
        Self { current: Arc::new(Mutex::new(Current { frame, turns, order: MAX_ORDER })) }
    }

    /// Sets the rotation of the light in the host's world and that of each instance, in the order of the frame, each of
    /// any length but zero: quaternions, or [`Orientation`]s where instances may be mirrored. It counts from the next
    /// recording on.
    ///
    /// # Errors
    /// [`RelightError::Math`] for a zero or non-finite quaternion, [`RelightError::Length`] unless there are as many
    /// instances as in the frame; nothing is changed then.
    pub fn set(&self, light: DQuat, instances: &[impl Into<Orientation> + Copy]) -> Result<(), RelightError> {
        let mut current = lock(&self.current);
        let turned = turns(&current.frame, light, instances)?;
        if turned.len() != current.turns.len() {
            let (expected, actual) = (current.turns.len(), turned.len());
            let name = "the frame".to_owned();
            return Err(RelightError::Length { name, what: "the rotations", expected, actual });
        }
        current.turns = turned;
        Ok(())
    }

    /// Sets what results are multiplied with, above 0, from the next recording on.
    ///
    /// # Errors
    /// [`RelightError::Math`] for any other number; nothing is changed then.
    pub fn set_pre_exposure(&self, factor: f64) -> Result<(), RelightError> {
        World { pre_exposure: factor, ..World::default() }.check()?;
        lock(&self.current).frame.factor = factor;
        Ok(())
    }

    /// Sets what each band of the light is multiplied with, red, green and blue, from the next recording on: the zonal
    /// filter of a convolution about every direction, such as that of a medium between the light and the scene. It takes
    /// the place of a multiplication that is there without it. All 1 at first; the environment's coefficients that other
    /// passes read stay as they come in.
    ///
    /// # Errors
    /// [`RelightError::Length`] unless there is one for each band of the settings' order, [`RelightError::Values`] for
    /// NaN and infinite ones; nothing is changed then.
    pub fn set_filter(&self, factors: &[[f64; 3]]) -> Result<(), RelightError> {
        let mut current = lock(&self.current);
        let name = "the zonal filter".to_owned();
        if factors.len() != current.order {
            let (expected, actual) = (current.order, factors.len());
            return Err(RelightError::Length { name, what: "the bands", expected, actual });
        }
        if let Some((count, first)) = count_wrong(factors, |band| band.into_iter().any(|c| !c.is_finite())) {
            let (what, problem) = ("bands", "NaN or infinite");
            return Err(RelightError::Values { name, what, problem, count, first });
        }
        current.frame.filter[..factors.len()].copy_from_slice(factors);
        Ok(())
    }

    /// Reads the turns from the light to the object space of each instance, and what the frame does to the light.
    pub(crate) fn with<T>(&self, read: impl FnOnce(&[Turn], &LightFrame) -> T) -> T {
        let current = lock(&self.current);
        read(&current.turns, &current.frame)
    }
}

fn turns(
    frame: &LightFrame,
    light: DQuat,
    instances: &[impl Into<Orientation> + Copy],
) -> Result<Vec<Turn>, RelightError> {
    instances.iter().map(|instance| frame.turn(light, (*instance).into())).collect()
}

/// Which revision of the environment was projected last.
#[derive(Clone, Debug, Default)]
pub(crate) struct Projected(Arc<Mutex<Option<u64>>>);

impl Projected {
    pub(crate) fn holds(&self, revision: u64) -> bool {
        *lock(&self.0) == Some(revision)
    }

    pub(crate) fn set(&self, revision: u64) {
        *lock(&self.0) = Some(revision);
    }

    pub(crate) fn forget(&self) {
        *lock(&self.0) = None;
    }
}

/// A stage that does its work once for a revision: when its plan is recorded again it records nothing.
#[derive(Clone, Debug)]
pub(crate) struct Once {
    pub projected: Projected,
    pub revision: u64,
    /// Whether this stage completes the projection.
    pub last: bool,
}
