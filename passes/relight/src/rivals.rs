//! The rivals of the colour kernel: other layouts, workgroups and vertices of an invocation, and kernels that move
//! the same bytes without the arithmetic. The default was chosen among them by measurement (README.md).

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, ComputePipelineDesc, Context, Imports, Label, Location,
    Record, words,
};
use airglow_graph::{Access, BufferDesc, Graph, Handle, PassKind};
use bytemuck::Pod;

use crate::RelightError;
use crate::constants::ChunkConstants;
use crate::pack::{Layout, VERTEX_ALIGNMENT};
use crate::resident::{OWNER, Resident};
use crate::settings::Storage;

/// The order that all rivals are compiled for.
pub const ORDER: usize = 4;

/// What a rival does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Makes the colours.
    Colour,
    /// Reads the same words and writes as many, with one addition a word.
    Move,
    /// `vkCmdCopyBuffer` that reads and writes as many bytes as the others together.
    Copy,
}

/// One contestant.
#[derive(Clone, Copy, Debug)]
pub struct Rival {
    /// What it does.
    pub task: Task,
    /// How the vectors lie.
    pub layout: Layout,
    /// How they are stored.
    pub storage: Storage,
    /// Vertices of an invocation.
    pub vertices: u32,
    /// Invocations of a workgroup.
    pub workgroup: u32,
    spirv: &'static [u8],
}

/// The two modules of one shape: colours, then bytes alone.
macro_rules! shape {
    ($list:ident, $layout:expr, $lay:literal, $storage:expr, $sto:literal, $vertices:literal, $workgroup:literal) => {
        let (layout, storage, vertices, workgroup) = ($layout, $storage, $vertices, $workgroup);
        macro_rules! module {
            ($name:literal) => {
                include_bytes!(concat!(
                    "../../../shaders/spirv/relight/",
                    $name,
                    ".",
                    $lay,
                    ".",
                    $sto,
                    ".VERTICES",
                    $vertices,
                    ".WORKGROUP",
                    $workgroup,
                    ".spv"
                ))
                .as_slice()
            };
        }
        let spirv = module!("colour_rival");
        $list.push(Rival { task: Task::Colour, layout, storage, vertices, workgroup, spirv });
        let spirv = module!("bandwidth");
        $list.push(Rival { task: Task::Move, layout, storage, vertices, workgroup, spirv });
    };
}
macro_rules! storages {
    ($list:ident, $layout:expr, $lay:literal, $vertices:literal, $workgroup:literal) => {
        shape!($list, $layout, $lay, Storage::F32, "f32", $vertices, $workgroup);
        shape!($list, $layout, $lay, Storage::F16, "f16", $vertices, $workgroup);
    };
}
macro_rules! layouts {
    ($list:ident, $vertices:literal) => {
        storages!($list, Layout::Planes, "planes", $vertices, 64);
        storages!($list, Layout::Vertices, "vertices", $vertices, 64);
        storages!($list, Layout::VertexBlocks, "vertex_blocks", $vertices, 64);
        storages!($list, Layout::BlockPlanes, "block_planes", $vertices, 64);
    };
}

/// Every rival.
#[must_use]
pub fn all() -> Vec<Rival> {
    let mut list = Vec::new();
    layouts!(list, 1);
    layouts!(list, 2);
    layouts!(list, 4);
    storages!(list, Layout::BlockPlanes, "block_planes", 2, 32);
    storages!(list, Layout::BlockPlanes, "block_planes", 2, 128);
    storages!(list, Layout::BlockPlanes, "block_planes", 2, 256);
    for storage in [Storage::F32, Storage::F16] {
        let (task, layout) = (Task::Copy, Layout::DEFAULT);
        list.push(Rival { task, layout, storage, vertices: 0, workgroup: 0, spirv: &[] });
    }
    list
}

impl Rival {
    /// The name of its pass: task, storage and shape.
    #[must_use]
    pub fn name(&self) -> String {
        let Self { task, layout, storage, vertices, workgroup, .. } = self;
        match task {
            Task::Copy => format!("{task:?} {storage:?}"),
            _ => format!("{task:?} {storage:?} {layout:?} {vertices} x {workgroup}"),
        }
    }

    /// Whether this is the shape the pass uses.
    #[must_use]
    pub fn is_default(&self) -> bool {
        self.task == Task::Colour
            && self.layout == Layout::DEFAULT
            && self.vertices == 2
            && self.workgroup == 64
    }

    /// Bytes it reads and writes for `vertices` vertices.
    #[must_use]
    pub fn bytes(&self, vertices: u32) -> u64 {
        u64::from(vertices) * (4 * self.layout.words(ORDER, self.storage) as u64 + 16)
    }

    /// Adds one pass that runs this rival over `vertices` vertices of made-up transfer to a graph; a host times it.
    ///
    /// # Errors
    /// [`RelightError::Gpu`].
    pub fn add(
        &self,
        context: &Context,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        vertices: u32,
    ) -> Result<(), RelightError> {
        let stride = vertices.next_multiple_of(VERTEX_ALIGNMENT);
        let vectors: Vec<f32> =
            (0..vertices as usize * ORDER * ORDER).map(|i| (i % 1021) as f32 / 1021.0 - 0.5).collect();
        let packed = self.layout.pack(ORDER, self.storage, stride as usize, &vectors);
        let handle = on_device(context, graph, imports, &packed)?;
        if self.task == Task::Copy {
            let half = self.bytes(vertices) / 2;
            let mut pass = graph.pass(&self.name(), PassKind::Transfer);
            pass.side_effect().read(&handle, Access::TransferSource);
            let copy = pass.create_buffer("rival copy", BufferDesc::new(half), Access::TransferDestination);
            pass.record(Box::new(move |recorder, resources| {
                recorder.copy_buffer(resources.buffer(&handle)?.slice(0, half)?, resources.buffer(&copy)?)
            }));
            return Ok(());
        }
        let light = uniform(context, "rival light", &[[0.5f32, 0.25, 1.0, 0.0]; ORDER * ORDER])?;
        let pipeline = self.pipeline(context)?;
        let mut pass = graph.pass(&self.name(), PassKind::Compute);
        pass.side_effect().read(&handle, READ);
        let size = 16 * u64::from(vertices);
        let results = pass.create_buffer("rival colours", BufferDesc::new(size), Access::ComputeStorageWrite);
        let constants = ChunkConstants { vertex_count: vertices, stride, first_row: 0 };
        let (groups, colour) = (vertices.div_ceil(self.vertices * self.workgroup), self.task == Task::Colour);
        pass.record(Box::new(move |recorder, resources| {
            let transfer = Binding::storage(0, resources.buffer(&handle)?);
            let results = resources.buffer(&results)?;
            match colour {
                true => {
                    let light = Binding::uniform(1, &light);
                    recorder.bind_compute(&pipeline, &[transfer, light, Binding::storage(2, results)])?;
                }
                false => recorder.bind_compute(&pipeline, &[transfer, Binding::storage(1, results)])?,
            }
            recorder.push_constants(&constants)?;
            recorder.dispatch([groups, 1, 1])
        }));
        Ok(())
    }

    /// Its module, little-endian words as bytes; empty for a copy.
    #[must_use]
    pub fn spirv(&self) -> &'static [u8] {
        self.spirv
    }

    /// The bindings of its module.
    #[must_use]
    pub fn bindings(&self) -> Vec<BindingDesc> {
        let storage = |binding| BindingDesc::new(binding, BindingKind::StorageBuffer);
        match self.task {
            Task::Colour => vec![storage(0), BindingDesc::new(1, BindingKind::UniformBuffer), storage(2)],
            Task::Move => vec![storage(0), storage(1)],
            Task::Copy => Vec::new(),
        }
    }

    fn pipeline(&self, context: &Context) -> Result<airglow_gpu::ComputePipeline, RelightError> {
        Ok(context.create_compute_pipeline(&ComputePipelineDesc {
            name: &self.name(),
            spirv: &words(self.spirv),
            bindings: &self.bindings(),
            push_constant_size: size_of::<ChunkConstants>() as u32,
        })?)
    }
}

const READ: Access = Access::ComputeStorageRead;

/// Transfer in device memory, as the pass keeps it: a pass of its own copies it there when it is first recorded.
fn on_device(
    context: &Context,
    graph: &mut Graph<Record>,
    imports: &mut Imports,
    packed: &[u32],
) -> Result<Handle<airglow_graph::Buffer>, RelightError> {
    let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::TRANSFER_SRC;
    let resident = Resident::with_usage(context, "rival transfer", packed, usage)?;
    let handle = graph.import_buffer("rival transfer", *resident.buffer().desc(), READ, READ);
    imports.buffer(&handle, resident.buffer());
    let mut pass = graph.pass("relight uploads", PassKind::Transfer);
    let handle = pass.write(handle, Access::TransferDestination);
    pass.record(Box::new(move |recorder, _| resident.upload().map_or(Ok(()), |copy| copy.record(recorder))));
    Ok(handle)
}

/// A uniform buffer written once from the CPU.
fn uniform<T: Pod>(context: &Context, name: &str, values: &[T]) -> Result<Buffer, RelightError> {
    let desc = BufferDesc { size: size_of_val(values) as u64, usage: BufferUsageFlags::UNIFORM_BUFFER };
    let buffer = context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
    buffer.write(0, values)?;
    Ok(buffer)
}
