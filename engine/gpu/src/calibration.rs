//! The device's clock and the CPU's on one time line.
//!
//! The device is asked for its clock between two readings of the CPU's, so that the uncertainty is known and no clock of
//! an operating system has to be named.

use crate::clock::mask;
use crate::context::Context;
use crate::error::GpuError;
use ash::vk;
use std::time::{Duration, Instant};

/// How often the clocks are read for one calibration; the reading with the least uncertainty is kept.
const READINGS: usize = 8;

/// One moment on both clocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// The device's clock, in ticks of `timestampPeriod` nanoseconds.
    pub ticks: u64,
    /// The CPU's clock.
    pub at: Instant,
    /// How far the two may be apart, either way.
    pub uncertainty: Duration,
}

impl Context {
    /// Reads both clocks at once; `None` where the host enabled neither of the extensions `calibrated_timestamps`.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] if the device refuses.
    pub fn calibrate(&self) -> Result<Option<Calibration>, GpuError> {
        let Some(read) = self.shared.functions.calibrated_timestamps else { return Ok(None) };
        let mut best: Option<Calibration> = None;
        for _ in 0..READINGS {
            let info = vk::CalibratedTimestampInfoKHR::default().time_domain(vk::TimeDomainKHR::DEVICE);
            let (mut ticks, mut deviation) = (0, 0);
            let before = Instant::now();
            // SAFETY: a live device whose extension is enabled; every device has the domain `DEVICE`; room for one.
            let result = unsafe { read(self.device().handle(), 1, &info, &mut ticks, &mut deviation) };
            let taken = before.elapsed();
            if result != vk::Result::SUCCESS {
                return Err(GpuError::Vulkan { call: "vkGetCalibratedTimestamps", result });
            }
            let uncertainty = taken / 2;
            if best.is_none_or(|best| uncertainty < best.uncertainty) {
                let ticks = ticks & mask(self.shared.facts.timestamp_valid_bits);
                best = Some(Calibration { ticks, at: before + uncertainty, uncertainty });
            }
        }
        Ok(best)
    }

    /// Seconds from one raw value of the device's clock to another, negative if the second is earlier; the counter may
    /// have wrapped between them.
    pub fn device_seconds(&self, from: u64, to: u64) -> f64 {
        let mask = mask(self.shared.facts.timestamp_valid_bits);
        let (forward, back) = (to.wrapping_sub(from) & mask, from.wrapping_sub(to) & mask);
        let ticks = if forward <= back { forward as f64 } else { -(back as f64) };
        ticks * f64::from(self.limits().timestamp_period) * 1e-9
    }
}
