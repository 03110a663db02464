//! Frame after frame in a window: the same frame that `airglow render` draws, from one plan until something changes
//! that is compiled into it.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use airglow_gpu::TimingSummary;
use airglow_gpu::open::FrameLoop;
use airglow_gpu::surface::SurfaceFrame;
use airglow_graph::ImageDesc;
use airglow_scene::Camera;
use glam::Vec3;
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::WindowId;

use super::camera::Rig;
use super::controls::{Action, Controls};
use super::input::Input;
use super::interface::{Interface, Places};
use super::reload::Watch;
use super::shot::{self, Shot};
use super::stage::Stage;
use super::surface::ShownWindow;
use super::times::Times;
use super::wish::Wish;
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::host::picture::Compiled;
use crate::host::settings::{Air, Settings};
use crate::host::shaders;

/// Frames that the times printed at the end are medians of.
const TIMED_FRAMES: usize = 60;
/// How often the rate of frames is told anew.
const RATE_EVERY: Duration = Duration::from_millis(500);

/// What is shown, and for how long.
pub struct Show {
    /// The window's title.
    pub title: String,
    /// Where the camera starts.
    pub camera: Camera,
    /// The first frame; its size is that of the window at first, its turn and exposure are where input starts.
    pub start: Settings,
    /// Degrees that the light turns in a second.
    pub spin: f64,
    /// Ends after so many frames.
    pub frames: Option<u32>,
    /// Where pictures of the window go.
    pub picture: PathBuf,
    /// Whether the last frame is written there.
    pub last_picture: bool,
    /// Whether the panel is hidden at first.
    pub bare: bool,
    /// Shaders that may change.
    pub watch: Option<Watch>,
}

/// What was shown.
pub struct Shown {
    /// Frames.
    pub frames: u32,
    /// From the first to the last of them.
    pub seconds: f64,
    /// Device times of the last of them; `None` with too few.
    pub timing: Option<TimingSummary>,
    /// Where parts of the panel were.
    pub places: Places,
    /// Where the camera was at last.
    pub camera: Camera,
}

/// Draws to a window and listens to it.
pub struct Viewer<'d> {
    pub(super) device: &'d Device<'d>,
    pub(super) name: String,
    pub(super) stage: Stage<'d>,
    pub(super) show: Show,
    pub(super) settings: Settings,
    pub(super) controls: Controls,
    pub(super) wish: Wish,
    pub(super) rig: Rig,
    pub(super) input: Input,
    pub(super) frames: FrameLoop<'d>,
    pub(super) compiled: Option<Compiled>,
    /// Dropped before the window.
    pub(super) interface: Option<Interface>,
    pub(super) places: Places,
    pub(super) shot: Shot,
    pub(super) window: Option<ShownWindow<'d>>,
    /// Whether the swapchain must be made again.
    pub(super) stale: bool,
    /// Whether nothing of the window can be seen.
    pub(super) hidden: bool,
    pub(super) times: Times,
    pub(super) shown: u32,
    pub(super) first: Option<Instant>,
    pub(super) last: Option<Instant>,
    /// When the rate was told, how many frames had been shown, and the rate.
    pub(super) told: Option<(Instant, u32, f64)>,
    /// When samples were read back, and where they are.
    pub(super) samples: Option<(Instant, Vec<Vec3>)>,
    /// What happened last, or went wrong.
    pub(super) status: Result<String, String>,
    pub(super) outcome: Outcome,
}

impl<'d> Viewer<'d> {
    /// Shows a scene; the window opens when the event loop runs.
    pub fn new(device: &'d Device<'d>, stage: Stage<'d>, show: Show) -> Outcome<Self> {
        Ok(Self {
            device,
            name: device.machine().device,
            settings: show.start,
            controls: Controls { bare: show.bare, ..Controls::new(show.spin) },
            wish: Wish::default(),
            rig: Rig::new(show.camera.clone(), stage.middle()),
            stage,
            show,
            input: Input::default(),
            frames: device.frame_loop()?,
            compiled: None,
            interface: None,
            places: Places::new(),
            shot: Shot::default(),
            window: None,
            stale: false,
            hidden: false,
            times: Times::default(),
            shown: 0,
            first: None,
            last: None,
            told: None,
            samples: None,
            status: Ok(String::new()),
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
        let camera = self.rig.camera();
        Ok(Shown { frames: self.shown, seconds, timing, places: self.places, camera })
    }

    /// Draws and shows one frame, unless the window has no pixels or changed just now.
    fn draw(&mut self) -> Outcome {
        let Some((desc, frame)) = self.acquire()? else { return Ok(()) };
        self.advance();
        self.follow()?;
        self.lay_out(&desc)?;
        let last = self.show.frames == Some(self.shown + 1) && self.show.last_picture;
        let picture = (last || std::mem::take(&mut self.input.picture)) && self.can_copy(&desc);
        self.prepare(&desc, picture)?;
        self.submit(frame)?;
        if picture {
            self.write_picture(&desc)?;
        }
        self.shown += 1;
        Ok(())
    }

    /// The plan of the next frame, a new one where something compiled into it has changed.
    fn prepare(&mut self, desc: &ImageDesc, picture: bool) -> Outcome {
        let (controls, start) = (&self.controls, &self.show.start);
        let settings = Settings {
            size: [desc.extent[0], desc.extent[1]],
            exposure: start.exposure * controls.exposure(),
            without_relight: !controls.passes.relight,
            without_shadow: !controls.passes.shadow,
            air: Air::with_fog(controls.passes.fog),
            window: Some(*desc),
            ..*start
        };
        if picture || settings != self.settings {
            self.compiled = None;
        }
        self.shot.ask(picture);
        self.stage.renderer.look(self.rig.camera());
        if self.compiled.is_none() {
            if settings.size != self.settings.size {
                self.stage.resize(settings.size)?;
            }
            self.settings = settings;
            self.compiled = Some(self.stage.renderer.compile(&settings, TIMED_FRAMES, false)?);
        }
        if let Some(compiled) = &self.compiled {
            let turn = self.controls.rotation() * settings.turn;
            self.stage.renderer.turn(&compiled.turning, &settings, turn)?;
            self.stage.renderer.move_to(self.seconds())?;
        }
        Ok(())
    }

    /// Draws the frame and shows it.
    fn submit(&mut self, frame: SurfaceFrame) -> Outcome {
        let Some(Compiled { execution, imports, timing, turning }) = &mut self.compiled else {
            return Ok(());
        };
        if let Some(window) = &turning.window {
            imports.image(window, &frame.image);
        }
        self.device.frame(&mut self.frames, frame.semaphores, execution, imports, timing.as_mut())?;
        if let Some(timing) = timing {
            self.times.take(timing);
        }
        if let Some(window) = &mut self.window {
            self.stale = !window.present(frame)?;
        }
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
    fn advance(&mut self) {
        let now = Instant::now();
        let passed = self.last.map_or(0.0, |last| (now - last).as_secs_f64());
        self.first.get_or_insert(now);
        self.last = Some(now);
        self.controls.advance(passed);
        if let (Some(way), true) = (self.input.held.way(), self.controls.flies) {
            self.rig.fly(way, self.input.held.fast, passed as f32);
        }
        let (since, before, rate) = *self.told.get_or_insert((now, self.shown, 0.0));
        if now - since >= RATE_EVERY || rate == 0.0 && self.shown > before {
            let rate = f64::from(self.shown - before) / (now - since).as_secs_f64();
            self.told = Some((now, self.shown, rate));
        }
    }

    /// Makes anew what was asked for, and what shaders have changed.
    fn follow(&mut self) -> Outcome {
        if let Some(found) = self.show.watch.as_mut().and_then(Watch::look) {
            self.status = found.and_then(|modules| self.draw_with(modules));
        }
        let done = self.stage.follow(&mut self.wish);
        if done.anew {
            self.compiled = None;
            self.samples = None;
        }
        if done.other {
            self.start_over()?;
        }
        if let Some(status) = done.status {
            self.status = status;
        }
        Ok(())
    }

    /// Draws with shaders that have changed, or goes on with those before; what to tell.
    fn draw_with(&mut self, modules: shaders::Modules) -> Result<String, String> {
        let names: Vec<String> = modules.keys().cloned().collect();
        let before = shaders::replace_more(modules);
        match self.stage.reload() {
            Ok(()) => {
                self.compiled = None;
                Ok(format!("drawn with {}", names.join(", ")))
            }
            Err(failure) => {
                shaders::replace(before);
                Err(format!("{failure}; the last good shaders stay"))
            }
        }
    }

    /// Looks at another scene as it says.
    fn start_over(&mut self) -> Outcome {
        self.show.camera = self.stage.scene().camera();
        self.rig = Rig::new(self.show.camera.clone(), self.stage.middle());
        let settings = Settings { window: None, ..self.settings };
        let stated = self.stage.scene().exposure;
        self.show.start.exposure = self.stage.renderer.exposure(None, stated, &settings)?;
        Ok(())
    }

    /// Seconds after the scene's time 0.
    pub(super) fn seconds(&self) -> f64 {
        self.show.start.time + self.controls.walked
    }

    fn can_copy(&mut self, desc: &ImageDesc) -> bool {
        let can = shot::can_copy(desc);
        if !can {
            self.status = Err("this window cannot be copied; use airglow render".to_owned());
        }
        can
    }

    fn write_picture(&mut self, desc: &ImageDesc) -> Outcome {
        self.frames.finish().map_err(Failure::work)?;
        self.shot.write(desc, &self.show.picture)?;
        self.status = Ok(format!("{} written", self.show.picture.display()));
        self.compiled = None;
        Ok(())
    }

    pub(super) fn act(&mut self, action: Action) {
        self.controls.act(action);
        match action {
            Action::Home => {
                self.rig.reset();
                self.stage.home();
                self.compiled = None;
            }
            Action::Picture => self.input.picture = true,
            _ => {}
        }
    }

    fn input(&mut self, event_loop: &ActiveEventLoop, event: &WindowEvent) {
        if let (Some(interface), Some(window)) = (&mut self.interface, &self.window)
            && interface.takes(window.window(), event)
        {
            self.input.let_go();
            return;
        }
        let height = self.settings.size[1] as f32;
        match self.input.take(event, &mut self.controls, &mut self.rig, height) {
            Some(Action::Quit) => event_loop.exit(),
            Some(action) => self.act(action),
            None => {}
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
            WindowEvent::DroppedFile(ref file) => {
                if let Err(why) = self.stage.take_file(file) {
                    self.status = Err(why);
                }
            }
            WindowEvent::RedrawRequested if !event_loop.exiting() => {
                let outcome = self.draw();
                self.unless_failed(event_loop, outcome);
                if self.show.frames.is_some_and(|frames| self.shown >= frames) {
                    event_loop.exit();
                }
            }
            _ => {}
        }
        self.input(event_loop, &event);
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
