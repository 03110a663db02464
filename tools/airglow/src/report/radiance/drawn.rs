//! Cube maps by the kernel of texels, against cube maps drawn by the rasteriser into an atlas.

use airglow::radiance::Triangle;
use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::gpu::{Atlas, TexelSettings, Texels};
use airglow::radiance::rivals::places;
use airglow_math::statistics::median;

use super::Measurement;
use super::curves::{default_settings, quarters};
use super::race::Runner;
use super::rivals::Work;
use crate::failure::{Failure, Outcome};
use crate::report::model::{Curve, Errors, Number, Point};

/// Samples of a draw.
const SAMPLES: usize = 128;
/// Rays along a side of the atlas.
const SIDE: u32 = 2048;

impl Measurement<'_> {
    /// Both at growing numbers of triangles, each before the other.
    pub fn drawn(&self) -> Outcome<Curve> {
        let mut emitters = self.workload.emitters.clone();
        let mut runners = Vec::new();
        for _ in 0..4 {
            runners.extend([self.sampled(&emitters, false)?, self.sampled(&emitters, true)?]);
            emitters = emitters.iter().flat_map(quarters).collect();
        }
        let PassRays { size, rays, texels } = PassRays::new();
        Ok(Curve {
            knob: "kernel or rasteriser".to_owned(),
            question: format!(
                "{SAMPLES} samples by the kernel, or drawn: one instanced indirect draw into an atlas, whose faces the \
                 vertex shader places and clips, {texels} rendered texels ({size} texels with {rays} x {rays} rays, six \
                 faces each), and a kernel that projects it. Triangles are the emitters', more and more finely cut."
            ),
            norm: "none: both see as many rays".to_owned(),
            timed: "sampling alone, device time of a frame".to_owned(),
            points: self.race("kernel or rasteriser", runners)?,
            chosen: None,
            comparisons: Vec::new(),
        })
    }

    fn sampled(&self, emitters: &[Triangle], drawn: bool) -> Outcome<Runner> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let pass = default_settings();
        let settings = TexelSettings { shape: Self::shape(), size: pass.face, rays: pass.rays };
        let points = places(&self.workload.positions, SAMPLES);
        let buffers = bench.buffers(settings.shape, emitters, &points).map_err(Failure::work)?;
        let bytes = settings.shape.light_bytes(points.len());
        let work: Work = if drawn {
            let atlas = Atlas::new(bench.context, settings, SIDE).map_err(Failure::work)?;
            let arguments = Atlas::arguments(emitters.len() as u32, points.len() as u32);
            let arguments = bench.upload("arguments", &arguments).map_err(Failure::work)?;
            Box::new(move |recorder| atlas.record(recorder, &buffers, &(&arguments).into()))
        } else {
            let texels = Texels::new(bench.context, settings).map_err(Failure::work)?;
            Box::new(move |recorder| texels.record(recorder, &buffers))
        };
        let name = format!("{}, {} triangles", if drawn { "drawn" } else { "kernel" }, emitters.len());
        self.rival(name, points.len(), bytes, Errors::default(), work)
    }
}

/// What is drawn.
struct PassRays {
    size: u32,
    rays: u32,
    texels: usize,
}

impl PassRays {
    fn new() -> Self {
        let pass = default_settings();
        let side = (pass.face * pass.rays) as usize;
        Self { size: pass.face, rays: pass.rays, texels: 6 * side * side * SAMPLES }
    }
}

/// From how many triangles on drawing takes less time.
pub fn breaks_even(curve: &Curve) -> Outcome<Number> {
    let time = |point: &Point| median(&point.milliseconds).map_err(Failure::work);
    let (mut words, mut first) = (Vec::new(), None);
    for pair in curve.points.chunks_exact(2) {
        let ratio = time(&pair[0])? / time(&pair[1])?;
        let triangles = pair[1].setting.trim_start_matches("drawn, ");
        words.push(format!("{triangles}: {ratio:.2}"));
        if ratio > 1.0 && first.is_none() {
            first = Some(triangles.to_owned());
        }
    }
    let first = first.map_or_else(|| "never here".to_owned(), |triangles| format!("from {triangles} on"));
    Ok(Number {
        what: "time of the kernel over that of drawing into an atlas; where drawing is faster".to_owned(),
        asked: "is said".to_owned(),
        measured: format!("{}; {first}", words.join(", ")),
        holds: curve.points.len() >= 2,
    })
}
