//! Another room every frame, with other settings or another size, while the one before is still on the device: nobody waits
//! for it.

use super::host::{Host, of};
use super::roads::{by_graph, fill, read_back};
use super::{HostDevice, Outputs, Refusal, Road, Room};
use airglow_gpu::ash::vk;
use airglow_gpu::{Context, Execution, Options, Readback, Recorder, Requirements};

/// Frames in flight.
const IN_FLIGHT: usize = 2;
/// Frames for each way to make the room.
const ROUNDS: usize = 2;

/// How a room is made: the settings of a frame.
pub type Make<'a, R> = &'a dyn Fn(&Context) -> Result<R, Refusal>;

/// Changes the room with every frame, in the order of `makes`, over and over: plan, transients and room of a frame are
/// dropped as soon as it is submitted, and the next is recorded without waiting. Each must give its own bits.
///
/// # Safety
/// As [`conform_on`](crate::conform_on).
///
/// # Errors
/// What the room or the device refuses; a frame with other bits than the room has alone; what stays alive.
pub unsafe fn change_on<R: Room>(
    host: &HostDevice<'_>,
    requirements: &Requirements,
    makes: &[Make<'_, R>],
) -> Result<(), Refusal> {
    let requirements = Requirements::engine().and(requirements);
    // SAFETY: the caller's promise is ours.
    let host = unsafe { Host::new(host)? };
    let alone = makes.iter().map(|make| {
        let run = host.run(|context, _| make(context), &requirements, &Options::default(), Road::Graph);
        run.map(|(outputs, _)| outputs)
    });
    let alone = alone.collect::<Result<Vec<_>, _>>()?;
    let changed = host.change(&requirements, makes)?;
    let differs = |frame: &usize| changed[*frame] != alone[frame % makes.len()];
    match (0..changed.len()).find(differs) {
        Some(frame) => Err(format!("frame {frame} has other bits than its room alone").into()),
        None => Ok(()),
    }
}

impl Host<'_> {
    fn change<R: Room>(
        &self,
        requirements: &Requirements,
        makes: &[Make<'_, R>],
    ) -> Result<Vec<Outputs>, Refusal> {
        let shim = self.watch();
        let mut held = Vec::new();
        let context = self.adopt(&shim, requirements, &Options::default(), IN_FLIGHT as u32)?;
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .command_buffer_count((ROUNDS * makes.len()) as u32);
        // SAFETY: the pool is this host's; what is allocated goes with it.
        let commands = unsafe { self.device.allocate_command_buffers(&info) };
        let commands = commands.map_err(of("command buffers"))?;
        let mut fences = Vec::new();
        let mut copies: Vec<Vec<Readback>> = Vec::new();
        for (frame, commands) in commands.into_iter().enumerate() {
            if let Some(past) = frame.checked_sub(IN_FLIGHT) {
                // SAFETY: a fence of this device that was submitted.
                unsafe { self.device.wait_for_fences(&[fences[past]], true, u64::MAX) }
                    .map_err(of("the end of a frame"))?;
            }
            // SAFETY: frames count up, and the one that had this slot is done.
            unsafe { context.begin_frame(context.frame() + 1)? };
            let mut room = makes[frame % makes.len()](&context)?;
            let resources = room.resources();
            let given = self.give(&context, &resources, &mut held)?;
            let begin = vk::CommandBufferBeginInfo::default();
            // SAFETY: a new command buffer, which is submitted once, in this frame.
            unsafe {
                self.device.begin_command_buffer(commands, &begin).map_err(of("recording"))?;
                let mut recorder = Recorder::new(&context, commands);
                for (resource, given) in resources.iter().zip(&given) {
                    fill(&mut recorder, resource, given, resource.entry)?;
                }
                let rooms = [(&mut room, &*resources, &*given)];
                let execution = by_graph(rooms, &mut recorder, &Default::default(), Execution::prepare)?;
                copies.push(read_back(&mut recorder, &resources, &given)?);
                fences.push(self.submit(commands)?);
                drop((execution, given));
            }
        }
        // SAFETY: the device is this host's; then nothing of it is in use.
        unsafe {
            self.device.wait_for_fences(&fences, true, u64::MAX).map_err(of("the end of a frame"))?;
            fences.iter().for_each(|fence| self.device.destroy_fence(*fence, None));
        }
        let bytes =
            |copies: &Vec<Readback>| copies.iter().map(Readback::read::<u8>).collect::<Result<_, _>>();
        let outputs = copies.iter().map(bytes).collect::<Result<_, _>>()?;
        drop((copies, context));
        match shim.alive() {
            alive if alive.is_empty() => Ok(outputs),
            alive => Err(format!("left alive: {alive:?}").into()),
        }
    }

    /// # Safety
    /// The command buffer is recording, and of this host.
    unsafe fn submit(&self, commands: vk::CommandBuffer) -> Result<vk::Fence, Refusal> {
        // SAFETY: handles of this host; the fence is new.
        unsafe {
            self.device.end_command_buffer(commands).map_err(of("a complete command buffer"))?;
            let fence = self.device.create_fence(&Default::default(), None).map_err(of("a fence"))?;
            let commands = [commands];
            let info = vk::SubmitInfo::default().command_buffers(&commands);
            let submitted = self.device.queue_submit(self.stated.queue, &[info], fence);
            submitted.map_err(of("submission"))?;
            Ok(fence)
        }
    }
}
