//! What sampling and shading lobes costs beside Toksvig's mean normal, on the test device:
//! `AIRGLOW_VALIDATION=off cargo run --release -p airglow-normals --example shading_cost`.

#![expect(clippy::unwrap_used, reason = "the maps are shared with the tests, whose helpers unwrap")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use airglow_gpu::ash::vk::{BufferUsageFlags, ImageViewType};
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, ComputePipelineDesc, GpuError, Label, Location, Recorder,
    Requirements, SamplerDesc, ViewDesc,
};
use airglow_graph::BufferDesc;
use airglow_math::statistics::median;
use airglow_normals::{Bench, FitSettings, Settings};
use airglow_tests::device::fixture_with;
use bytemuck::{Pod, Zeroable};

/// Pixels of a side.
const SIDE: u32 = 1024;
const ROUNDS: usize = 15;

/// `Settings` of `cost.comp`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct CostConstants {
    size: [u32; 2],
    level: f32,
    parameter: f32,
}

macro_rules! module {
    ($name:literal) => {
        include_bytes!(concat!("../../../shaders/spirv/normals/cost.", $name, ".spv")).as_slice()
    };
}

/// Name, lobes, Blinn-Phong's module and GGX's.
static METHODS: [(&str, usize, [&[u8]; 2]); 5] = [
    ("Toksvig", 1, [module!("toksvig.blinn"), module!("toksvig.ggx")]),
    ("1 lobe", 1, [module!("LAYERS1.lobes.blinn"), module!("LAYERS1.lobes.ggx")]),
    ("2 lobes", 2, [module!("LAYERS2.lobes.blinn"), module!("LAYERS2.lobes.ggx")]),
    ("4 lobes", 4, [module!("LAYERS4.lobes.blinn"), module!("LAYERS4.lobes.ggx")]),
    ("6 lobes", 6, [module!("LAYERS6.lobes.blinn"), module!("LAYERS6.lobes.ggx")]),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let map = common::weave(512);
    let fixture = fixture_with(&Requirements::engine());
    let context = fixture.context();
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(context, |recorder| record(recorder))
    };
    let bench = Bench { context, run: &run };
    println!("{}, {SIDE} x {SIDE} pixels, medians of {ROUNDS}", fixture.device().line());
    let sampler = context.create_sampler(&SamplerDesc::linear("kept"))?;
    let desc = BufferDesc { size: 4 * u64::from(SIDE * SIDE), usage: BufferUsageFlags::STORAGE_BUFFER };
    let output = context.create_buffer(Label::new("example", "radiance"), &desc, Location::Device)?;
    let bindings = [
        BindingDesc::new(0, BindingKind::SampledImage),
        BindingDesc::new(1, BindingKind::Sampler),
        BindingDesc::new(2, BindingKind::StorageBuffer),
    ];
    for (model, (name, parameter)) in [("Blinn-Phong 50", 50.0), ("GGX 0.2", 0.2)].into_iter().enumerate() {
        for (lookup, level) in [("bilinear, one level", 0.0), ("trilinear", 0.5)] {
            let mut works = Vec::new();
            for (method, lobes, modules) in &METHODS {
                let fit = FitSettings { lobes: *lobes, iterations: 8, ..Default::default() };
                let settings = Settings { fit, budget: Some(u64::MAX), ..Default::default() };
                let Some(texture) = bench.texture(&map, &settings)? else { continue };
                let pipeline = context.create_compute_pipeline(&ComputePipelineDesc {
                    name: method,
                    spirv: &bytemuck::pod_collect_to_vec(modules[model]),
                    bindings: &bindings,
                    push_constant_size: size_of::<CostConstants>() as u32,
                })?;
                let whole = ViewDesc {
                    dimension: ImageViewType::TYPE_2D_ARRAY,
                    base_mip: 0,
                    mips: texture.image.desc().mips,
                    base_layer: 0,
                    layers: texture.image.desc().layers,
                };
                works.push((*method, pipeline, texture.image.view(whole)?, Vec::new()));
            }
            // In turn, so that what else the machine does falls on all of them; the first round compiles.
            for round in 0..=ROUNDS {
                for (_, pipeline, view, times) in &mut works {
                    let begin = Instant::now();
                    run(&mut |recorder| {
                        let bound = [
                            Binding::sampled(0, view.clone()),
                            Binding::sampler(1, &sampler),
                            Binding::storage(2, &output),
                        ];
                        recorder.bind_compute(pipeline, &bound)?;
                        let constants = CostConstants { size: [SIDE; 2], level, parameter };
                        recorder.push_constants(&constants)?;
                        recorder.dispatch([SIDE / 8, SIDE / 8, 1])
                    })?;
                    if round > 0 {
                        times.push(begin.elapsed().as_secs_f64());
                    }
                }
            }
            println!("{name}, {lookup}");
            let medians: Vec<f64> =
                works.iter().map(|(.., times)| median(times).unwrap_or(f64::NAN)).collect();
            for ((method, ..), seconds) in works.iter().zip(&medians) {
                println!("  {method:8} {:7.2} ms, {:.2} times Toksvig", 1e3 * seconds, seconds / medians[0]);
            }
        }
    }
    Ok(())
}
