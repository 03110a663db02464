//! Mouse and keys, where the panel does not take them.

use glam::Vec2;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};

use super::camera::Rig;
use super::controls::{Action, Controls, Drag, Held};

/// Pixels of a touchpad's scrolling that count as a notch of a wheel.
const PIXELS_A_NOTCH: f32 = 40.0;

/// What is held and where the mouse is.
#[derive(Default)]
pub struct Input {
    /// Keys that fly.
    pub held: Held,
    /// Whether a picture was asked for.
    pub picture: bool,
    /// What the mouse is over, of what can be dragged.
    pub over: Option<usize>,
    /// What of it is dragged.
    pub grabbed: Option<usize>,
    at: Option<[f32; 2]>,
    drag: Option<Drag>,
}

impl Input {
    /// Takes an event in a window of so many pixels' height; returns what a key asks for.
    pub fn take(
        &mut self,
        event: &WindowEvent,
        controls: &mut Controls,
        rig: &mut Rig,
        height: f32,
    ) -> Option<Action> {
        match event {
            WindowEvent::KeyboardInput { event, is_synthetic, .. } => {
                let pressed = event.state == ElementState::Pressed;
                self.held.key(event.physical_key, pressed);
                // A key that was down when the window got the focus is told of, and its press may still be to come.
                let fresh = pressed && !is_synthetic;
                return Action::of(&event.logical_key)
                    .filter(|action| fresh && (!event.repeat || action.repeats()));
            }
            WindowEvent::Focused(false) => self.held = Held::default(),
            WindowEvent::MouseInput { state, button, .. } => {
                let left = *button == MouseButton::Left;
                self.grabbed = self.over.filter(|_| left && *state == ElementState::Pressed);
                self.drag = match (state, button) {
                    _ if self.grabbed.is_some() => None,
                    (ElementState::Pressed, MouseButton::Left) => Some(Drag::Camera),
                    (ElementState::Pressed, MouseButton::Middle) => Some(Drag::Pan),
                    (ElementState::Pressed, MouseButton::Right) => Some(Drag::Light),
                    _ => None,
                };
            }
            WindowEvent::CursorMoved { position, .. } => {
                let at = [position.x as f32, position.y as f32];
                let before = self.at.replace(at);
                if let (Some(drag), Some(before)) = (self.drag, before) {
                    let dragged = [at[0] - before[0], at[1] - before[1]];
                    match drag {
                        Drag::Camera if controls.flies => rig.look(dragged),
                        Drag::Camera => rig.orbit(dragged),
                        Drag::Pan => rig.pan(dragged, height),
                        Drag::Light => controls.drag_light(dragged[0]),
                    }
                }
            }
            WindowEvent::MouseWheel { delta, .. } => rig.zoom(match delta {
                MouseScrollDelta::LineDelta(_, lines) => *lines,
                MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / PIXELS_A_NOTCH,
            }),
            _ => {}
        }
        None
    }

    /// The panel took an event.
    pub fn let_go(&mut self) {
        (self.drag, self.grabbed, self.at) = (None, None, None);
    }

    /// Where the mouse is, pixels.
    pub fn mouse(&self) -> Option<Vec2> {
        self.at.map(Vec2::from)
    }
}
