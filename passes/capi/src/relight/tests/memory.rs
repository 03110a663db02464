//! Memory that the host gives, and what it gets back.

use std::ffi::c_void;
use std::ptr::null_mut;

use airglow_gpu::ash::vk::{self, Handle};

use super::{adopt_info, call, refused, requirements, settings, text, with_host};
use crate::allocator::{AirglowAllocation, AirglowAllocator, AirglowMemoryRequest};
use crate::context::*;
use crate::relight::{airglow_relight_drop, airglow_relight_new};
use crate::requirements::airglow_requirements_drop;
use crate::status::AirglowStatus;

/// A host's memory: counts what is alive, and refuses after some.
struct Memory {
    device: airglow_gpu::ash::Device,
    alive: usize,
    left: usize,
}

unsafe extern "C" fn allocate(
    user: *mut c_void,
    request: *const AirglowMemoryRequest,
    given: *mut AirglowAllocation,
) -> i32 {
    // SAFETY: the library hands back what it was given, and a whole request.
    unsafe {
        let (memory, request) = (&mut *user.cast::<Memory>(), &*request);
        if memory.left == 0 {
            return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY.as_raw();
        }
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(request.size)
            .memory_type_index(request.memory_type_bits.trailing_zeros());
        let raw = memory.device.allocate_memory(&info, None).unwrap();
        // The software renderer's only type is mapped and coherent.
        let flags = vk::MemoryMapFlags::empty();
        let mapped = memory.device.map_memory(raw, 0, vk::WHOLE_SIZE, flags).unwrap();
        *given = AirglowAllocation { memory: raw.as_raw(), offset: 0, size: request.size, mapped, token: 7 };
        (memory.alive, memory.left) = (memory.alive + 1, memory.left - 1);
    }
    0
}

unsafe extern "C" fn free(user: *mut c_void, given: *const AirglowAllocation) {
    // SAFETY: the library hands back what it was given.
    unsafe {
        let (memory, given) = (&mut *user.cast::<Memory>(), &*given);
        assert_eq!(given.token, 7);
        memory.device.free_memory(vk::DeviceMemory::from_raw(given.memory), None);
        memory.alive -= 1;
    }
}

#[test]
fn the_host_gives_memory_or_none_and_gets_all_of_it_back() {
    with_host(|host| {
        let chosen = settings(0);
        // SAFETY: live handles and functions; null-terminated names.
        let device = unsafe {
            airglow_gpu::ash::Device::load_with(
                |name| std::mem::transmute((host.get_device_proc_addr)(host.device, name.as_ptr())),
                host.device,
            )
        };
        for left in 0..4 {
            let mut memory = Memory { device: device.clone(), alive: 0, left };
            let allocator = AirglowAllocator {
                struct_size: size_of::<AirglowAllocator>() as u32,
                reserved: 0,
                user: (&raw mut memory).cast(),
                allocate: Some(allocate),
                free: Some(free),
            };
            let asked = requirements(&chosen);
            let names =
                [c"synchronization2".as_ptr(), c"dynamicRendering".as_ptr(), c"noSuchFeature".as_ptr()];
            let info = AirglowAdoptInfo {
                requirements: asked,
                allocator: &raw const allocator,
                feature_names: names.as_ptr(),
                feature_count: 3,
                breadcrumbs: 1,
                ..adopt_info(host)
            };
            let (mut context, mut relight) = (null_mut(), null_mut());
            match left {
                0 => drop(refused!(OutOfMemory, airglow_context_adopt, &raw const info, &raw mut context)),
                _ => call!(airglow_context_adopt, &raw const info, &raw mut context),
            }
            if left > 0 {
                last_pass(context);
                match left {
                    1 => drop(refused!(
                        OutOfMemory,
                        airglow_relight_new,
                        context,
                        &raw const chosen,
                        &raw mut relight
                    )),
                    _ => call!(airglow_relight_new, context, &raw const chosen, &raw mut relight),
                }
                call!(airglow_context_begin_frame, context, 1);
                refused!(InvalidArgument, airglow_context_begin_frame, context, 1);
            }
            // SAFETY: they are not used again; nothing was submitted.
            unsafe {
                airglow_relight_drop(relight);
                airglow_context_drop(context);
                airglow_requirements_drop(asked);
            }
            assert_eq!(memory.alive, 0, "all memory came back");
        }
    });
}

/// Nothing was recorded, so no pass was reached.
fn last_pass(context: *const AirglowContext) {
    let mut reached = AirglowPassReached { reached: 9, finished: 9, frame: 9 };
    let target = &raw mut reached;
    let name = text(|name| call!(airglow_context_last_pass_reached, context, target, name));
    assert_eq!((reached.reached, name.as_str()), (0, ""));
}
