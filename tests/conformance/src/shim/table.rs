//! The functions that are watched, each with Vulkan's signature.

use super::{Call, count, failure, kept, memory, real, record};
use airglow_gpu::ash::vk;
use std::ffi::{CStr, c_void};

/// Functions that Vulkan allows to say that the device is lost, among those watched.
pub(super) const TELL_LOSS: &[&str] = &["vkGetQueryPoolResults"];

type Callbacks = *const vk::AllocationCallbacks<'static>;

/// A function as get-proc-addr returns it.
type Function = unsafe extern "system" fn();

/// Vulkan hands out all functions as one type; callers turn them back.
fn erased(function: *const c_void) -> Function {
    // SAFETY: the addresses are of functions; the type they are called by is their caller's to know.
    unsafe { std::mem::transmute::<*const c_void, Function>(function) }
}

/// The name as it stands here, and the function that watches; `None` for functions the library must not call.
pub(super) fn watched(name: &str) -> Option<(&'static str, Function)> {
    special(name).or_else(|| simple(name)).or_else(|| paired(name))
}

/// Every name, twice.
pub(super) fn names() -> impl Iterator<Item = (&'static str, &'static CStr)> {
    [SPECIAL, SIMPLE, PAIRED].into_iter().flatten().copied()
}

/// What one watched function does: `$kind` is how it is watched.
macro_rules! body {
    (command, $name:ident, $real:expr, ($($arg:ident),*), $numbers:expr) => {{
        record(Call { name: stringify!($name), numbers: $numbers, ..Call::default() });
        $real($($arg),*)
    }};
    (plain, $name:ident, $real:expr, ($($arg:ident),*), $numbers:expr) => {
        $real($($arg),*)
    };
    (fallible, $name:ident, $real:expr, ($($arg:ident),*), $numbers:expr) => {
        failure(stringify!($name)).unwrap_or_else(|| $real($($arg),*))
    };
    (needs, $name:ident, $real:expr, ($d:ident, $object:ident, $out:ident), $numbers:expr) => {{
        $real($d, $object, $out);
        // SAFETY: the caller has room for them, and they were just written.
        memory::requirements(unsafe { &mut *$out });
    }};
    (maps, $name:ident, $real:expr, ($d:ident, $memory:ident, $($arg:ident),*), $numbers:expr) => {
        match memory::maps($memory) {
            true => failure(stringify!($name)).unwrap_or_else(|| $real($d, $memory, $($arg),*)),
            false => vk::Result::ERROR_MEMORY_MAP_FAILED,
        }
    };
}

/// Functions by kind: `command` is recorded with its numbers, `fallible` may fail on demand, `plain` is passed on; `needs`
/// and `maps` are those that [`memory`] has a say in.
macro_rules! watched {
    ($($kind:ident $name:ident($($arg:ident: $ty:ty),*) $(-> $result:ty)? $([$($number:expr),*])?;)*) => {
        $(
            #[expect(non_snake_case, reason = "Vulkan's name")]
            unsafe extern "system" fn $name($($arg: $ty),*) $(-> $result)? {
                type True = unsafe extern "system" fn($($ty),*) $(-> $result)?;
                // SAFETY: the address is that of the true function, which has this signature.
                let function = unsafe { std::mem::transmute::<usize, True>(real(stringify!($name))) };
                // SAFETY: the caller's arguments are passed on.
                let call = |$($arg: $ty),*| unsafe { function($($arg),*) };
                body!($kind, $name, call, ($($arg),*), vec![$($($number as u32),*)?])
            }
        )*

        fn simple(name: &str) -> Option<(&'static str, Function)> {
            match name {
                $(stringify!($name) => Some((stringify!($name), erased($name as *const c_void))),)*
                _ => None,
            }
        }

        const SIMPLE: &[(&str, &CStr)] = &[$((stringify!($name), c_name(concat!(stringify!($name), "\0")))),*];
    };
}

const fn c_name(text: &str) -> &CStr {
    match CStr::from_bytes_with_nul(text.as_bytes()) {
        Ok(name) => name,
        Err(_) => c"",
    }
}

watched! {
    command vkCmdBeginQuery(c: vk::CommandBuffer, pool: vk::QueryPool, query: u32, flags: vk::QueryControlFlags);
    command vkCmdBeginRendering(c: vk::CommandBuffer, info: *const vk::RenderingInfo<'static>);
    command vkCmdBindDescriptorSets(c: vk::CommandBuffer, point: vk::PipelineBindPoint, layout: vk::PipelineLayout, first: u32, sets: u32, p: *const vk::DescriptorSet, offsets: u32, q: *const u32) [point.as_raw(), first, sets];
    command vkCmdBindIndexBuffer(c: vk::CommandBuffer, buffer: vk::Buffer, offset: u64, ty: vk::IndexType);
    command vkCmdBindPipeline(c: vk::CommandBuffer, point: vk::PipelineBindPoint, pipeline: vk::Pipeline) [point.as_raw()];
    command vkCmdBindVertexBuffers(c: vk::CommandBuffer, first: u32, n: u32, p: *const vk::Buffer, q: *const u64) [first, n];
    command vkCmdCopyBuffer(c: vk::CommandBuffer, a: vk::Buffer, b: vk::Buffer, n: u32, p: *const vk::BufferCopy);
    command vkCmdCopyBufferToImage(c: vk::CommandBuffer, a: vk::Buffer, b: vk::Image, l: vk::ImageLayout, n: u32, p: *const vk::BufferImageCopy);
    command vkCmdCopyImageToBuffer(c: vk::CommandBuffer, a: vk::Image, l: vk::ImageLayout, b: vk::Buffer, n: u32, p: *const vk::BufferImageCopy);
    command vkCmdDispatch(c: vk::CommandBuffer, x: u32, y: u32, z: u32);
    command vkCmdDispatchIndirect(c: vk::CommandBuffer, buffer: vk::Buffer, offset: u64);
    command vkCmdDraw(c: vk::CommandBuffer, v: u32, i: u32, fv: u32, fi: u32);
    command vkCmdDrawIndexed(c: vk::CommandBuffer, n: u32, i: u32, f: u32, o: i32, fi: u32);
    command vkCmdDrawIndexedIndirect(c: vk::CommandBuffer, buffer: vk::Buffer, offset: u64, n: u32, stride: u32);
    command vkCmdDrawIndirect(c: vk::CommandBuffer, buffer: vk::Buffer, offset: u64, n: u32, stride: u32);
    command vkCmdEndQuery(c: vk::CommandBuffer, pool: vk::QueryPool, query: u32);
    command vkCmdEndRendering(c: vk::CommandBuffer);
    command vkCmdFillBuffer(c: vk::CommandBuffer, buffer: vk::Buffer, offset: u64, size: u64, data: u32);
    command vkCmdPushConstants(c: vk::CommandBuffer, layout: vk::PipelineLayout, stages: vk::ShaderStageFlags, offset: u32, size: u32, p: *const c_void) [stages.as_raw(), offset, size];
    command vkCmdResetQueryPool(c: vk::CommandBuffer, pool: vk::QueryPool, first: u32, n: u32);
    command vkCmdSetScissor(c: vk::CommandBuffer, first: u32, n: u32, p: *const vk::Rect2D) [first, n];
    command vkCmdSetViewport(c: vk::CommandBuffer, first: u32, n: u32, p: *const vk::Viewport) [first, n];
    command vkCmdWriteTimestamp2(c: vk::CommandBuffer, stage: vk::PipelineStageFlags2, pool: vk::QueryPool, query: u32);
    command vkCmdBeginDebugUtilsLabelEXT(c: vk::CommandBuffer, label: *const vk::DebugUtilsLabelEXT<'static>);
    command vkCmdEndDebugUtilsLabelEXT(c: vk::CommandBuffer);
    plain vkSetDebugUtilsObjectNameEXT(d: vk::Device, info: *const vk::DebugUtilsObjectNameInfoEXT<'static>) -> vk::Result;
    fallible vkAllocateDescriptorSets(d: vk::Device, info: *const vk::DescriptorSetAllocateInfo<'static>, p: *mut vk::DescriptorSet) -> vk::Result;
    fallible vkBindBufferMemory(d: vk::Device, buffer: vk::Buffer, memory: vk::DeviceMemory, offset: u64) -> vk::Result;
    fallible vkBindImageMemory(d: vk::Device, image: vk::Image, memory: vk::DeviceMemory, offset: u64) -> vk::Result;
    fallible vkGetQueryPoolResults(d: vk::Device, pool: vk::QueryPool, first: u32, n: u32, size: usize, p: *mut c_void, stride: u64, flags: vk::QueryResultFlags) -> vk::Result;
    maps vkMapMemory(d: vk::Device, memory: vk::DeviceMemory, offset: u64, size: u64, flags: vk::MemoryMapFlags, p: *mut *mut c_void) -> vk::Result;
    plain vkGetCalibratedTimestampsEXT(d: vk::Device, n: u32, p: *const vk::CalibratedTimestampInfoKHR<'static>, q: *mut u64, r: *mut u64) -> vk::Result;
    needs vkGetBufferMemoryRequirements(d: vk::Device, buffer: vk::Buffer, p: *mut vk::MemoryRequirements);
    needs vkGetImageMemoryRequirements(d: vk::Device, image: vk::Image, p: *mut vk::MemoryRequirements);
    plain vkResetDescriptorPool(d: vk::Device, pool: vk::DescriptorPool, flags: vk::DescriptorPoolResetFlags) -> vk::Result;
    plain vkUnmapMemory(d: vk::Device, memory: vk::DeviceMemory);
    plain vkUpdateDescriptorSets(d: vk::Device, n: u32, p: *const vk::WriteDescriptorSet<'static>, m: u32, q: *const vk::CopyDescriptorSet<'static>);
}

/// What a device is truly asked for.
macro_rules! asked {
    ($info:ident) => {
        *$info
    };
    ($info:ident, $asked:expr) => {
        $asked($info)
    };
}

/// A function that makes an object, and the one that destroys it; objects alive are counted.
macro_rules! pairs {
    ($($make:ident($info:ty), $destroy:ident: $handle:ident $(, $note:expr $(, $asked:expr)?)?;)*) => {
        $(
            #[expect(non_snake_case, reason = "Vulkan's name")]
            unsafe extern "system" fn $make(d: vk::Device, info: *const $info, c: Callbacks, out: *mut vk::$handle) -> vk::Result {
                type True = unsafe extern "system" fn(vk::Device, *const $info, Callbacks, *mut vk::$handle) -> vk::Result;
                if let Some(result) = failure(stringify!($make)) {
                    return result;
                }
                // SAFETY: the library passes a complete description.
                let described = unsafe { &*info };
                let asked = asked!(described $($(, $asked)?)?);
                // SAFETY: the true function has this signature; the caller's arguments are passed on.
                let make = unsafe { std::mem::transmute::<usize, True>(real(stringify!($make))) };
                // SAFETY: as above.
                let result = unsafe { make(d, &raw const asked, c, out) };
                count(stringify!($handle), i64::from(result == vk::Result::SUCCESS));
                $(if result == vk::Result::SUCCESS {
                    // SAFETY: the object was just written.
                    unsafe { $note(described, *out) };
                })?
                result
            }
            #[expect(non_snake_case, reason = "Vulkan's name")]
            unsafe extern "system" fn $destroy(d: vk::Device, object: vk::$handle, c: Callbacks) {
                type True = unsafe extern "system" fn(vk::Device, vk::$handle, Callbacks);
                count(stringify!($handle), -i64::from(object != vk::$handle::null()));
                // SAFETY: as above.
                unsafe { std::mem::transmute::<usize, True>(real(stringify!($destroy)))(d, object, c) }
            }
        )*

        fn paired(name: &str) -> Option<(&'static str, Function)> {
            match name {
                $(
                    stringify!($make) => Some((stringify!($make), erased($make as *const c_void))),
                    stringify!($destroy) => Some((stringify!($destroy), erased($destroy as *const c_void))),
                )*
                _ => None,
            }
        }

        const PAIRED: &[(&str, &CStr)] = &[$(
            (stringify!($make), c_name(concat!(stringify!($make), "\0"))),
            (stringify!($destroy), c_name(concat!(stringify!($destroy), "\0"))),
        )*];
    };
}

pairs! {
    vkAllocateMemory(vk::MemoryAllocateInfo<'static>), vkFreeMemory: DeviceMemory, memory::note, memory::asked;
    vkCreateBuffer(vk::BufferCreateInfo<'static>), vkDestroyBuffer: Buffer;
    vkCreateDescriptorPool(vk::DescriptorPoolCreateInfo<'static>), vkDestroyDescriptorPool: DescriptorPool;
    vkCreateDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo<'static>), vkDestroyDescriptorSetLayout: DescriptorSetLayout;
    vkCreateImage(vk::ImageCreateInfo<'static>), vkDestroyImage: Image;
    vkCreateImageView(vk::ImageViewCreateInfo<'static>), vkDestroyImageView: ImageView;
    vkCreatePipelineLayout(vk::PipelineLayoutCreateInfo<'static>), vkDestroyPipelineLayout: PipelineLayout;
    vkCreateQueryPool(vk::QueryPoolCreateInfo<'static>), vkDestroyQueryPool: QueryPool;
    vkCreateSampler(vk::SamplerCreateInfo<'static>), vkDestroySampler: Sampler;
    vkCreateShaderModule(vk::ShaderModuleCreateInfo<'static>), vkDestroyShaderModule: ShaderModule, kept::note_module;
}

/// Makes pipelines, one at a time, or gives one that is kept.
macro_rules! pipelines {
    ($($make:ident($info:ty): $stages:expr;)*) => {
        $(
            #[expect(non_snake_case, reason = "Vulkan's name")]
            unsafe extern "system" fn $make(
                d: vk::Device,
                cache: vk::PipelineCache,
                n: u32,
                info: *const $info,
                c: Callbacks,
                out: *mut vk::Pipeline,
            ) -> vk::Result {
                type True = unsafe extern "system" fn(
                    vk::Device,
                    vk::PipelineCache,
                    u32,
                    *const $info,
                    Callbacks,
                    *mut vk::Pipeline,
                ) -> vk::Result;
                if let Some(result) = failure(stringify!($make)) {
                    // SAFETY: Vulkan makes pipelines null that it could not make; the caller has room for one.
                    unsafe { out.write(vk::Pipeline::null()) };
                    return result;
                }
                // SAFETY: the library passes one complete description.
                let stages = unsafe { $stages(&*info) };
                if let Some(kept) = kept::find(stringify!($make), stages) {
                    // SAFETY: the caller has room for one.
                    unsafe { out.write(kept) };
                    count("Pipeline", 1);
                    return vk::Result::SUCCESS;
                }
                // SAFETY: the true function has this signature; the caller's arguments are passed on.
                let make = unsafe { std::mem::transmute::<usize, True>(real(stringify!($make))) };
                // SAFETY: as above.
                let result = unsafe { make(d, cache, n, info, c, out) };
                if result == vk::Result::SUCCESS {
                    count("Pipeline", i64::from(n));
                    // SAFETY: the object was just written.
                    kept::note(stringify!($make), stages, unsafe { *out });
                }
                result
            }
        )*
    };
}

type Stages<'a> = &'a [vk::PipelineShaderStageCreateInfo<'static>];

fn stage_of<'a>(info: &'a vk::ComputePipelineCreateInfo<'static>) -> Stages<'a> {
    std::slice::from_ref(&info.stage)
}

/// # Safety
/// The description is complete.
unsafe fn stages_of<'a>(info: &'a vk::GraphicsPipelineCreateInfo<'static>) -> Stages<'a> {
    // SAFETY: the caller vouches for the array and its count.
    unsafe { std::slice::from_raw_parts(info.p_stages, info.stage_count as usize) }
}

pipelines! {
    vkCreateComputePipelines(vk::ComputePipelineCreateInfo<'static>): stage_of;
    vkCreateGraphicsPipelines(vk::GraphicsPipelineCreateInfo<'static>): stages_of;
}

#[expect(non_snake_case, reason = "Vulkan's name")]
unsafe extern "system" fn vkDestroyPipeline(d: vk::Device, pipeline: vk::Pipeline, c: Callbacks) {
    count("Pipeline", -i64::from(pipeline != vk::Pipeline::null()));
    if kept::holds(pipeline) {
        return;
    }
    // SAFETY: the true function has this signature; the caller's arguments are passed on.
    unsafe {
        std::mem::transmute::<usize, vk::PFN_vkDestroyPipeline>(real("vkDestroyPipeline"))(
            d,
            pipeline,
            c.cast(),
        )
    }
}

/// Records the barriers themselves.
#[expect(non_snake_case, reason = "Vulkan's name")]
unsafe extern "system" fn vkCmdPipelineBarrier2(
    c: vk::CommandBuffer,
    info: *const vk::DependencyInfo<'static>,
) {
    // SAFETY: the library passes a complete description, whose arrays have the counts stated.
    let (buffers, images) = unsafe {
        let info = &*info;
        let none = info.p_buffer_memory_barriers.is_null() || info.buffer_memory_barrier_count == 0;
        let buffers = match none {
            true => Vec::new(),
            false => std::slice::from_raw_parts(
                info.p_buffer_memory_barriers,
                info.buffer_memory_barrier_count as usize,
            )
            .to_vec(),
        };
        let none = info.p_image_memory_barriers.is_null() || info.image_memory_barrier_count == 0;
        let images = match none {
            true => Vec::new(),
            false => std::slice::from_raw_parts(
                info.p_image_memory_barriers,
                info.image_memory_barrier_count as usize,
            )
            .to_vec(),
        };
        (buffers, images)
    };
    record(Call { name: "vkCmdPipelineBarrier2", buffers, images, numbers: Vec::new() });
    // SAFETY: the true function has this signature; the caller's arguments are passed on.
    unsafe {
        std::mem::transmute::<usize, vk::PFN_vkCmdPipelineBarrier2>(real("vkCmdPipelineBarrier2"))(
            c,
            info.cast(),
        );
    }
}

macro_rules! special {
    ($($name:ident),*) => {
        fn special(name: &str) -> Option<(&'static str, Function)> {
            match name {
                $(stringify!($name) => Some((stringify!($name), erased($name as *const c_void))),)*
                _ => None,
            }
        }

        const SPECIAL: &[(&str, &CStr)] = &[$((stringify!($name), c_name(concat!(stringify!($name), "\0")))),*];
    };
}

special!(vkCreateComputePipelines, vkCreateGraphicsPipelines, vkDestroyPipeline, vkCmdPipelineBarrier2);
