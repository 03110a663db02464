//! A window and the swapchain on it, in one hand, so that they go in the right order.

use airglow_gpu::GpuError;
use airglow_gpu::surface::{Surface, SurfaceFrame};
use airglow_graph::ImageDesc;
use winit::dpi::PhysicalSize;
use winit::event_loop::ActiveEventLoop;
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

use super::no_window;
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;

/// A window that shows pictures.
pub struct ShownWindow<'d> {
    device: &'d Device<'d>,
    /// `None` after it was lost, until [`ShownWindow::resize`] makes another. Dropped before the window.
    surface: Option<Surface<'d>>,
    window: Window,
}

impl<'d> ShownWindow<'d> {
    /// Opens a window of `size` pixels.
    pub fn open(
        device: &'d Device<'d>,
        event_loop: &ActiveEventLoop,
        title: &str,
        [width, height]: [u32; 2],
    ) -> Outcome<Self> {
        let attributes =
            Window::default_attributes().with_title(title).with_inner_size(PhysicalSize::new(width, height));
        let window = event_loop.create_window(attributes).map_err(no_window)?;
        let mut this = Self { device, surface: None, window };
        this.resize()?;
        Ok(this)
    }

    /// The window.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// What the images to draw to are; `None` while the window has no pixels.
    pub fn desc(&self) -> Option<ImageDesc> {
        self.surface.as_ref()?.desc().copied()
    }

    /// Fits the swapchain to the window.
    pub fn resize(&mut self) -> Outcome {
        let size = self.window.inner_size();
        let extent = [size.width, size.height];
        let resized = match &mut self.surface {
            Some(surface) => surface.resize(self.device.context(), extent),
            None => {
                let display = self.window.display_handle().map_err(no_window)?.as_raw();
                let window = self.window.window_handle().map_err(no_window)?.as_raw();
                // SAFETY: the handles are those of the window held here, which outlives the surface held here; what
                // has a window was opened with its display's extensions.
                let surface = unsafe { self.device.surface(display, window, extent) };
                surface.map(|surface| self.surface = Some(surface))
            }
        };
        self.unless_lost(resized).map(|_| ())
    }

    /// An image to draw the next frame to; `None` where [`ShownWindow::resize`] must come first.
    pub fn acquire(&mut self) -> Outcome<Option<SurfaceFrame>> {
        let acquired = self.surface.as_mut().map_or(Ok(None), Surface::acquire);
        Ok(self.unless_lost(acquired)?.flatten())
    }

    /// Shows a frame; false where [`ShownWindow::resize`] must come before the next.
    pub fn present(&mut self, frame: SurfaceFrame) -> Outcome<bool> {
        let presented = self.surface.as_mut().map_or(Ok(false), |surface| surface.present(frame));
        Ok(self.unless_lost(presented)?.unwrap_or(false))
    }

    /// Drops a lost surface, so that the next resize makes another.
    fn unless_lost<T>(&mut self, result: Result<T, GpuError>) -> Outcome<Option<T>> {
        match result {
            Ok(value) => Ok(Some(value)),
            Err(error) if error.is_surface_lost() => {
                self.surface = None;
                Ok(None)
            }
            Err(error) => Err(Failure::work(error)),
        }
    }
}
