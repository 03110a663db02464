//! What changes from frame to frame without a new plan: rotations, and whether the environment is projected.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DQuat;

use crate::RelightError;
use crate::rotation::object_space;

/// A poisoned lock means a panic elsewhere while the data was whole: go on with it.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The rotations of a prepared frame. A plan that is recorded again reads what was set last.
#[derive(Clone, Debug)]
pub struct Rotations {
    /// From the light to the object space of each instance, x, y, z, w, unit length.
    quaternions: Arc<Mutex<Vec<[f32; 4]>>>,
}

impl Rotations {
    pub(crate) fn new(light: DQuat, instances: &[DQuat]) -> Result<Self, RelightError> {
        Ok(Self { quaternions: Arc::new(Mutex::new(quaternions(light, instances)?)) })
    }

    /// One fixed rotation.
    pub(crate) fn fixed(rotation: DQuat) -> Self {
        Self { quaternions: Arc::new(Mutex::new(vec![rotation.as_quat().to_array()])) }
    }

    /// Sets the rotation of the light in the world and that of each instance, in the order of the frame, each of any
    /// length but zero. It counts from the next recording on.
    ///
    /// # Errors
    /// [`RelightError::Math`] for a zero or non-finite quaternion, [`RelightError::Length`] unless there are as many
    /// instances as in the frame; nothing is changed then.
    pub fn set(&self, light: DQuat, instances: &[DQuat]) -> Result<(), RelightError> {
        let turned = quaternions(light, instances)?;
        let mut current = lock(&self.quaternions);
        if turned.len() != current.len() {
            let (expected, actual) = (current.len(), turned.len());
            let name = "the frame".to_owned();
            return Err(RelightError::Length { name, what: "the rotations", expected, actual });
        }
        *current = turned;
        Ok(())
    }

    pub(crate) fn get(&self) -> MutexGuard<'_, Vec<[f32; 4]>> {
        lock(&self.quaternions)
    }
}

fn quaternions(light: DQuat, instances: &[DQuat]) -> Result<Vec<[f32; 4]>, RelightError> {
    instances.iter().map(|instance| Ok(object_space(light, *instance)?.as_quat().to_array())).collect()
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
