//! The knob: range, default and its reason.

use crate::__Room__Error;

/// Most stops either way: 2^16 takes a colour of 1 to the end of half floats.
pub const MAX_STOPS: f64 = 16.0;

/// What the pass is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Exposure in stops, -[`MAX_STOPS`] to [`MAX_STOPS`]; one stop doubles. Default 0: the colours as they are, and
    /// no pass at all.
    pub stops: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { stops: 0.0 }
    }
}

impl Settings {
    /// What colours are multiplied by on the device: 2^stops, rounded to f32.
    pub fn factor(&self) -> f32 {
        self.stops.exp2() as f32
    }

    /// Refuses what is out of range, NaN too.
    ///
    /// # Errors
    /// [`__Room__Error::Stops`].
    pub fn check(&self) -> Result<(), __Room__Error> {
        let Self { stops } = *self;
        if stops.abs() <= MAX_STOPS { Ok(()) } else { Err(__Room__Error::Stops { stops, most: MAX_STOPS }) }
    }
}
