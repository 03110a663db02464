//! The host: its memory and its submission, on a device that is given.

use super::elsewhere::check_families;
use super::roads::{Prepare, by_graph, by_record, fill, read_back};
use super::{Content, Given, HostResource, Outputs, Refusal, Road, Room, check_layouts};
use crate::device::HostDevice;
use crate::shim::{Call, Shim};
use airglow_gpu::ash::{self, vk};
use airglow_gpu::{AdoptInfo, Context, Execution, Label, Options, Readback, Recorder, Requirements};

/// A host on a device.
pub(super) struct Host<'a> {
    pub(super) stated: HostDevice<'a>,
    pub(super) device: ash::Device,
    pub(super) pool: vk::CommandPool,
}

/// What the host made, with its memory; destroyed with it.
pub(super) struct Held<'a> {
    device: &'a ash::Device,
    raw: Raw,
    memory: vk::DeviceMemory,
}

/// The same without what the library knows of it.
enum Raw {
    Image(vk::Image),
    Buffer(vk::Buffer),
}

/// What the host asked its device for, beside the device's answer.
pub(super) fn of(what: &'static str) -> impl Fn(vk::Result) -> Refusal {
    move |result| format!("the host asked for {what}: {result}").into()
}

impl Drop for Held<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is idle, and nothing of the library refers to the resource any more: whoever holds this
        // made it before the context.
        unsafe {
            match self.raw {
                Raw::Image(image) => self.device.destroy_image(image, None),
                Raw::Buffer(buffer) => self.device.destroy_buffer(buffer, None),
            }
            self.device.free_memory(self.memory, None);
        }
    }
}

impl<'a> Host<'a> {
    /// Loads the device's functions and makes a command pool.
    ///
    /// # Safety
    /// `stated` is true, and its device outlives this.
    pub(super) unsafe fn new(stated: &HostDevice<'a>) -> Result<Self, Refusal> {
        // SAFETY: the caller vouches for the functions and the handles; names end in a nul.
        unsafe {
            let get = |name: &std::ffi::CStr| (stated.get_device_proc_addr)(stated.device, name.as_ptr());
            let load =
                |name: &std::ffi::CStr| std::mem::transmute::<vk::PFN_vkVoidFunction, *const _>(get(name));
            let device = ash::Device::load_with(load, stated.device);
            let info = vk::CommandPoolCreateInfo::default().queue_family_index(stated.queue_family);
            let pool = device.create_command_pool(&info, None).map_err(of("a command pool"))?;
            Ok(Self { stated: *stated, device, pool })
        }
    }

    /// A watch over the device.
    pub(super) fn watch(&self) -> Shim {
        // SAFETY: `Self::new` was given live handles with their own functions.
        unsafe { Shim::watching(&self.stated) }
    }

    /// The device as a room is told of it, with `shim` listening.
    pub(super) fn told(&self, shim: &Shim) -> HostDevice<'a> {
        HostDevice {
            get_device_proc_addr: shim.get_device_proc_addr(),
            get_instance_proc_addr: shim.get_instance_proc_addr(),
            ..self.stated
        }
    }

    /// A context on the device, with `shim` listening.
    pub(super) fn adopt(
        &self,
        shim: &Shim,
        requirements: &Requirements,
        options: &Options,
        frames_in_flight: u32,
    ) -> Result<Context, Refusal> {
        let host = self.told(shim);
        let info = AdoptInfo {
            get_instance_proc_addr: host.get_instance_proc_addr,
            get_device_proc_addr: Some(host.get_device_proc_addr),
            instance: host.instance,
            api_version: host.api_version,
            physical_device: host.physical_device,
            device: host.device,
            queue_family: host.queue_family,
            features: host.features,
            extensions: host.extensions,
            requirements,
            allocator: None,
            pipeline_cache: vk::PipelineCache::null(),
            frames_in_flight,
            options: options.clone(),
        };
        // SAFETY: handles of this host; whoever adopts drops the context when the device is idle.
        Ok(unsafe { Context::adopt(info) }?)
    }

    /// Runs one frame of the room; returns the bytes of the host's buffers and the room's commands.
    pub(super) fn run<R: Room>(
        &self,
        make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
        requirements: &Requirements,
        options: &Options,
        road: Road,
    ) -> Result<(Outputs, Vec<Call>), Refusal> {
        self.run_under(&self.watch(), make, requirements, options, road)
    }

    /// The same under a watch.
    pub(super) fn run_under<R: Room>(
        &self,
        shim: &Shim,
        make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
        requirements: &Requirements,
        options: &Options,
        road: Road,
    ) -> Result<(Outputs, Vec<Call>), Refusal> {
        let adopt = || self.adopt(shim, requirements, options, 1);
        let done = self.frame_of(shim, adopt, make, (road, Execution::prepare), true)?;
        match shim.alive() {
            alive if alive.is_empty() => Ok(done),
            alive => Err(format!("{road:?} left alive: {alive:?}").into()),
        }
    }

    /// Records one frame of the room, and submits it where it is asked to. All that was made is gone afterwards.
    pub(super) fn frame_of<R: Room>(
        &self,
        shim: &Shim,
        adopt: impl Fn() -> Result<Context, Refusal>,
        make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
        (road, prepare): (Road, Prepare),
        submit: bool,
    ) -> Result<(Outputs, Vec<Call>), Refusal> {
        let mut held = Vec::new();
        let context = adopt()?;
        let room = make(&context, &self.told(shim))?;
        self.frame_in(&context, shim, room, (road, prepare, submit), &mut held)
    }

    /// Records one frame of a room that was made in `context`; what the host made for it goes to `held`.
    pub(super) fn frame_in<'h, R: Room>(
        &'h self,
        context: &Context,
        shim: &Shim,
        mut room: R,
        (road, prepare, submit): (Road, Prepare, bool),
        held: &mut Vec<Held<'h>>,
    ) -> Result<(Outputs, Vec<Call>), Refusal> {
        let resources = room.resources();
        let given = self.give(context, &resources, held)?;
        let (mut calls, mut execution) = (Vec::new(), None);
        let outputs = self.frame(context, submit, |recorder| {
            for (resource, given) in resources.iter().zip(&given) {
                fill(recorder, resource, given, resource.entry)?;
            }
            shim.take_calls();
            match road {
                Road::Graph => {
                    let rooms = [(&mut room, &*resources, &*given)];
                    execution = Some(by_graph(rooms, recorder, &Default::default(), prepare)?);
                    calls = shim.take_calls();
                    check_layouts(&calls, &resources, &given)?;
                }
                Road::Record => by_record(&mut room, recorder, &resources, &given, shim, &mut calls)?,
            }
            check_families(&calls, &resources, &given, self.stated.queue_family, road)?;
            Ok(read_back(recorder, &resources, &given)?)
        })?;
        Ok((outputs, calls))
    }

    /// Makes what a room uses of the host's.
    pub(super) fn give<'h>(
        &'h self,
        context: &Context,
        resources: &[HostResource],
        held: &mut Vec<Held<'h>>,
    ) -> Result<Vec<Given>, Refusal> {
        let made = resources.iter().map(|resource| {
            let (given, own) = self.make(context, resource)?;
            held.push(own);
            Ok(given)
        });
        made.collect()
    }

    /// Records; submits and waits where it is asked to. What was read back.
    pub(super) fn frame(
        &self,
        context: &Context,
        submit: bool,
        record: impl FnOnce(&mut Recorder<'_>) -> Result<Vec<Readback>, Refusal>,
    ) -> Result<Outputs, Refusal> {
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        // SAFETY: handles of this host; the command buffer is submitted at most once and waited for, then freed.
        unsafe {
            let commands = self.device.allocate_command_buffers(&info).map_err(of("a command buffer"))?;
            let recorded = self.record(context, commands[0], submit, record);
            self.device.free_command_buffers(self.pool, &commands);
            recorded
        }
    }

    /// # Safety
    /// The command buffer is of this host's pool, and new.
    unsafe fn record(
        &self,
        context: &Context,
        commands: vk::CommandBuffer,
        submit: bool,
        record: impl FnOnce(&mut Recorder<'_>) -> Result<Vec<Readback>, Refusal>,
    ) -> Result<Outputs, Refusal> {
        // SAFETY: handles of this host; the caller vouches for the command buffer, which is submitted once, here.
        let copies = unsafe {
            self.device.begin_command_buffer(commands, &Default::default()).map_err(of("recording"))?;
            let copies = record(&mut Recorder::new(context, commands))?;
            self.device.end_command_buffer(commands).map_err(of("a complete command buffer"))?;
            if !submit {
                return Ok(Outputs::new());
            }
            let commands = [commands];
            let info = vk::SubmitInfo::default().command_buffers(&commands);
            let submitted = self.device.queue_submit(self.stated.queue, &[info], vk::Fence::null());
            submitted.map_err(of("submission"))?;
            self.device.queue_wait_idle(self.stated.queue).map_err(of("the frame's end"))?;
            copies
        };
        Ok(copies.iter().map(|copy| copy.read::<u8>()).collect::<Result<_, _>>()?)
    }

    /// Makes a resource with memory of its own.
    fn make(&self, context: &Context, resource: &HostResource) -> Result<(Given, Held<'_>), Refusal> {
        let label = Label::new("host", resource.name);
        let allocate = |requirements: vk::MemoryRequirements| {
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(requirements.size)
                .memory_type_index(requirements.memory_type_bits.trailing_zeros());
            // SAFETY: a live device and an allowed memory type.
            unsafe { self.device.allocate_memory(&info, None) }.map_err(of("memory"))
        };
        // SAFETY: a live device and complete descriptions; what is imported is destroyed after the context's clones.
        unsafe {
            match &resource.content {
                Content::Image(desc, _) => {
                    let info = vk::ImageCreateInfo::default()
                        .image_type(vk::ImageType::TYPE_2D)
                        .format(desc.format)
                        .extent(vk::Extent3D { width: desc.extent[0], height: desc.extent[1], depth: 1 })
                        .mip_levels(desc.mips)
                        .array_layers(desc.layers)
                        .samples(desc.samples)
                        .usage(desc.usage);
                    let raw = self.device.create_image(&info, None).map_err(of("an image"))?;
                    let memory = allocate(self.device.get_image_memory_requirements(raw))?;
                    self.device.bind_image_memory(raw, memory, 0).map_err(of("bound memory"))?;
                    let held = Held { device: &self.device, raw: Raw::Image(raw), memory };
                    Ok((Given::Image(context.import_image(raw, label, desc)), held))
                }
                Content::Buffer(desc, _) => {
                    let info = vk::BufferCreateInfo::default().size(desc.size).usage(desc.usage);
                    let raw = self.device.create_buffer(&info, None).map_err(of("a buffer"))?;
                    let memory = allocate(self.device.get_buffer_memory_requirements(raw))?;
                    self.device.bind_buffer_memory(raw, memory, 0).map_err(of("bound memory"))?;
                    let held = Held { device: &self.device, raw: Raw::Buffer(raw), memory };
                    Ok((Given::Buffer(context.import_buffer(raw, label, desc)), held))
                }
            }
        }
    }
}

impl Drop for Host<'_> {
    fn drop(&mut self) {
        // SAFETY: what was submitted was waited for, or never came to it.
        unsafe { self.device.destroy_command_pool(self.pool, None) };
    }
}
