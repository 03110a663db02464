//! The view of a plan that is recorded again.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_graph::LeftOut;

use crate::FogError;
use crate::frame::{Counts, View};
use crate::pack::{FrameConstants, Packed, pack};
use crate::settings::Settings;

/// The view of a declared frame, to be changed before its plan is recorded again. Clones are the same one.
#[derive(Clone, Debug)]
pub struct Control {
    settings: Settings,
    size: [u32; 2],
    packed: Arc<Mutex<Packed>>,
}

impl Control {
    pub(crate) fn new(settings: Settings, size: [u32; 2], view: &View) -> Result<Self, FogError> {
        let packed = Arc::new(Mutex::new(pack(&settings, view, size)?));
        Ok(Self { settings, size, packed })
    }

    /// Sets the view that counts from the next recording on. On an error the old one stays.
    ///
    /// # Errors
    /// [`FogError::Range`] and [`FogError::TooManyLights`] for what no frame takes; [`FogError::Plan`] for a medium with
    /// no extinction, whose plan is another.
    pub fn set(&self, view: &View) -> Result<Counts, FogError> {
        if view.medium.is_clear() {
            return Err(FogError::Plan { what: "the medium is clear" });
        }
        let packed = pack(&self.settings, view, self.size)?;
        let counts = packed.counts;
        *self.lock() = packed;
        Ok(counts)
    }

    /// Which lights of the view set last the shader is given.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.lock().counts
    }

    /// The record of the lights that the view set last does without; `None` without such. No part of a plan, which stays
    /// while lights come and go.
    #[must_use]
    pub fn left_out(&self) -> Option<LeftOut> {
        let Counts { evaluated, left_out } = self.counts();
        (left_out > 0).then(|| LeftOut {
            what: format!("fog of {left_out} of {} lights", evaluated + left_out),
            why: format!(
                "no pixel can get {} W/sr/m2 of airlight, pre-exposed, from them",
                self.settings.bound
            ),
            bytes: 0,
            time: None,
            would_return: "a stronger or nearer light, or a smaller Settings::bound".to_owned(),
        })
    }

    pub(crate) fn constants(&self) -> FrameConstants {
        self.lock().constants
    }

    fn lock(&self) -> MutexGuard<'_, Packed> {
        self.packed.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
