//! This room inside a host with a device of its own, by both roads.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Context, Options, Recorder, Requirements};
use airglow_graph::Access;
use airglow_radiance::{Bindings, Lights, Part, PassSettings, Prepared, Radiance, Receiver, Resource};
use airglow_tests::conformance::{Declared, Given, HostResource, Refusal, Room, conform};
use glam::DMat3;

use crate::receivers::Mesh;
use crate::scenes::blocks;

const SETTINGS: fn() -> PassSettings =
    || PassSettings { order: 3, gradients: false, face: 8, rays: 1, ..PassSettings::default() };
const NAMES: [&str; 2] = ["light of the first part", "light of the second part"];

/// The light of two instances, which a host keeps.
struct Lit {
    radiance: Radiance,
    receiver: Receiver,
    sizes: Vec<u64>,
    prepared: Option<Prepared>,
}

impl Lit {
    fn new(context: &Context) -> Self {
        let mesh = Mesh::ball(12, 3, false);
        let parts = [
            Part { vertices: 0..70, turn: None },
            Part { vertices: 70..144, turn: Some(DMat3::from_rotation_x(0.4)) },
        ];
        let receiver = Receiver::new(context, SETTINGS(), &mesh.tree, &mesh.positions, &parts).unwrap();
        let radiance = Radiance::new(context, SETTINGS()).unwrap();
        let sizes = parts.iter().map(|part| SETTINGS().light_bytes() * part.vertices.len() as u64);
        Self { radiance, receiver, sizes: sizes.collect(), prepared: None }
    }
}

impl Room for Lit {
    fn requirements(&self) -> Requirements {
        Radiance::requirements(self.radiance.settings())
    }

    fn resources(&self) -> Vec<HostResource> {
        let ends = [Access::ComputeStorageWrite, Access::ComputeStorageRead];
        let results =
            |(name, size)| HostResource::results(name, size, BufferUsageFlags::STORAGE_BUFFER, ends);
        NAMES.into_iter().zip(self.sizes.iter().copied()).map(results).collect()
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let lights = Lights { emitters: &blocks(), distant: &[] };
        let lit = self.radiance.add(to.graph, to.imports, &self.receiver, &lights)?;
        (0..).zip(lit.light).try_for_each(|(place, light)| to.keep(light, place))
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let prepared =
            self.radiance.prepare(&self.receiver, &Lights { emitters: &blocks(), distant: &[] })?;
        let accesses = prepared.accesses();
        let ends = |part| {
            let (_, all) = accesses.iter().find(|(resource, _)| *resource == Resource::VertexLight(part))?;
            Some((*all.first()?, *all.last()?))
        };
        let ends = (0..2).map(ends).collect();
        self.prepared = Some(prepared);
        Ok(ends)
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let given =
            |(part, given): (u32, &Given)| -> Result<_, Refusal> { Ok((part, given.buffer()?.into())) };
        let bindings = (0..).zip(host).map(given).collect::<Result<Bindings, Refusal>>()?;
        let prepared = self.prepared.as_ref().ok_or("not prepared")?;
        Ok(prepared.record(recorder, &bindings)?)
    }
}

#[test]
fn both_roads_give_the_same_bits() {
    let outputs = conform(Lit::new, &Radiance::requirements(&SETTINGS()), &Options::default());
    let bright =
        |bytes: &Vec<u8>| bytes.chunks_exact(4).any(|x| f32::from_le_bytes([x[0], x[1], x[2], x[3]]) > 0.1);
    assert!(outputs.len() == 2 && outputs.iter().all(bright));
}
