//! The host: its memory and its submission, on a device that is given.

use super::roads::{by_graph, by_record, fill, read_back};
use super::{Content, Given, HostResource, Outputs, Refusal, Road, Room, layout_after};
use crate::shim::{Call, Shim};
use airglow_gpu::ash::{self, vk};
use airglow_gpu::{AdoptInfo, Context, FeatureSet, Label, Options, Readback, Recorder, Requirements};

/// A host on a device.
pub(super) struct Host<'a> {
    stated: HostDevice<'a>,
    device: ash::Device,
    pool: vk::CommandPool,
}

/// A host's device as it states it.
#[derive(Clone, Copy)]
pub struct HostDevice<'a> {
    /// The loader's function.
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    /// The device's function; a room gets one with the kit listening behind it.
    pub get_device_proc_addr: vk::PFN_vkGetDeviceProcAddr,
    /// The instance.
    pub instance: vk::Instance,
    /// API version of the instance.
    pub api_version: u32,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: vk::Device,
    /// Family of the queue that commands are submitted to.
    pub queue_family: u32,
    /// The queue: it does graphics, compute and transfer.
    pub queue: vk::Queue,
    /// Features enabled.
    pub features: FeatureSet,
    /// Extensions enabled.
    pub extensions: &'a [&'a str],
}

/// A resource that the host made, with its memory.
struct Made {
    given: Given,
    memory: vk::DeviceMemory,
}

/// The same without what the library knows of it.
enum Raw {
    Image(vk::Image),
    Buffer(vk::Buffer),
}

/// What the host asked its device for, beside the device's answer.
fn of(what: &'static str) -> impl Fn(vk::Result) -> Refusal {
    move |result| format!("the host asked for {what}: {result}").into()
}

impl Made {
    fn into_own(self) -> (Raw, vk::DeviceMemory) {
        let raw = match self.given {
            Given::Image(image) => Raw::Image(image.raw()),
            Given::Buffer(buffer) => Raw::Buffer(buffer.raw()),
        };
        (raw, self.memory)
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

    /// Runs one frame of the room; returns the bytes of the host's buffers and the room's commands.
    pub(super) fn run<R: Room>(
        &self,
        make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
        requirements: &Requirements,
        options: &Options,
        road: Road,
    ) -> Result<(Outputs, Vec<Call>), Refusal> {
        // SAFETY: `Self::new` was given live handles with their own functions.
        let shim = unsafe { Shim::watching(&self.stated) };
        let host = HostDevice { get_device_proc_addr: shim.get_device_proc_addr(), ..self.stated };
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
            frames_in_flight: 1,
            options: options.clone(),
        };
        // SAFETY: handles of this host; all that is made from the context is dropped below, after waiting.
        let context = unsafe { Context::adopt(info) }?;
        let mut room = make(&context, &host)?;
        let resources = room.resources();
        let made = resources.iter().map(|resource| self.make(&context, resource));
        let made = made.collect::<Result<Vec<_>, _>>()?;
        let given: Vec<_> = made.iter().map(|made| made.given.clone()).collect();
        let (mut calls, mut execution) = (Vec::new(), None);
        let outputs = self.frame(&context, |recorder| {
            for (resource, given) in resources.iter().zip(&given) {
                fill(recorder, resource, given, resource.entry)?;
            }
            shim.take_calls();
            match road {
                Road::Graph => execution = Some(by_graph(&mut room, recorder, &resources, &given)?),
                Road::Record => by_record(&mut room, recorder, &resources, &given, &shim, &mut calls)?,
            }
            if road == Road::Graph {
                calls = shim.take_calls();
                for (resource, given) in resources.iter().zip(&given) {
                    let Given::Image(image) = given else { continue };
                    let layout = layout_after(&calls, image.raw(), resource.entry.layout)?;
                    if layout != resource.exit.layout {
                        let (name, promised) = (resource.name, resource.exit.layout);
                        return Err(format!("{name}: {layout:?} on exit, {promised:?} promised").into());
                    }
                }
            }
            Ok(read_back(recorder, &resources, &given)?)
        });
        let own: Vec<_> = made.into_iter().map(Made::into_own).collect();
        drop((execution, room, given, context));
        own.into_iter().for_each(|own| self.destroy(own));
        let outputs = outputs?;
        match shim.alive() {
            alive if alive.is_empty() => Ok((outputs, calls)),
            alive => Err(format!("{road:?} left alive: {alive:?}").into()),
        }
    }

    /// Records, submits and waits; what was read back.
    fn frame(
        &self,
        context: &Context,
        record: impl FnOnce(&mut Recorder<'_>) -> Result<Vec<Readback>, Refusal>,
    ) -> Result<Outputs, Refusal> {
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        // SAFETY: handles of this host; the command buffer is recorded, submitted once and waited for here.
        let copies = unsafe {
            let commands = self.device.allocate_command_buffers(&info).map_err(of("a command buffer"))?;
            let begun = self.device.begin_command_buffer(commands[0], &Default::default());
            begun.map_err(of("recording"))?;
            let copies = record(&mut Recorder::new(context, commands[0]))?;
            self.device.end_command_buffer(commands[0]).map_err(of("a complete command buffer"))?;
            let submit = vk::SubmitInfo::default().command_buffers(&commands);
            let submitted = self.device.queue_submit(self.stated.queue, &[submit], vk::Fence::null());
            submitted.map_err(of("submission"))?;
            self.device.queue_wait_idle(self.stated.queue).map_err(of("the frame's end"))?;
            copies
        };
        Ok(copies.iter().map(|copy| copy.read::<u8>()).collect::<Result<_, _>>()?)
    }

    /// Makes a resource with memory of its own.
    fn make(&self, context: &Context, resource: &HostResource) -> Result<Made, Refusal> {
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
                    Ok(Made { given: Given::Image(context.import_image(raw, label, desc)), memory })
                }
                Content::Buffer(desc, _) => {
                    let info = vk::BufferCreateInfo::default().size(desc.size).usage(desc.usage);
                    let raw = self.device.create_buffer(&info, None).map_err(of("a buffer"))?;
                    let memory = allocate(self.device.get_buffer_memory_requirements(raw))?;
                    self.device.bind_buffer_memory(raw, memory, 0).map_err(of("bound memory"))?;
                    Ok(Made { given: Given::Buffer(context.import_buffer(raw, label, desc)), memory })
                }
            }
        }
    }

    fn destroy(&self, (raw, memory): (Raw, vk::DeviceMemory)) {
        // SAFETY: the device is idle, and nothing of the library refers to the resource any more.
        unsafe {
            match raw {
                Raw::Image(image) => self.device.destroy_image(image, None),
                Raw::Buffer(buffer) => self.device.destroy_buffer(buffer, None),
            }
            self.device.free_memory(memory, None);
        }
    }
}

impl Drop for Host<'_> {
    fn drop(&mut self) {
        // SAFETY: what was submitted was waited for, or never came to it.
        unsafe { self.device.destroy_command_pool(self.pool, None) };
    }
}
