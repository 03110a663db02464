//! Frame after frame in a window: the same frame that `airglow render` draws, from one plan until something changes
//! that is compiled into it.

use std::time::{Duration, Instant};

use airglow_gpu::open::FrameLoop;
use airglow_gpu::surface::SurfaceFrame;
use airglow_gpu::{Timing, TimingSummary};
use airglow_graph::ImageDesc;
use airglow_scene::Camera;
use glam::Vec3;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::WindowId;

use super::controls::{Action, Controls, Drag};
use super::surface::ShownWindow;
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::host::renderer::{Air, Compiled, Renderer, Settings};

/// Frames that the times in the title are medians of.
const TIMED_FRAMES: usize = 60;
/// How often the title is written.
const TITLE_EVERY: Duration = Duration::from_millis(500);
/// Pixels of a touchpad's scrolling that count as a notch of a wheel.
const PIXELS_A_NOTCH: f32 = 40.0;

/// What is shown, and for how long.
pub struct Show {
    /// Begins the window's title.
    pub title: String,
    /// Where the camera starts, and the middle of the scene that it goes around.
    pub camera: Camera,
    /// Metres.
    pub center: Vec3,
    /// The first frame; its size is that of the window at first, its turn and exposure are where input starts.
    pub start: Settings,
    /// Radians that the light turns in a second.
    pub spin: f64,
    /// Ends after so many frames.
    pub frames: Option<u32>,
}

/// What was shown.
pub struct Shown {
    /// Frames.
    pub frames: u32,
    /// From the first to the last of them.
    pub seconds: f64,
    /// Device times of the last of them; `None` with too few.
    pub timing: Option<TimingSummary>,
}

/// Draws to a window and listens to it.
pub struct Viewer<'d> {
    device: &'d Device<'d>,
    renderer: Renderer<'d>,
    show: Show,
    settings: Settings,
    controls: Controls,
    pointer: Pointer,
    frames: FrameLoop<'d>,
    compiled: Option<Compiled>,
    window: Option<ShownWindow<'d>>,
    /// Whether the swapchain must be made again.
    stale: bool,
    /// Whether nothing of the window can be seen.
    hidden: bool,
    shown: u32,
    first: Option<Instant>,
    last: Option<Instant>,
    /// When the title was written, and how many frames had been shown.
    titled: Option<(Instant, u32)>,
    outcome: Outcome,
}

/// The mouse.
#[derive(Default)]
struct Pointer {
    at: Option<[f32; 2]>,
    drag: Option<Drag>,
}

impl<'d> Viewer<'d> {
    /// Shows the renderer's scene; the window opens when the event loop runs.
    pub fn new(device: &'d Device<'d>, renderer: Renderer<'d>, show: Show) -> Outcome<Self> {
        Ok(Self {
            device,
            renderer,
            settings: show.start,
            show,
            controls: Controls::default(),
            pointer: Pointer::default(),
            frames: device.frame_loop()?,
            compiled: None,
            window: None,
            stale: false,
            hidden: false,
            shown: 0,
            first: None,
            last: None,
            titled: None,
            outcome: Ok(()),
        })
    }

    /// What was shown, or why it ended early.
    pub fn finish(mut self) -> Outcome<Shown> {
        std::mem::replace(&mut self.outcome, Ok(()))?;
        self.frames.finish().map_err(Failure::work)?;
        let seconds = self.first.zip(self.last).map_or(0.0, |(first, last)| (last - first).as_secs_f64());
        let timing = self.compiled.as_mut().and_then(|compiled| compiled.timing.as_mut());
        let timing = match timing {
            Some(timing) => {
                timing.collect().map_err(Failure::work)?;
                timing.summary()
            }
            None => None,
        };
        Ok(Shown { frames: self.shown, seconds, timing })
    }

    /// Draws and shows one frame, unless the window has no pixels or changed just now.
    fn draw(&mut self) -> Outcome {
        let Some((desc, frame)) = self.acquire()? else { return Ok(()) };
        self.follow_controls();
        let settings = Settings {
            size: [desc.extent[0], desc.extent[1]],
            exposure: self.show.start.exposure * self.controls.exposure(),
            without_relight: self.controls.without_relight,
            air: Air::with_fog(!self.controls.without_fog),
            window: Some(desc),
            ..self.show.start
        };
        let compiled = match &mut self.compiled {
            Some(compiled) if settings == self.settings => compiled,
            outdated => {
                if settings.size != self.settings.size {
                    self.renderer.resize(settings.size)?;
                }
                self.settings = settings;
                *outdated = None;
                outdated.insert(self.renderer.compile(&settings, TIMED_FRAMES, false)?)
            }
        };
        let turn = self.controls.turn() * settings.turn;
        self.renderer.turn(&compiled.turning, &settings, turn)?;
        let walked = self.first.map_or(0.0, |first| first.elapsed().as_secs_f64());
        self.renderer.move_to(settings.time + walked)?;
        let Compiled { execution, imports, timing, turning } = compiled;
        if let Some(window) = &turning.window {
            imports.image(window, &frame.image);
        }
        self.device.frame(&mut self.frames, frame.semaphores, execution, imports, timing.as_mut())?;
        if let Some(window) = &mut self.window {
            self.stale = !window.present(frame)?;
        }
        self.shown += 1;
        self.write_title();
        Ok(())
    }

    /// An image of the window and what it is, or `None` until the next try.
    fn acquire(&mut self) -> Outcome<Option<(ImageDesc, SurfaceFrame)>> {
        let Some(window) = &mut self.window else { return Ok(None) };
        if std::mem::take(&mut self.stale) {
            window.resize()?;
        }
        let acquired = window.desc().zip(window.acquire()?);
        self.stale = acquired.is_none();
        Ok(acquired)
    }

    /// Moves camera and light to where input and time have brought them.
    fn follow_controls(&mut self) {
        let now = Instant::now();
        let passed = self.last.map_or(0.0, |last| (now - last).as_secs_f64());
        self.first.get_or_insert(now);
        self.last = Some(now);
        self.controls.advance(self.show.spin * passed);
        self.renderer.look(self.controls.camera(&self.show.camera, self.show.center));
    }

    /// Frame rate, device times of the passes, and what is switched off, now and then.
    fn write_title(&mut self) {
        let now = Instant::now();
        let (since, before) = *self.titled.get_or_insert((now, self.shown));
        if now - since < TITLE_EVERY {
            return;
        }
        self.titled = Some((now, self.shown));
        let rate = f64::from(self.shown - before) / (now - since).as_secs_f64();
        let mut title = format!("{}: {rate:.1} frames/s", self.show.title);
        let timing = self.compiled.as_ref().and_then(|compiled| compiled.timing.as_ref());
        for pass in timing.and_then(Timing::summary).map_or(Vec::new(), |summary| summary.passes) {
            title.push_str(&format!(", {} {:.2} ms", pass.name, 1e3 * pass.median));
        }
        if self.controls.paused {
            title.push_str(", light stopped");
        }
        if self.controls.without_relight {
            title.push_str(", without relight");
        }
        if self.controls.without_fog {
            title.push_str(", without fog");
        }
        if let Some(window) = &self.window {
            window.window().set_title(&title);
        }
    }

    fn input(&mut self, event_loop: &ActiveEventLoop, event: WindowEvent) {
        match event {
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                match Action::of(&event.logical_key) {
                    Some(Action::Quit) => event_loop.exit(),
                    Some(action) => self.controls.act(action),
                    None => {}
                }
            }
            WindowEvent::MouseInput { state, button, .. } => {
                self.pointer.drag = match (state, button) {
                    (ElementState::Pressed, MouseButton::Left) => Some(Drag::Camera),
                    (ElementState::Pressed, MouseButton::Right) => Some(Drag::Light),
                    _ => None,
                };
            }
            WindowEvent::CursorMoved { position, .. } => {
                let at = [position.x as f32, position.y as f32];
                let before = self.pointer.at.replace(at);
                if let (Some(drag), Some(before)) = (self.pointer.drag, before) {
                    self.controls.drag(drag, [at[0] - before[0], at[1] - before[1]]);
                }
            }
            WindowEvent::MouseWheel { delta, .. } => self.controls.zoom(match delta {
                MouseScrollDelta::LineDelta(_, lines) => lines,
                MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / PIXELS_A_NOTCH,
            }),
            _ => {}
        }
    }

    /// Ends the event loop with a failure.
    fn unless_failed(&mut self, event_loop: &ActiveEventLoop, outcome: Outcome) {
        if outcome.is_err() {
            self.outcome = outcome;
            event_loop.exit();
        }
    }
}

impl ApplicationHandler for Viewer<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.window.is_none() {
            let opened = ShownWindow::open(self.device, event_loop, &self.show.title, self.show.start.size);
            let outcome = opened.map(|window| self.window = Some(window));
            self.unless_failed(event_loop, outcome);
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => event_loop.exit(),
            WindowEvent::Resized(_) => self.stale = true,
            WindowEvent::Occluded(hidden) => self.hidden = hidden,
            WindowEvent::RedrawRequested if !event_loop.exiting() => {
                let outcome = self.draw();
                self.unless_failed(event_loop, outcome);
                if self.show.frames.is_some_and(|frames| self.shown >= frames) {
                    event_loop.exit();
                }
            }
            input => self.input(event_loop, input),
        }
    }

    /// Draws without a pause while there is something to see; else waits for an event.
    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(window) = &self.window else { return };
        let size = window.window().inner_size();
        let visible = !self.hidden && size.width > 0 && size.height > 0;
        event_loop.set_control_flow(if visible { ControlFlow::Poll } else { ControlFlow::Wait });
        if visible {
            window.window().request_redraw();
        }
    }
}
