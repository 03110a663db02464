//! The conformance kit on a device that a host makes itself, with the room's requirements patched into its own `pNext`
//! chain, on the test device's instance, whose validation hears all devices.

use crate::device::{open, stated};
use airglow_gpu::ash::{self, vk};
use airglow_gpu::open::OpenDevice;
use airglow_gpu::{Context, FeatureSet, FeatureStorage, Options, Requirements, patch_features};
use std::ffi::c_void;
use std::ops::Range;

pub use airglow_conformance::*;

/// Runs a room made by `make` on a device of its own by both roads, asserts what a host relies on, and returns the
/// [`Outputs`].
///
/// # Panics
/// On an error of [`conform_on`], and if validation says anything.
pub fn conform<R: Room>(
    make: impl Fn(&Context) -> R,
    requirements: &Requirements,
    options: &Options,
) -> Outputs {
    conform_adopting(|context, _| Ok(make(context)), requirements, options)
}

/// The same for a room that adopts the host's device on a road of its own, such as a library for another language.
///
/// # Panics
/// As [`conform`].
pub fn conform_adopting<R: Room>(
    make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
    requirements: &Requirements,
    options: &Options,
) -> Outputs {
    on_own_device(requirements, |host| {
        // SAFETY: the device was just made, as stated, and is no one else's.
        unsafe { conform_on(host, requirements, options, make) }
    })
}

/// Lets every call of a room that may fail do so in turn, on a device of its own; returns how many there were.
///
/// # Panics
/// On an error of [`fail_on`], and if validation says anything.
pub fn fail_each<R: Room>(make: impl Fn(&Context) -> Result<R, Refusal>, requirements: &Requirements) -> u64 {
    on_own_device(requirements, |host| {
        // SAFETY: the device was just made, as stated, and is no one else's.
        unsafe { fail_on(host, requirements, |context, _| make(context)) }
    })
}

/// Runs two of a room in one plan in several orders, on a device of their own; returns how many orders there were.
///
/// # Panics
/// On an error of [`shuffle_on`], and if validation says anything.
pub fn shuffle<R: Room>(
    make: impl Fn(&Context) -> Result<R, Refusal>,
    requirements: &Requirements,
    seeds: Range<u64>,
) -> usize {
    on_own_device(requirements, |host| {
        // SAFETY: the device was just made, as stated, and is no one else's.
        unsafe { shuffle_on(host, requirements, seeds, |context, _| make(context)) }
    })
    .len()
}

/// Runs a room by both roads on a device whose memory the CPU cannot map, and returns the [`Outputs`].
///
/// # Panics
/// On an error of [`stage_on`], and if validation says anything.
pub fn stage<R: Room>(make: impl Fn(&Context) -> Result<R, Refusal>, requirements: &Requirements) -> Outputs {
    on_own_device(requirements, |host| {
        // SAFETY: the device was just made, as stated, and is no one else's.
        unsafe { stage_on(host, requirements, |context, _| make(context)) }
    })
}

/// Has pipelines made on a thread of their own, then holds that rooms made of them make no other; returns how many there
/// are, which is `count`.
///
/// # Panics
/// On an error of [`prepare_on`], and if validation says anything.
pub fn prepare<P: Send, E: std::error::Error + Send + 'static, R: Room>(
    requirements: &Requirements,
    prepare: impl Fn(&Context) -> Result<P, E> + Sync,
    count: usize,
    makes: &[MakePrepared<'_, P, R>],
) -> u64 {
    on_own_device(requirements, |host| {
        // SAFETY: the device was just made, as stated, and is no one else's.
        unsafe { prepare_on(host, requirements, prepare, count, makes) }
    })
}

/// Changes a room with every frame, in the order of `makes`, on a device of its own, and waits for none of them.
///
/// # Panics
/// On an error of [`change_on`], and if validation says anything.
pub fn change<R: Room>(makes: &[Make<'_, R>], requirements: &Requirements) {
    on_own_device(requirements, |host| {
        // SAFETY: the device was just made, as stated, and is no one else's.
        unsafe { change_on(host, requirements, makes) }
    });
}

/// Runs `test` on a device that a host made itself; validation is to stay silent.
fn on_own_device<T>(
    requirements: &Requirements,
    test: impl FnOnce(&HostDevice<'_>) -> Result<T, Refusal>,
) -> T {
    let open = open(requirements);
    let (device, features) = device(&open, requirements);
    let done = test(&HostDevice { features, ..stated(&open, &device) });
    let done = done.unwrap_or_else(|problem| panic!("{problem}"));
    // SAFETY: the device is idle, and everything made on it is gone.
    unsafe { device.destroy_device(None) };
    let said: Vec<_> = open.messages().take().iter().map(ToString::to_string).collect();
    assert!(said.is_empty(), "validation said:\n{}", said.join("\n"));
    done
}

/// A second device: the host chains what it wants itself, and has the room's features patched in.
fn device(open: &OpenDevice, requirements: &Requirements) -> (ash::Device, FeatureSet) {
    let (instance, requirements) = (open.instance(), Requirements::engine().and(requirements));
    let mut own = vk::PhysicalDeviceVulkan12Features { timeline_semaphore: vk::TRUE, ..Default::default() };
    let mut chain: *mut c_void = (&raw mut own).cast();
    let mut core = vk::PhysicalDeviceFeatures::default();
    let mut storage = FeatureStorage::default();
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(open.queue_family())
        .queue_priorities(&[1.0])];
    // SAFETY: live handles; the chain is valid and outlived by its storage; what is enabled is supported.
    let made = unsafe {
        let supported = FeatureSet::supported(instance, open.physical_device());
        let wanted = requirements.features_to_enable(supported);
        patch_features(&mut chain, Some(&mut core), wanted, vk::API_VERSION_1_3, &mut storage)
            .expect("a plain chain");
        let features = FeatureSet::of_chain(chain, Some(&core));
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_features(&core);
        let info = vk::DeviceCreateInfo { p_next: chain, ..info };
        let device = instance.create_device(open.physical_device(), &info, None).expect("a second device");
        (device, features)
    };
    assert_eq!(own.timeline_semaphore, vk::TRUE, "what the host wanted stays");
    made
}
