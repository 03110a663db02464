//! What a frame lays out over its picture: the panel, what the passes work with, and what can be dragged.

use std::sync::Arc;
use std::time::{Duration, Instant};

use airglow_graph::ImageDesc;
use glam::{Vec2, Vec3};

use super::controls::Action;
use super::grab::{self, Handle};
use super::interface::Interface;
use super::knobs;
use super::overlay::{self, Overlay};
use super::panel;
use super::projection::Projection;
use super::told::Told;
use super::viewer::Viewer;
use crate::failure::Outcome;

/// How often samples are read back while they are shown; each time the device is waited for.
const SAMPLES_EVERY: Duration = Duration::from_millis(400);

impl Viewer<'_> {
    /// Where samples are, read back now and then while they are shown.
    fn read_samples(&mut self) -> Outcome<Vec<Vec3>> {
        if !self.controls.shown.samples || self.controls.bare {
            self.samples = None;
            return Ok(Vec::new());
        }
        let fresh = self.samples.as_ref().is_some_and(|(when, _)| when.elapsed() < SAMPLES_EVERY);
        if !fresh && self.compiled.is_some() {
            self.samples = Some((Instant::now(), self.stage.renderer.sample_points()?));
        }
        Ok(self.samples.as_ref().map_or(Vec::new(), |(_, points)| points.clone()))
    }

    /// What can be dragged, and how the camera sees it.
    fn handles(&self, desc: &ImageDesc) -> (Vec<Handle>, Projection) {
        let projection = Projection::new(&self.rig.camera(), [desc.extent[0], desc.extent[1]]);
        let there = self.controls.shown.handles && !self.controls.bare;
        let handles = if there { grab::handles(self.stage.scene(), self.seconds()) } else { Vec::new() };
        (handles, projection)
    }

    /// Moves what the mouse drags.
    fn drag(&mut self, handles: &[Handle], projection: &Projection, scale: f32) {
        let under = |mouse: Vec2| grab::under(handles, projection, mouse, scale);
        self.input.over = self.input.mouse().and_then(under);
        let held = self.input.grabbed.and_then(|held| handles.get(held));
        if let (Some(handle), Some(mouse)) = (held, self.input.mouse())
            && let Some(to) = handle.dragged(projection, mouse)
            && to.distance(handle.at) > 1e-5
        {
            self.stage.place(|scene| handle.shift(scene, to - handle.at));
            // Figures are posed in every frame of a plan; lamps are compiled into it.
            if !matches!(handle.what, grab::What::Figure(_)) {
                self.compiled = None;
            }
        }
    }

    /// Opens the panel with the first frame.
    fn open_interface(&mut self, desc: &ImageDesc) -> Outcome {
        let (Some(window), None) = (&self.window, &self.interface) else { return Ok(()) };
        let interface = Interface::new(self.device, window.window(), desc.format)?;
        let (painter, shot) = (interface.painter().clone(), self.shot.clone());
        self.stage.draw_over(Arc::new(move |graph, window| {
            let window = painter.add(graph, window);
            shot.add(graph, window);
        }));
        self.interface = Some(interface);
        Ok(())
    }

    /// Lays out the panel and what is drawn over the picture, either of which may change what is drawn.
    pub(super) fn lay_out(&mut self, desc: &ImageDesc) -> Outcome {
        self.open_interface(desc)?;
        let scale = self.window.as_ref().map_or(1.0, |window| window.window().scale_factor() as f32);
        let (handles, projection) = self.handles(desc);
        self.drag(&handles, &projection, scale);
        for handle in &handles {
            if let Some((Vec2 { x, y }, _)) = projection.pixel(handle.at) {
                self.places.insert(format!("ring of {}", handle.name), [x, y, x, y]);
            }
        }
        let samples = self.read_samples()?;
        let spheres = match self.controls.shown.spheres && !self.controls.bare {
            true => self.stage.renderer.blockers(self.seconds()),
            false => Vec::new(),
        };
        let held = self.input.grabbed.or(self.input.over);
        let overlay = Overlay { samples: &samples, spheres: &spheres, handles: &handles, held };
        let plan = self.compiled.as_ref().map(|compiled| compiled.execution.plan());
        let left_out = plan.map_or(Vec::new(), |plan| plan.left_out().to_vec());
        let scene = self.stage.scene();
        let told = Told {
            device: &self.name,
            rate: self.told.map_or(0.0, |(.., rate)| rate),
            size: [desc.extent[0], desc.extent[1]],
            times: &self.times,
            left_out: &left_out,
            presets: &scene.presets,
            values: knobs::values(scene, &self.wish),
            medium: scene.medium,
            present: &self.stage.present(),
            busy: self.stage.busy(),
            status: &self.status,
        };
        let (Some(interface), Some(window)) = (&mut self.interface, &self.window) else { return Ok(()) };
        let (controls, wish, places) = (&mut self.controls, &mut self.wish, &mut self.places);
        let mut asked = panel::Asked::default();
        interface.run(window.window(), |context| {
            overlay::show(context, &projection, &overlay);
            asked = panel::show(context, controls, wish, &told, places);
        });
        self.input.picture |= asked.picture;
        if asked.home {
            self.act(Action::Home);
        }
        Ok(())
    }
}
