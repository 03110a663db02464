//! The window of `airglow view`: the frames of `host`, live, and what mouse, keys and a panel change in them.
//!
//! `viewer` draws frame after frame; `surface` holds the window and its swapchain, `stage` the scene in it. `controls` and
//! `wish` are what keys, mouse and panel change: what a frame follows at once, and what passes are made anew for (`knobs`),
//! beside the frames where that takes long (`loading`). `camera` and `grab` are what the mouse moves, `interface` and `paint`
//! egui in the window, `layout`, `panel`, `rooms` and `graph` what it lays out of what it is `told`, `overlay` what it draws over
//! the picture by a `projection`, `times` and `kept` what passes take and took. `reload` watches shaders, `shot` writes pictures of it all.

mod camera;
pub mod controls;
mod grab;
mod graph;
mod input;
mod interface;
mod kept;
mod knobs;
mod layout;
mod loading;
mod overlay;
mod paint;
mod panel;
mod projection;
pub mod reload;
mod rooms;
mod shot;
pub mod stage;
mod style;
mod surface;
mod times;
mod told;
pub mod viewer;
mod wish;

pub use interface::Places;

use std::ffi::CStr;

use winit::event_loop::EventLoop;
use winit::raw_window_handle::HasDisplayHandle;

use crate::failure::{Failure, Outcome};

/// What to do where no window can be had.
const MEND: &str =
    "start it within a desktop session, or draw to a file: airglow render SCENE -o picture.png";

/// The connection to the display, before anything else is worked on.
pub fn event_loop() -> Outcome<EventLoop<()>> {
    check_keyboard_library()?;
    EventLoop::new().map_err(|error| {
        // winit's message begins with the place in its own source.
        let text = error.to_string();
        let why = text.split_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
        no_window(why.map_or(&*text, |(_, why)| why.trim_end_matches('.')))
    })
}

/// Instance extensions that windows on this display need.
pub fn instance_extensions(event_loop: &EventLoop<()>) -> Outcome<Vec<&'static CStr>> {
    let display = event_loop.display_handle().map_err(no_window)?;
    airglow_gpu::surface::instance_extensions(display.as_raw()).map_err(no_window)
}

fn no_window(why: impl std::fmt::Display) -> Failure {
    Failure::work(format!("no window can be opened: {why}; {MEND}"))
}

/// winit panics where X11's keyboard library is missing.
#[cfg(all(unix, not(target_os = "macos")))]
fn check_keyboard_library() -> Outcome {
    let x11 = std::env::var_os("DISPLAY").is_some_and(|display| !display.is_empty());
    if x11 && xkbcommon_dl::x11::xkbcommon_x11_option().is_none() {
        return Err(no_window("libxkbcommon-x11.so.0 is missing (Debian: install libxkbcommon-x11-0)"));
    }
    Ok(())
}

#[cfg(not(all(unix, not(target_os = "macos"))))]
fn check_keyboard_library() -> Outcome {
    Ok(())
}
