//! The host that the tests of this room play: one device under validation, one frame at a time.
#![allow(dead_code, reason = "each test file uses its part")]

pub mod draw;
pub mod ellipsoid;
pub mod falling;

use airglow_relight::{Bench, Method, Relight, Settings};
use airglow_tests::device::{Fixture, fixture_with};

/// Runs `test` with a bench on the fixture's device, under validation.
pub fn with_bench(test: impl FnOnce(&Bench<'_>)) {
    let fixture = fixture();
    let context = fixture.context();
    let run: &airglow_relight::Run<'_> = &|record| fixture.device().run(context, |recorder| record(recorder));
    test(&Bench { context, run });
}

/// The fixture's device, with all that this room can require.
pub fn fixture() -> Fixture {
    let settings = Settings { order: 6, method: Method::Fragment, ..Settings::default() };
    fixture_with(&Relight::requirements(&settings))
}

/// Numbers in [-1, 1) from a counter: the top bits of a Weyl sequence through a mixing step.
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn values(&mut self, count: usize) -> Vec<f32> {
        (0..count).map(|_| self.next() as f32).collect()
    }

    pub fn rgb(&mut self, count: usize) -> Vec<[f32; 3]> {
        (0..count).map(|_| [self.next() as f32, self.next() as f32, self.next() as f32]).collect()
    }
}

/// The Euclidean length of values.
pub fn length(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// f32 values as f64.
pub fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().map(|value| f64::from(*value)).collect()
}

/// f32 colours as f64.
pub fn wide_rgb(values: &[[f32; 3]]) -> Vec<[f64; 3]> {
    values.iter().map(|rgb| rgb.map(f64::from)).collect()
}
