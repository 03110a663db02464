//! egui in the window: input to it, and what it makes of a frame to the painter.

use std::collections::BTreeMap;

use airglow_gpu::ash::vk;
use egui::{Context, Response, ViewportId};
use egui_winit::State;
use winit::event::WindowEvent;
use winit::window::Window;

use super::paint::Painter;
use crate::failure::Outcome;
use crate::host::device::Device;

/// The panel of a window.
pub struct Interface {
    context: Context,
    input: State,
    painter: Painter,
}

/// Where parts of the panel are in the window, pixels: left, top, right and bottom of each by name.
pub type Places = BTreeMap<String, [f32; 4]>;

/// Notes where a part of the panel is.
pub fn note(places: &mut Places, name: &str, response: &Response) {
    let (rect, scale) = (response.rect, response.ctx.pixels_per_point());
    let pixels = [rect.left(), rect.top(), rect.right(), rect.bottom()].map(|points| points * scale);
    places.insert(name.to_owned(), pixels);
}

impl Interface {
    /// For a window whose images have that format.
    pub fn new(device: &Device<'_>, window: &Window, format: vk::Format) -> Outcome<Self> {
        let context = Context::default();
        context.set_visuals(super::style::visuals());
        let most = device.context().limits().max_image_dimension2_d as usize;
        let scale = window.scale_factor() as f32;
        let input = State::new(context.clone(), ViewportId::ROOT, window, Some(scale), None, Some(most));
        Ok(Self { context, input, painter: Painter::new(device, format)? })
    }

    /// What draws it.
    pub fn painter(&self) -> &Painter {
        &self.painter
    }

    /// Takes an event; true where it is meant for the panel alone.
    pub fn takes(&mut self, window: &Window, event: &WindowEvent) -> bool {
        self.input.on_window_event(window, event).consumed
    }

    /// Has `body` lay out the panel, to be drawn from the next recording on.
    pub fn run(&mut self, window: &Window, body: impl FnMut(&Context)) {
        let output = self.context.run(self.input.take_egui_input(window), body);
        self.input.handle_platform_output(window, output.platform_output);
        let primitives = self.context.tessellate(output.shapes, output.pixels_per_point);
        self.painter.set(primitives, output.textures_delta, output.pixels_per_point);
    }
}
