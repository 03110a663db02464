//! Raw timestamps as seconds.

/// The bits of a timestamp that mean something.
pub(crate) fn mask(valid_bits: u32) -> u64 {
    u64::MAX.checked_shr(64 - valid_bits.min(64)).unwrap_or(0)
}

/// How raw timestamps become seconds.
pub(crate) struct Clock {
    pub mask: u64,
    /// Seconds of one tick.
    pub period: f64,
}

impl Clock {
    /// From one raw value to a later one; the counter may have wrapped once. A step back of up to half the range,
    /// which overlapping queues can show, is no time at all.
    pub(crate) fn seconds(&self, from: u64, to: u64) -> f64 {
        let ticks = to.wrapping_sub(from) & self.mask;
        if ticks > self.mask / 2 { 0.0 } else { ticks as f64 * self.period }
    }
}

/// Value below which the share `at` (0 to 1) of the values lies, linear between neighbours; `None` of none.
pub(crate) fn quantile(values: impl Iterator<Item = f64>, at: f64) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let position = at * sorted.len().checked_sub(1)? as f64;
    let [below, above] = [position.floor(), position.ceil()].map(|index| sorted[index as usize]);
    Some(below + (above - below) * position.fract())
}

pub(crate) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    quantile(values, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_of_even_and_odd_counts() {
        assert_eq!(median([3.0, 1.0, 2.0].into_iter()), Some(2.0));
        assert_eq!(median([4.0, 1.0, 2.0, 3.0].into_iter()), Some(2.5));
        assert_eq!(median([].into_iter()), None);
        assert_eq!(quantile([0.0, 10.0, 20.0].into_iter(), 0.05), Some(1.0));
        assert_eq!(quantile([7.0].into_iter(), 0.95), Some(7.0));
    }
}
