//! Times of sampling and shading, all methods in turn in one kernel.

use airglow::normals::cost::{Shading, whole};
use airglow::normals::{Bench, Brdf, Method, Settings};
use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Buffer, Image, Imports, Label, Location, Record, SamplerDesc};
use airglow_graph::{Access, BufferDesc, Graph, PassKind, State};

use super::workload::Map;
use super::{Measurement, words};
use crate::failure::{Failure, Outcome};
use crate::host::upload;
use crate::report::model::Counts;
use crate::report::timed_plan::{self, TimedPlan};

/// Pixels of a side.
pub const SIDE: u32 = 512;

/// Milliseconds of each method, and what it does.
pub fn times(
    measurement: &Measurement<'_>,
    map: &Map,
    brdf: Brdf,
    methods: &[Method],
) -> Outcome<Vec<(Vec<f64>, Counts)>> {
    let device = measurement.device;
    let run = device.bench();
    let bench = Bench { context: device.context(), run: &run };
    let output = radiance(measurement)?;
    let settings = Settings { budget: Some(u64::MAX), ..Settings::default() };
    let mut plans = Vec::new();
    let mut bytes = Vec::new();
    for &method in methods {
        let kept = bench.kept(&map.normals, method, &settings).map_err(Failure::work)?;
        let kept =
            kept.ok_or_else(|| Failure::input(format!("{}: a single texel has no levels", map.name)))?;
        let shading =
            Shading::new(device.context(), method, settings.storage, brdf).map_err(Failure::work)?;
        plans.push(plan(measurement, method, &shading, &kept, &output)?);
        bytes.push(4 * u64::from(SIDE * SIDE) * (1 + 8 * method.numbers().div_ceil(4) as u64));
    }
    let what = format!("shading {}, {}", map.name, words(brdf));
    let times =
        timed_plan::measure(device, &what, &mut plans, measurement.effort.rounds, measurement.output)?;
    Ok(times.into_iter().zip(plans.iter().zip(bytes).map(|(plan, bytes)| plan.counts(bytes))).collect())
}

fn radiance(measurement: &Measurement<'_>) -> Outcome<Buffer> {
    let desc = BufferDesc { size: 4 * u64::from(SIDE * SIDE), usage: BufferUsageFlags::STORAGE_BUFFER };
    let label = Label::new(upload::OWNER, "radiance");
    measurement.device.context().create_buffer(label, &desc, Location::Device).map_err(Failure::work)
}

/// One frame of a method.
fn plan(
    measurement: &Measurement<'_>,
    method: Method,
    shading: &Shading,
    kept: &Image,
    output: &Buffer,
) -> Outcome<TimedPlan> {
    let sampler =
        measurement.device.context().create_sampler(&SamplerDesc::linear("kept")).map_err(Failure::work)?;
    let (mut graph, mut imports) = (Graph::<Record>::new(), Imports::new());
    let sampled = Access::FragmentSampled;
    let texture = graph.import_image("kept", *kept.desc(), sampled, sampled);
    let radiance = graph.import_buffer("radiance", *output.desc(), State::UNDEFINED, State::UNDEFINED);
    imports.image(&texture, kept).buffer(&radiance, output);
    let view = whole(kept).map_err(Failure::work)?;
    let (shading, output) = (shading.clone(), output.clone());
    let mut pass = graph.pass("shading", PassKind::Compute);
    pass.side_effect().read(&texture, Access::ComputeSampled);
    pass.write(radiance, Access::ComputeStorageWrite);
    pass.record(Box::new(move |recorder, _| {
        shading.record(recorder, (&view, &sampler), &output, [SIDE; 2], 0.0)
    }));
    TimedPlan::new(measurement.device, method.to_string(), graph, imports)
}
