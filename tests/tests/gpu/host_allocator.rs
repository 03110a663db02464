//! A host's own allocator: it is used for everything, and when it runs out at any allocation, nothing leaks.

use airglow_gpu::ash::{self, vk};
use airglow_gpu::{
    AdoptInfo, Allocation, Allocator, Context, GpuError, Label, Location, Readback, Request, Requirements,
};
use airglow_graph::{BufferDesc, ImageDesc, State};
use airglow_tests::device::open;
use std::ptr::NonNull;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// One memory object for each request, from a device whose memory type 0 will do, until `left` runs out.
struct Dedicated {
    device: ash::Device,
    live: Arc<AtomicU64>,
    left: u64,
}

// SAFETY: each allocation is a memory object of its own, of the first type allowed, mapped as a whole. The devices the
// test runs on have one memory type, which is visible to the host and coherent; another makes the test fail.
unsafe impl Allocator for Dedicated {
    fn allocate(&mut self, request: &Request<'_>) -> Result<Allocation, String> {
        self.left = self.left.checked_sub(1).ok_or("the host has no more")?;
        let requirements = request.requirements;
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(requirements.size)
            .memory_type_index(requirements.memory_type_bits.trailing_zeros());
        // SAFETY: a live device; the memory is unmapped by being freed.
        unsafe {
            let memory = self.device.allocate_memory(&info, None).map_err(|error| error.to_string())?;
            let mapped = self
                .device
                .map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())
                .map_err(|error| error.to_string())?;
            self.live.fetch_add(1, Ordering::Relaxed);
            Ok(Allocation {
                memory,
                offset: 0,
                size: requirements.size,
                mapped: NonNull::new(mapped),
                token: 0,
            })
        }
    }

    fn free(&mut self, allocation: Allocation) {
        self.live.fetch_sub(1, Ordering::Relaxed);
        // SAFETY: the library gives back what it was given, once, and no longer uses it.
        unsafe { self.device.free_memory(allocation.memory, None) };
    }
}

/// Uploads, an image, a storage buffer and a readback: one allocation of each kind.
fn work(device: &airglow_gpu::open::OpenDevice, context: &Context) -> Result<Readback, GpuError> {
    let usage = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
    let buffer = context.create_buffer(
        Label::new("test", "buffer"),
        &BufferDesc { size: 64, usage },
        Location::Device,
    )?;
    let usage = vk::ImageUsageFlags::TRANSFER_DST;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(4, 1, vk::Format::R32G32B32A32_SFLOAT) };
    let image = context.create_image(Label::new("test", "image"), &desc)?;
    device.run(context, |recorder| {
        use airglow_graph::Access::{TransferDestination, TransferSource};
        let values: [f32; 16] = std::array::from_fn(|i| i as f32);
        let source = recorder.upload(&values)?;
        recorder.transition(&image, State::UNDEFINED, TransferDestination)?;
        recorder.copy_buffer_to_image(&source, &image.full_view()?)?;
        recorder.copy_buffer(&source, &buffer)?;
        recorder.memory_barrier(TransferDestination, TransferSource)?;
        recorder.read_back_buffer(&buffer)
    })
}

#[test]
fn a_hosts_allocator_is_used_and_may_run_out_anywhere() {
    let device = open(&Requirements::engine());
    // SAFETY: handles of the open device.
    let memory = unsafe { device.instance().get_physical_device_memory_properties(device.physical_device()) };
    if memory.memory_type_count != 1 {
        println!("not run: {} has several memory types, this allocator knows one", device.line());
        return;
    }
    let live = Arc::new(AtomicU64::new(0));
    let mut failures = 0;
    for left in 0.. {
        let host = Dedicated { device: device.device().clone(), live: Arc::clone(&live), left };
        let mut extensions = Vec::new();
        let info = AdoptInfo { allocator: Some(Box::new(host)), ..device.adopt_info(&mut extensions, 2) };
        // SAFETY: handles of the open device; everything is dropped before it, after `work` has waited.
        let context = unsafe { Context::adopt(info) }.unwrap();
        let result = work(&device, &context);
        match result {
            Ok(copy) => {
                let expected: [f32; 16] = std::array::from_fn(|i| i as f32);
                assert_eq!(copy.read::<f32>().unwrap(), expected);
                assert!(live.load(Ordering::Relaxed) >= 2, "the copy and the frame's uploads are alive");
                drop(copy);
                drop(context);
                break;
            }
            Err(error) => {
                assert!(matches!(error, GpuError::Memory { .. }), "{error}");
                assert!(error.to_string().contains("the host has no more"), "{error}");
                failures += 1;
            }
        }
        drop(context);
        assert_eq!(live.load(Ordering::Relaxed), 0, "after running out at allocation {left}");
    }
    assert_eq!(failures, 4, "each of the four allocations failed in turn");
    assert_eq!(live.load(Ordering::Relaxed), 0);
    let messages = device.messages();
    drop(device);
    let messages = messages.take();
    assert!(messages.is_empty(), "something is left on the device: {messages:?}");
}
