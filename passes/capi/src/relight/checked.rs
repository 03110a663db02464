//! What the checks of the conformance kit make of the pass, and fill it with.

use airglow_conformance::Refusal;

use crate::relight::settings::AirglowRelightSettings;
use crate::relight::{AirglowRelight, airglow_relight_drop, airglow_relight_new};
use crate::through_c::{ThroughC, attempt};

/// Numbers in [0, 1): the fractional parts of multiples of the golden ratio.
pub(crate) fn numbers(count: usize, first: f64) -> Vec<f32> {
    (0..count).map(|i| (first + i as f64 * 0.618_033_988_749_894_9).fract() as f32).collect()
}

/// The pass by the exported functions, in a context that is there.
pub(crate) fn made(
    through_c: &mut ThroughC,
    settings: &AirglowRelightSettings,
) -> Result<*mut AirglowRelight, Refusal> {
    let context = through_c.context;
    through_c.hold(airglow_relight_drop, |relight| attempt!(airglow_relight_new, context, settings, relight))
}
