//! The pass on a device.

#![expect(clippy::panic, clippy::unwrap_used, reason = "helpers fail the test they are called from")]

mod airlight;
mod background;
mod bad_pixels;
mod images;
mod maps;
mod motion;
mod rivals;
mod stability;
mod surface;
mod tiles;
mod visibility;
mod world;
