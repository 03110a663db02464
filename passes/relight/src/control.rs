//! What changes from frame to frame without a new plan: rotations, and whether the environment is projected.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DQuat;

use crate::RelightError;
use crate::rotation::{Orientation, Turn};

/// A poisoned lock means a panic elsewhere while the data was whole: go on with it.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The rotations of a prepared frame. A plan that is recorded again reads what was set last.
#[derive(Clone, Debug)]
pub struct Rotations {
    /// From the light to the object space of each instance.
    turns: Arc<Mutex<Vec<Turn>>>,
}

impl Rotations {
    pub(crate) fn new(light: DQuat, instances: &[Orientation]) -> Result<Self, RelightError> {
        Ok(Self { turns: Arc::new(Mutex::new(turns(light, instances)?)) })
    }

    /// One fixed rotation by a unit quaternion.
    pub(crate) fn fixed(rotation: DQuat) -> Self {
        Self { turns: Arc::new(Mutex::new(vec![Turn::rotation(rotation)])) }
    }

    /// Sets the rotation of the light in the world and that of each instance, in the order of the frame, each of any
    /// length but zero: quaternions, or [`Orientation`]s where instances may be mirrored. It counts from the next recording on.
    ///
    /// # Errors
    /// [`RelightError::Math`] for a zero or non-finite quaternion, [`RelightError::Length`] unless there are as many
    /// instances as in the frame; nothing is changed then.
    pub fn set(&self, light: DQuat, instances: &[impl Into<Orientation> + Copy]) -> Result<(), RelightError> {
        let turned = turns(light, instances)?;
        let mut current = lock(&self.turns);
        if turned.len() != current.len() {
            let (expected, actual) = (current.len(), turned.len());
            let name = "the frame".to_owned();
            return Err(RelightError::Length { name, what: "the rotations", expected, actual });
        }
        *current = turned;
        Ok(())
    }

    pub(crate) fn get(&self) -> MutexGuard<'_, Vec<Turn>> {
        lock(&self.turns)
    }
}

fn turns(light: DQuat, instances: &[impl Into<Orientation> + Copy]) -> Result<Vec<Turn>, RelightError> {
    instances.iter().map(|instance| Turn::to_object_space(light, (*instance).into())).collect()
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
