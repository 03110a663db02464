//! A froxel volume (Wronski, "Volumetric Fog: Unified Compute Shader Based Solution to Atmospheric Scattering", 2014):
//! its cost does not grow with the pixels, its error does with the cells' size, and it holds the volume.

use std::f64::consts::PI;

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Binding, BindingDesc, BindingKind, ComputePipelineDesc, Imports, Label, Location, Record};
use airglow_graph::{Access, BufferDesc, Graph, PassKind};
use bytemuck::{Pod, Zeroable};

use super::{OWNER, Track};
use crate::bench::Bench;
use crate::kernels::words;
use crate::{FogError, View};

/// End of the nearest cell, metres.
const FIRST: f64 = 0.5;

/// Optical length at which the volume ends.
const LAST: f64 = 10.0;

/// Cells of a volume across, down and into a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Froxels {
    /// At least 2 each.
    pub cells: [u32; 3],
}

/// `Settings` of `froxels.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Settings {
    corner: [f32; 4],
    across: [f32; 4],
    down: [f32; 4],
    extinction: [f32; 4],
    size: [u32; 4],
}

/// The modules that fill the volume and read it.
static SPIRV: [&[u8]; 2] = [
    include_bytes!("../../../../shaders/spirv/fog/froxels.FILL.spv").as_slice(),
    include_bytes!("../../../../shaders/spirv/fog/froxels.spv").as_slice(),
];

impl Froxels {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> String {
        let [x, y, z] = self.cells;
        format!("froxels {x} x {y} x {z}")
    }

    /// Bytes of the volume.
    #[must_use]
    pub fn memory(&self) -> u64 {
        16 * self.cells.into_iter().map(u64::from).product::<u64>()
    }

    /// The modules that fill the volume and read it; little-endian words as bytes.
    #[must_use]
    pub fn spirv(&self) -> [&'static [u8]; 2] {
        SPIRV
    }

    /// Bindings of both: rows, airlight, cells, lights.
    #[must_use]
    pub fn bindings(&self) -> [BindingDesc; 4] {
        [0, 1, 2, 3].map(|binding| BindingDesc::new(binding, BindingKind::StorageBuffer))
    }

    fn settings(&self, view: &View, side: u32) -> Settings {
        let rays = view.camera.rays(&view.world, [side; 2]).direction;
        let least = view.medium.extinction.into_iter().fold(f64::INFINITY, f64::min);
        let wide = |vector: glam::DVec3, w: f64| vector.extend(w).as_vec4().to_array();
        let [red, green, blue] = view.medium.extinction.map(|extinction| extinction as f32);
        let [x, y, z] = self.cells;
        Settings {
            corner: wide(rays[0], FIRST),
            across: wide(rays[1], (LAST / least / FIRST).ln()),
            down: wide(rays[2], f64::from(side)),
            extinction: [red, green, blue, 0.0],
            size: [x, y, z, view.lights.len() as u32],
        }
    }
}

impl Bench<'_> {
    /// Adds the two passes of a volume to a graph: for a perspective view of `side` by `side` pixels, whose rays' lengths
    /// are those of the first rows, with its lights as points that shine everywhere and scatter alike in all directions.
    ///
    /// # Errors
    /// [`FogError::Gpu`].
    pub fn add_froxels(
        &self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        track: &Track,
        froxels: Froxels,
        (view, side): (&View, u32),
    ) -> Result<(), FogError> {
        let settings = froxels.settings(view, side);
        let scattering = view.medium.scattering();
        let light = |light: &crate::Light| {
            let position = (light.position - view.camera.position).as_vec3().to_array();
            let weight =
                |channel: usize| (scattering[channel] * light.intensity[channel] / (4.0 * PI)) as f32;
            let [x, y, z] = position;
            [[x, y, z, (light.radius * light.radius) as f32], [weight(0), weight(1), weight(2), 0.0]]
        };
        let lights: Vec<[[f32; 4]; 2]> = view.lights.iter().map(light).collect();
        let usage = BufferUsageFlags::STORAGE_BUFFER;
        let desc = BufferDesc { size: size_of_val(&lights[..]) as u64, usage };
        let buffer = self.context.create_buffer(Label::new(OWNER, "lights"), &desc, Location::Upload)?;
        buffer.write(0, &lights)?;
        let (read, write) = (Access::ComputeStorageRead, Access::ComputeStorageWrite);
        let rows = graph.import_buffer("rays", *track.rows.desc(), read, read);
        let airlight = graph.import_buffer("airlight", *track.airlight.desc(), write, write);
        imports.buffer(&rows, &track.rows).buffer(&airlight, &track.airlight);
        let [x, y, _] = froxels.cells;
        let groups = [(x * y).div_ceil(64), (side * side).div_ceil(64)];
        let mut volume = None;
        let mut airlight = airlight;
        for (stage, (name, groups)) in ["fill froxels", "read froxels"].into_iter().zip(groups).enumerate() {
            let pipeline = self.context.create_compute_pipeline(&ComputePipelineDesc {
                name,
                spirv: &words(SPIRV[stage]),
                bindings: &froxels.bindings(),
                push_constant_size: size_of::<Settings>() as u32,
            })?;
            let mut pass = graph.pass(name, PassKind::Compute);
            pass.side_effect().read(&rows, read);
            let cells = match volume {
                None => pass.create_buffer("froxels", BufferDesc::new(froxels.memory()), write),
                Some(cells) => {
                    pass.read(&cells, read);
                    cells
                }
            };
            volume = Some(cells);
            airlight = pass.write(airlight, write);
            let lights = buffer.clone();
            pass.record(Box::new(move |recorder, resources| {
                let bindings = [
                    Binding::storage(0, resources.buffer(&rows)?),
                    Binding::storage(1, resources.buffer(&airlight)?),
                    Binding::storage(2, resources.buffer(&cells)?),
                    Binding::storage(3, &lights),
                ];
                recorder.bind_compute(&pipeline, &bindings)?;
                recorder.push_constants(&settings)?;
                recorder.dispatch([groups, 1, 1])
            }));
        }
        Ok(())
    }
}
