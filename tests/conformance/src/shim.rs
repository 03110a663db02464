//! A host's get-proc-addr that watches: every device function the library may call, and no other, with a record of
//! commands, a count of objects alive, and failures on demand.
//!
//! Vulkan passes no user data to its functions, so there is one watch in a process; [`Shim`] holds it exclusively.

mod kept;
mod memory;
mod table;

use crate::device::HostDevice;
use airglow_gpu::ash::vk;
use std::collections::BTreeMap;
use std::ffi::{CStr, c_char};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A command as it was recorded.
#[derive(Clone, Debug, Default)]
pub struct Call {
    /// Vulkan's name.
    pub name: &'static str,
    /// What state it touches: bind point and first set, first viewport and count, and the like.
    pub numbers: Vec<u32>,
    /// Buffer barriers of a `vkCmdPipelineBarrier2`.
    pub buffers: Vec<vk::BufferMemoryBarrier2<'static>>,
    /// Image barriers of a `vkCmdPipelineBarrier2`.
    pub images: Vec<vk::ImageMemoryBarrier2<'static>>,
}

/// Commands that set state which outlives them, as `engine/gpu/README.md` lists them; all others act at once.
pub const STATE: [&str; 7] = [
    "vkCmdBindPipeline",
    "vkCmdBindDescriptorSets",
    "vkCmdPushConstants",
    "vkCmdBindVertexBuffers",
    "vkCmdBindIndexBuffer",
    "vkCmdSetViewport",
    "vkCmdSetScissor",
];
/// Commands that act at once and leave no state.
pub const ACTIONS: [&str; 19] = [
    "vkCmdBeginQuery",
    "vkCmdEndQuery",
    "vkCmdBeginRendering",
    "vkCmdEndRendering",
    "vkCmdBeginDebugUtilsLabelEXT",
    "vkCmdEndDebugUtilsLabelEXT",
    "vkCmdCopyBuffer",
    "vkCmdCopyBufferToImage",
    "vkCmdCopyImageToBuffer",
    "vkCmdDispatch",
    "vkCmdDispatchIndirect",
    "vkCmdDraw",
    "vkCmdDrawIndexed",
    "vkCmdDrawIndexedIndirect",
    "vkCmdDrawIndirect",
    "vkCmdFillBuffer",
    "vkCmdPipelineBarrier2",
    "vkCmdResetQueryPool",
    "vkCmdWriteTimestamp2",
];

/// What the watch knows.
#[derive(Default)]
struct Watch {
    /// Addresses of the true functions, by name.
    real: BTreeMap<&'static str, usize>,
    calls: Vec<Call>,
    /// Objects made less objects destroyed, by kind.
    live: BTreeMap<&'static str, i64>,
    /// Calls that may fail, so far.
    fallible: u64,
    /// From which such call on, for how many, and with which result they fail.
    failing: Option<(u64, u64, vk::Result)>,
    /// The call that failed last.
    failed: Option<&'static str>,
    kept: kept::Kept,
    separate: memory::Separate,
}

/// The loader's function, kept beside the device's.
const LOADER: &str = "vkGetInstanceProcAddr";

static WATCH: Mutex<Option<Watch>> = Mutex::new(None);
static TURN: Mutex<()> = Mutex::new(());

/// A failed test leaves whole data behind.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn watch<R>(look: impl FnOnce(&mut Watch) -> R) -> R {
    look(lock(&WATCH).get_or_insert_default())
}

/// The address of a true function; never called before [`Shim::watching`] found it.
#[expect(clippy::panic, reason = "a function is handed out only where the true one was found")]
fn real(name: &'static str) -> usize {
    watch(|watch| watch.real.get(name).copied()).unwrap_or_else(|| panic!("{name} is not there"))
}

fn record(call: Call) {
    watch(|watch| watch.calls.push(call));
}

/// Counts a call that may fail; the result it is to fail with, if any.
fn failure(name: &'static str) -> Option<vk::Result> {
    watch(|watch| {
        let (call, failing) = (watch.fallible, watch.failing);
        watch.fallible += 1;
        let (first, count, result) = failing?;
        // A lost device is told by few functions; running out of memory by all that are watched as fallible.
        let tells = result != vk::Result::ERROR_DEVICE_LOST || table::TELL_LOSS.contains(&name);
        let fails = tells && (first..first.saturating_add(count)).contains(&call);
        watch.failed = if fails { Some(name) } else { watch.failed };
        fails.then_some(result)
    })
}

fn count(kind: &'static str, change: i64) {
    watch(|watch| *watch.live.entry(kind).or_default() += change);
}

/// The get-proc-addr that a host hands to the library: watched functions, null for all others.
unsafe extern "system" fn get_device_proc_addr(
    _device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the library passes nul-terminated names.
    let name = unsafe { CStr::from_ptr(name) }.to_str().ok()?;
    let (name, watched) = table::watched(name)?;
    watch(|watch| watch.real.contains_key(name)).then_some(watched)
}

/// The watch over one device. Contexts that were adopted through it are dropped first.
pub struct Shim {
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    device: vk::Device,
    _turn: MutexGuard<'static, ()>,
}

impl Drop for Shim {
    fn drop(&mut self) {
        for pipeline in watch(|watch| watch.kept.take().collect::<Vec<_>>()) {
            // SAFETY: the true function has this signature; all contexts that were given the pipeline are gone.
            unsafe {
                let destroy = real("vkDestroyPipeline");
                std::mem::transmute::<usize, vk::PFN_vkDestroyPipeline>(destroy)(
                    self.device,
                    pipeline,
                    std::ptr::null(),
                );
            }
        }
    }
}

impl Shim {
    /// Watches a device for as long as it lives; waits for its turn.
    ///
    /// # Safety
    /// The handles of `host` are alive and its functions their own.
    pub unsafe fn watching(host: &HostDevice<'_>) -> Self {
        let turn = lock(&TURN);
        let (get, get_instance) = (host.get_device_proc_addr, host.get_instance_proc_addr);
        let (device, instance) = (host.device, host.instance);
        let mut real = BTreeMap::from([(LOADER, get_instance as usize)]);
        for (name, c_name) in table::names() {
            // SAFETY: live handles with their own functions.
            let found =
                unsafe { get(device, c_name.as_ptr()).or_else(|| get_instance(instance, c_name.as_ptr())) };
            real.extend(found.map(|function| (name, function as usize)));
        }
        watch(|watch| *watch = Watch { real, ..Watch::default() });
        Self { get_instance_proc_addr: get_instance, device, _turn: turn }
    }

    /// What to hand to [`airglow_gpu::AdoptInfo::get_device_proc_addr`].
    pub fn get_device_proc_addr(&self) -> vk::PFN_vkGetDeviceProcAddr {
        get_device_proc_addr
    }

    /// What to hand to [`airglow_gpu::AdoptInfo::get_instance_proc_addr`].
    pub fn get_instance_proc_addr(&self) -> vk::PFN_vkGetInstanceProcAddr {
        match watch(|watch| watch.separate.is_told()) {
            true => memory::get_instance_proc_addr,
            false => self.get_instance_proc_addr,
        }
    }

    /// From now on no memory is both the device's and the CPU's: what is told of memory is of two types, and the CPU maps
    /// none of the first. `memory` is what the device truly has. False where it has nothing that can stand for both.
    pub fn separate_memory(&self, memory: &vk::PhysicalDeviceMemoryProperties) -> bool {
        watch(|watch| watch.separate.begin(memory))
    }

    /// With separate memory: allocations that the device alone reaches, and those that the CPU maps.
    pub fn separate_allocations(&self) -> [u64; 2] {
        watch(|watch| watch.separate.made())
    }

    /// The commands recorded since the last call.
    pub fn take_calls(&self) -> Vec<Call> {
        watch(|watch| std::mem::take(&mut watch.calls))
    }

    /// Starts counting calls that may fail anew; call `nth`, from 0, fails with `result`.
    pub fn fail(&self, nth: u64, result: vk::Result) {
        watch(|watch| {
            (watch.fallible, watch.failing) = (0, Some((nth, 1, result)));
            watch.kept.again();
        });
    }

    /// Lets attempts that begin with [`Shim::fail`] share their pipelines: each makes the same ones in the same order.
    pub fn keep_pipelines(&self) {
        watch(|watch| watch.kept.keep());
    }

    /// From now on every call that may say so says that the device is lost.
    pub fn lose_device(&self) {
        watch(|watch| watch.failing = Some((0, u64::MAX, vk::Result::ERROR_DEVICE_LOST)));
    }

    /// Calls that could have failed since [`Shim::fail`].
    pub fn fallible(&self) -> u64 {
        watch(|watch| watch.fallible)
    }

    /// Nothing fails any more; the number of calls that could have failed since [`Shim::fail`].
    pub fn heal(&self) -> u64 {
        watch(|watch| {
            watch.failing = None;
            watch.fallible
        })
    }

    /// The call that failed last, for a message.
    pub fn failed(&self) -> &'static str {
        watch(|watch| watch.failed).unwrap_or("no call")
    }

    /// How many objects of each kind are alive, where it is not 0.
    pub fn alive(&self) -> BTreeMap<&'static str, i64> {
        watch(|watch| {
            watch.live.iter().map(|(kind, live)| (*kind, *live)).filter(|entry| entry.1 != 0).collect()
        })
    }
}
