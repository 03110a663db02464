//! A scene's frame by each preset for all passes: device times of every pass, frames of all presets in turn.

use std::path::Path;

use airglow::math::Preset;
use airglow_bake::Transfer;
use airglow_gpu::{Execution, Imports, Timing};
use airglow_math::statistics::relative_l2;
use airglow_scene::{Presets, Quality, Scene};

use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::host::lighting;
use crate::host::renderer::Renderer;
use crate::host::settings::Settings;
use crate::host::source::Source;
use crate::host::transfer;
use crate::host::work;
use crate::output::Output;
use crate::report::interleave::{self, Rounds};
use crate::report::model::frame::{FrameReport, Missing, PassSamples, PresetFrame};
use crate::report::model::{Counts, Errors, Point};

/// A scene at each preset, before anything is on the device.
pub struct Stages {
    made: Vec<(Preset, Scene, Source)>,
}

/// A frame that can be run and timed.
struct Running<'d> {
    #[cfg_attr(not(feature = "radiance"), expect(dead_code, reason = "what the frame reads lives in it"))]
    renderer: Renderer<'d>,
    execution: Execution,
    imports: Imports,
    timing: Timing,
}

impl Stages {
    /// Bakes once, with the bands of the last preset; the others take the beginnings of its vectors. Rays are the scene's own.
    pub fn new(scene: &Scene, cache: &Path, output: &Output) -> Outcome<Self> {
        let at = |preset: Preset| {
            let presets = Presets { all: Some(preset), ..Presets::default() };
            let own = scene.quality;
            let quality = Quality { shadow: own.shadow, rays: own.rays, ..preset.into() };
            Scene { presets, quality, ..scene.clone() }
        };
        let most = at(Preset::Reference);
        let whole = match Source::of_scene(&most, false, cache, output)? {
            Source::Relight(whole) => Some(whole),
            _ => None,
        };
        let source = |scene: &Scene| -> Outcome<Source> {
            let Some(whole) = &whole else { return Source::unbaked(scene, false) };
            let mut own = transfer::unbaked(scene)?;
            own.transfers =
                whole.transfers.iter().map(|all| beginning(all, scene.quality.order as usize)).collect();
            #[cfg(feature = "shadow")]
            {
                own.spheres = whole.spheres.clone();
            }
            Ok(Source::Relight(own))
        };
        let made = Preset::ALL.into_iter().map(|preset| {
            let scene = at(preset);
            Ok((preset, source(&scene).map(|source| (scene, source))?))
        });
        let made: Outcome<Vec<_>> = made.collect();
        Ok(Self {
            made: made?.into_iter().map(|(preset, (scene, source))| (preset, scene, source)).collect(),
        })
    }

    /// What the device must offer.
    pub fn requirements(&self) -> airglow_gpu::Requirements {
        let all = self.made.iter().map(|(_, scene, source)| lighting::requirements(source, scene));
        all.reduce(|all, more| all.and(&more)).unwrap_or_else(airglow_gpu::Requirements::engine)
    }

    /// Frames of all presets in turn.
    pub fn measure(
        &self,
        device: &Device<'_>,
        size: [u32; 2],
        rounds: Rounds,
        output: &Output,
    ) -> Outcome<FrameReport> {
        let settings = Settings::plain(size);
        let (mut frames, mut running, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
        for (preset, scene, source) in &self.made {
            output.say(format!("drawing with {preset}"));
            let before = device.context().memory_report();
            let mut renderer = Renderer::new(device, scene, source, size)?;
            pictures.push(renderer.draw(&settings, 1)?.linear.pixels);
            let frame = Running::new(device, renderer, &settings)?;
            let plan = frame.execution.plan();
            frames.push(PresetFrame {
                preset: preset.to_string(),
                passes: frame.passes(),
                imported: plan.bytes().imported,
                transient: plan.bytes().transient,
                memory: grown(&before, &device.context().memory_report()),
                error: None,
            });
            running.push(frame);
        }
        let bar =
            output.progress("frames", ((rounds.warm_up + rounds.measured) * running.len()) as u64, "frames");
        let mut round = 0;
        interleave::measure(rounds, running.len(), |place| {
            bar.inc(1);
            let times = running[place].run(device)?;
            if round >= rounds.warm_up * running.len() {
                frames[place].add(&times);
            }
            round += 1;
            Ok::<f64, Failure>(times.iter().map(|(_, time)| time).sum())
        })?;
        bar.finish_and_clear();
        let flat =
            |pixels: &[[f32; 3]]| pixels.as_flattened().iter().map(|v| f64::from(*v)).collect::<Vec<_>>();
        if let Some((truth, others)) = pictures.split_last() {
            for (frame, picture) in frames.iter_mut().zip(others) {
                frame.error = Some(relative_l2(&flat(picture), &flat(truth)).map_err(Failure::work)?);
            }
        }
        let left_out = running.first().map_or(Vec::new(), |frame| missing(frame.execution.plan().left_out()));
        Ok(FrameReport { size, presets: frames, left_out, scalings: Vec::new() })
    }

    /// Time of the default's frame by its size in pixels.
    pub fn sizes(
        &self,
        device: &Device<'_>,
        sizes: &[[u32; 2]],
        rounds: Rounds,
        output: &Output,
    ) -> Outcome<Vec<(f64, Point)>> {
        let default = self.made.iter().find(|(preset, ..)| *preset == Preset::default());
        let Some((_, scene, source)) = default else { return Ok(Vec::new()) };
        let mut running = Vec::new();
        for &size in sizes {
            let renderer = Renderer::new(device, scene, source, size)?;
            running.push(Running::new(device, renderer, &Settings::plain(size))?);
        }
        output.say("drawing at several sizes");
        let times = interleave::measure(rounds, sizes.len(), |place| {
            Ok::<f64, Failure>(running[place].run(device)?.iter().map(|(_, time)| time).sum())
        })?;
        let point = |((size, milliseconds), frame): ((&[u32; 2], Vec<f64>), &Running<'_>)| {
            let pixels = f64::from(size[0]) * f64::from(size[1]);
            let [dispatches, draws, barriers] = frame.counts();
            let counts = Counts { dispatches, draws, barriers: Some(barriers), ..Counts::default() };
            let memory = frame.execution.plan().bytes().transient;
            let setting = format!("{} x {}", size[0], size[1]);
            (
                pixels,
                Point { setting, milliseconds, memory, counts, error: Errors::default(), distribution: None },
            )
        };
        Ok(sizes.iter().zip(times).zip(&running).map(point).collect())
    }
}

impl<'d> Running<'d> {
    fn new(device: &Device<'_>, mut renderer: Renderer<'d>, settings: &Settings) -> Outcome<Self> {
        let compiled = renderer.compile(settings, 1, false)?;
        let steps = compiled.execution.plan().steps().len() as u32;
        let timing = Timing::new(device.context(), steps, 0, 1).map_err(Failure::device)?;
        let mut running = Self { renderer, execution: compiled.execution, imports: compiled.imports, timing };
        // Counts are those of a frame recorded.
        running.run(device)?;
        Ok(running)
    }

    /// One frame, in which near emitters are sampled anew; milliseconds of each step.
    fn run(&mut self, device: &Device<'_>) -> Outcome<Vec<(String, f64)>> {
        #[cfg(feature = "radiance")]
        self.renderer.forget_samples();
        device.frames(&mut self.execution, &self.imports, Some(&mut self.timing), 1, |_| Ok(()))?;
        let Some(times) = self.timing.frames().last() else {
            return Err(Failure::work("the device gave no timestamps"));
        };
        let names = self.execution.plan().steps().iter().map(|step| step.name.clone());
        Ok(names.zip(times.passes.iter().map(|seconds| 1e3 * seconds)).collect())
    }

    /// Dispatches, draws and barriers of the frame.
    fn counts(&self) -> [u64; 3] {
        let of = |pass: &work::PassWork| [pass.counts.dispatches, pass.counts.draws, pass.counts.barriers];
        work::of_frame(&self.execution).iter().map(of).fold([0; 3], |a, b| [0, 1, 2].map(|i| a[i] + b[i]))
    }

    /// The passes by name, without times.
    fn passes(&self) -> Vec<PassSamples> {
        let mut passes: Vec<PassSamples> = Vec::new();
        for work::PassWork { name, counts } in work::of_frame(&self.execution) {
            let own = [counts.dispatches, counts.draws, counts.barriers];
            match passes.iter_mut().find(|pass| pass.name == name) {
                Some(pass) => pass.counts = [0, 1, 2].map(|i| pass.counts[i] + own[i]),
                None => passes.push(PassSamples { name, milliseconds: Vec::new(), counts: own }),
            }
        }
        passes
    }
}

impl PresetFrame {
    /// The times of one more frame.
    fn add(&mut self, times: &[(String, f64)]) {
        for pass in &mut self.passes {
            let own = times.iter().filter(|(name, _)| *name == pass.name);
            pass.milliseconds.push(own.map(|(_, time)| time).sum());
        }
    }
}

/// The first bands of a transfer.
fn beginning(whole: &Transfer, order: usize) -> Transfer {
    let (count, own) = (whole.coefficient_count(), order * order);
    let first = |values: &Vec<f32>| values.chunks_exact(count).flat_map(|row| &row[..own]).copied().collect();
    Transfer {
        order,
        vertex_count: whole.vertex_count,
        coefficients: first(&whole.coefficients),
        visibility: whole.visibility.as_ref().map(first),
    }
}

/// Bytes that owners hold now and did not before.
fn grown(before: &[airglow_gpu::OwnerBytes], now: &[airglow_gpu::OwnerBytes]) -> Vec<(String, u64)> {
    let held = |owner: &str| before.iter().find(|entry| entry.owner == owner).map_or(0, |entry| entry.bytes);
    let more = now.iter().map(|entry| (entry.owner.clone(), entry.bytes.saturating_sub(held(&entry.owner))));
    more.filter(|(_, bytes)| *bytes > 0).collect()
}

fn missing(left_out: &[airglow_graph::LeftOut]) -> Vec<Missing> {
    let one = |out: &airglow_graph::LeftOut| Missing {
        what: out.what.clone(),
        why: out.why.clone(),
        bytes: out.bytes,
        would_return: out.would_return.clone(),
    };
    left_out.iter().map(one).collect()
}
