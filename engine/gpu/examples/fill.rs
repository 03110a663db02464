//! The whole road in one page: open a device, adopt it as an engine would, declare, compile, record, submit, read back.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::open::{OpenDevice, OpenOptions};
use airglow_gpu::{Execution, Imports, Label, Location, Record, Requirements};
use airglow_graph::{Access, BufferDesc, Graph, PassKind, State};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let device = OpenDevice::open(&OpenOptions::new(&Requirements::engine()))?;
    println!("{}", device.line());
    // SAFETY: the context and all that is made from it are dropped before the device; `run` waits.
    let context = unsafe { device.adopt(2)? };

    let usage = BufferUsageFlags::TRANSFER_DST | BufferUsageFlags::TRANSFER_SRC;
    let desc = BufferDesc { size: 64, usage };
    let buffer = context.create_buffer(Label::new("host", "numbers"), &desc, Location::Device)?;

    let mut graph: Graph<Record> = Graph::new();
    let numbers = graph.import_buffer("numbers", desc, State::UNDEFINED, Access::TransferSource);
    let mut pass = graph.pass("fill", PassKind::Transfer);
    let filled = pass.write(numbers, Access::TransferDestination);
    pass.record(Box::new(move |recorder, resources| recorder.fill(resources.buffer(&filled)?, 42)));
    let plan = graph.compile(&context.graph_limits())?;
    println!("{}", plan.text());

    let mut execution = Execution::prepare(&context, plan)?;
    let mut imports = Imports::new();
    imports.buffer(&numbers, &buffer);
    let copy = device.run(&context, |recorder| {
        // SAFETY: a recording command buffer of this frame; the buffer is in its entry state.
        unsafe { execution.record(&context, recorder.command_buffer(), &imports, None)? };
        recorder.read_back_buffer(&buffer)
    })?;
    println!("{:?}", copy.read::<u32>()?);
    Ok(())
}
