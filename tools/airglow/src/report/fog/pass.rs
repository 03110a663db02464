//! The pass itself on a picture: its knobs, and its cost by lights.

use airglow::fog::{Fog, Frame, Light, PhaseKind, Preset, Settings, View};
use airglow_gpu::ash::vk::{Format, ImageUsageFlags};
use airglow_gpu::{Image, Imports, Label, Readback};
use airglow_graph::{Access, Graph, ImageDesc, PassKind, State};
use glam::DVec3;
use half::f16;

use super::evaluators::Measurement;
use super::picture::{Picture, SIDE};
use crate::failure::{Failure, Outcome};
use crate::host::upload;
use crate::report::interleave::{self, Rounds};
use crate::report::model::{Choice, Curve, Errors, Point};
use crate::report::timed_plan::{self, TimedPlan};

/// Rounds of the pass: its frames are long.
const ROUNDS: Rounds = Rounds { warm_up: 1, measured: 7 };

/// One frame of the pass, and its picture.
struct Shown {
    plan: TimedPlan,
    target: Image,
}

impl Measurement<'_> {
    /// Radiance below which a light is left out of a pixel.
    pub fn bound(&self, picture: &Picture) -> Outcome<Curve> {
        let bounds = [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];
        let default = Settings::default().bound;
        let named = |bound: f64| (format!("{bound:e}"), Settings { bound, ..Settings::default() });
        let settings = bounds.map(named);
        let points = self.pass_points("light bound", picture, &settings)?;
        let setting = format!("{default:e}");
        let comparisons = interleave::compare(&points, &setting).map_err(Failure::work)?;
        let reason = "half an 8-bit step of the darkest pixels at an exposure of 1 is 1.5e-4";
        Ok(Curve {
            knob: "light bound".to_owned(),
            question: "Below which radiance, W/sr/m2, is a light left out of a pixel?".to_owned(),
            norm: NORM.to_owned(),
            timed: format!("the pass on {}, device time", picture.words()),
            points,
            chosen: Some(Choice { setting, reason: reason.to_owned() }),
            comparisons,
        })
    }

    /// The two presets.
    pub fn preset(&self, picture: &Picture) -> Outcome<Curve> {
        let named =
            |name: &str, preset| (name.to_owned(), Settings { preset, bound: 0.0, ..Settings::default() });
        let settings = [named("default", Preset::Default), named("reference", Preset::Reference)];
        let points = self.pass_points("preset", picture, &settings)?;
        let comparisons = interleave::compare(&points, "default").map_err(Failure::work)?;
        Ok(Curve {
            knob: "preset".to_owned(),
            question: "6 taps or 16?".to_owned(),
            norm: NORM.to_owned(),
            timed: format!("the pass on {}, device time", picture.words()),
            points,
            chosen: Some(Choice {
                setting: "default".to_owned(),
                reason: "its error is below half an 8-bit step of the darkest pixel".to_owned(),
            }),
            comparisons,
        })
    }

    /// Time by the number of lights, all of which reach every pixel; the last has no extinction.
    pub fn lights(&self, picture: &Picture) -> Outcome<Curve> {
        let counts = [1, 2, 4, 8, 16, 32, 64];
        let settings = Settings { bound: 0.0, phase: PhaseKind::Isotropic, ..Settings::default() };
        let mut shown = Vec::new();
        for count in counts {
            let view = View { lights: grid(count), ..picture.view.clone() };
            shown.push((format!("{count} lights"), self.show(&settings, picture, view)?));
        }
        let mut clear = View { lights: grid(64), ..picture.view.clone() };
        clear.medium.extinction = [0.0; 3];
        shown.push(("64 lights, no extinction".to_owned(), self.show(&settings, picture, clear)?));
        let points = self.timed("lights", shown, |_, _| Ok(Errors::default()))?;
        Ok(Curve {
            knob: "lights".to_owned(),
            question: "Is the cost linear in the lights, and is there none without a medium?".to_owned(),
            norm: "none: all are computed alike".to_owned(),
            timed: "the pass, with nothing left out by a bound, device time; the last is a frame that leaves the pass out"
                .to_owned(),
            points,
            chosen: None,
            comparisons: Vec::new(),
        })
    }

    pub(super) fn pass_points(
        &self,
        what: &str,
        picture: &Picture,
        settings: &[(String, Settings)],
    ) -> Outcome<Vec<Point>> {
        let exact = |preset| match preset {
            Preset::Default => picture.taps(6, 8.0),
            Preset::Reference => picture.taps(16, 15.0),
        };
        let mut exacts = Vec::new();
        let mut shown = Vec::new();
        for (name, settings) in settings {
            exacts.push(exact(settings.preset)?);
            let settings = Settings { phase: PhaseKind::Isotropic, ..*settings };
            shown.push((name.clone(), self.show(&settings, picture, picture.view.clone())?));
        }
        self.timed(what, shown, |place, target| {
            let copy = self.device.run(|recorder| {
                recorder.transition(target, Access::ColorAttachmentWrite, Access::TransferSource)?;
                recorder.read_back_image(&target.full_view()?)
            });
            let airlight = colours(&copy.map_err(Failure::work)?, settings[place].1.format)?;
            let setting = Some(picture.errors(&airlight)?.largest);
            // What a bound leaves out is an error of the setting.
            let all = settings[place].1.bound == 0.0;
            let arithmetic = all.then(|| picture.difference(&airlight, &exacts[place]));
            Ok(Errors { arithmetic, setting, ..Errors::default() })
        })
    }

    fn timed(
        &self,
        what: &str,
        shown: Vec<(String, Shown)>,
        error: impl Fn(usize, &Image) -> Outcome<Errors>,
    ) -> Outcome<Vec<Point>> {
        let (names, shown): (Vec<_>, Vec<_>) = shown.into_iter().unzip();
        let (mut plans, targets): (Vec<_>, Vec<_>) =
            shown.into_iter().map(|Shown { plan, target }| (plan, target)).unzip();
        let times = timed_plan::measure(self.device, what, &mut plans, ROUNDS, self.output)?;
        let bytes = 36 * u64::from(SIDE * SIDE);
        let all = names.into_iter().zip(times).zip(plans.iter().zip(&targets));
        all.enumerate()
            .map(|(place, ((setting, milliseconds), (plan, target)))| {
                let (counts, error) = (plan.counts(bytes), error(place, target)?);
                Ok(Point { setting, milliseconds, memory: 0, counts, error, distribution: None })
            })
            .collect()
    }

    /// A frame of the pass over black surfaces.
    fn show(&self, settings: &Settings, picture: &Picture, view: View) -> Outcome<Shown> {
        let context = self.device.context();
        let fog = Fog::new(context, *settings).map_err(Failure::work)?;
        let black = vec![[0.0_f32, 0.0, 0.0, 1.0]; (SIDE * SIDE) as usize];
        let images = self.device.run(|recorder| {
            let (sampled, sampled_depth) = (Access::FragmentSampled, Access::FragmentSampledDepth);
            let levels = [(SIDE, SIDE, black)];
            let surface = upload::image(recorder, "surface", Format::R32G32B32A32_SFLOAT, &levels, sampled)?;
            let levels = [(SIDE, SIDE, picture.depths.clone())];
            let depth = upload::image(recorder, "depth", Format::D32_SFLOAT, &levels, sampled_depth)?;
            Ok((surface, depth))
        });
        let (surface, depth) = images.map_err(Failure::work)?;
        let usage =
            ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC | ImageUsageFlags::SAMPLED;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIDE, SIDE, settings.format) };
        let target =
            context.create_image(Label::new(upload::OWNER, "picture"), &desc).map_err(Failure::work)?;
        let (mut graph, mut imports) = (Graph::new(), Imports::new());
        let (sampled, sampled_depth) = (Access::FragmentSampled, Access::FragmentSampledDepth);
        let surface_handle = graph.import_image("surface", *surface.image().desc(), sampled, sampled);
        let depth_handle = graph.import_image("depth", *depth.image().desc(), sampled_depth, sampled_depth);
        let drawn = Access::ColorAttachmentWrite;
        let target_handle = graph.import_image("picture", desc, State::UNDEFINED, drawn);
        imports
            .image(&surface_handle, surface.image())
            .image(&depth_handle, depth.image())
            .image(&target_handle, &target);
        let frame = Frame {
            size: [SIDE; 2],
            surface: surface_handle,
            depth: depth_handle,
            target: Some(target_handle),
            view,
        };
        let fogged = fog.add(&mut graph, &frame).map_err(Failure::work)?;
        // What is left of the pass is seen by this one.
        let mut seen = graph.pass("host", PassKind::Graphics);
        seen.side_effect().read(&fogged.colour, sampled);
        seen.record(Box::new(|_, _| Ok(())));
        Ok(Shown { plan: TimedPlan::new(self.device, "fog", graph, imports)?, target })
    }
}

/// The colours of a picture read back, whose texels are floats or half floats.
fn colours(copy: &Readback, format: Format) -> Outcome<Vec<[f32; 3]>> {
    let texels: Vec<[f32; 4]> = match format {
        Format::R16G16B16A16_SFLOAT => {
            let texels: Vec<[f16; 4]> = copy.read().map_err(Failure::work)?;
            texels.into_iter().map(|texel| texel.map(f16::to_f32)).collect()
        }
        _ => copy.read().map_err(Failure::work)?,
    };
    Ok(texels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
}

pub(super) const NORM: &str = "setting: largest error against quadrature in f64, in half 8-bit steps of the exposed pixel over \
                    black surfaces, where steps are finest; below 1 it is not seen. arithmetic: the same, against \
                    the same taps in f64, where no bound leaves lights out";

/// Lamps in a row into the depth, all different.
fn grid(count: u32) -> Vec<Light> {
    let place = |i: u32| DVec3::new(f64::from(i % 4) * 3.0 - 4.5, 4.0, -4.0 - 2.0 * f64::from(i / 4));
    (0..count).map(|i| Light { radius: 0.05, ..Light::point(place(i), [20.0, 15.0, 8.0]) }).collect()
}
