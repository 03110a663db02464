//! What a frame takes, and the settings that fit.

use crate::order::MIN_ORDER;
use crate::settings::Settings;

impl Settings {
    /// Bytes of the visibility of so many receivers, which the pass makes for the frame on the graph's road.
    #[must_use]
    pub fn visibility_bytes(&self, receivers: u32) -> u64 {
        4 * (self.order * self.order) as u64 * u64::from(receivers)
    }

    /// The settings nearest below these whose visibility of so many receivers fits `bytes`, what a refused plan's budget had
    /// left: a lower order, for the relighting it goes into too. None when not even order 3 fits: split the mesh.
    #[must_use]
    pub fn next_that_fits(&self, receivers: u32, bytes: u64) -> Option<Self> {
        let with = |order| Self { order, ..*self };
        (MIN_ORDER..=self.order).rev().map(with).find(|next| next.visibility_bytes(receivers) <= bytes)
    }
}
