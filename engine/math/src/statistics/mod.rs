//! Statistics of errors and of timings.

mod bootstrap;
mod image;
mod norms;
mod quantile;

pub use bootstrap::{Interval, bootstrap_interval, paired_ratio_interval};
pub use image::{ImageError, h1_image};
pub use norms::{l2, relative_l2};
pub use quantile::{mean, median, percentile, percentiles};
