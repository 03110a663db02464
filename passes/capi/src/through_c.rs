//! Passes made by the exported functions, as the conformance kit and the tests use them.
#![allow(dead_code, unused_imports, unused_macros, reason = "helpers of passes, of which there may be none")]

use std::ffi::{CStr, CString};
use std::mem::zeroed;
use std::ptr::null_mut;

use airglow_conformance::{Given, HostDevice, Refusal};
use airglow_gpu::Recorder;
use airglow_gpu::ash::vk::Handle;
use airglow_graph::Access;

use crate::access::{AirglowAccess, Number};
use crate::binding::AirglowBinding;
use crate::context::{AirglowAdoptInfo, AirglowContext, airglow_context_adopt, airglow_context_drop};
use crate::physical::AirglowFunction;
use crate::prepared::{
    AirglowPrepared, airglow_prepared_accesses, airglow_prepared_drop, airglow_prepared_record,
};
use crate::requirements::{AirglowRequirements, airglow_requirements_drop, airglow_requirements_new};
use crate::status::AirglowError;

/// An error to be filled.
pub(crate) fn error() -> AirglowError {
    // SAFETY: zero bytes are a valid error, of status 0.
    AirglowError { struct_size: size_of::<AirglowError>() as u32, ..unsafe { zeroed() } }
}

/// What an error says.
pub(crate) fn message(error: &AirglowError) -> &str {
    // SAFETY: messages end in a nul.
    unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_str().unwrap_or("a message that is not UTF-8")
}

/// Calls a function with an error at its end; whatever it refuses is a [`Refusal`] with its words.
macro_rules! attempt {
    ($function:path, $($argument:expr),*) => {{
        let mut error = $crate::through_c::error();
        // SAFETY: the kit and the tests keep the function's promises.
        let status = unsafe { $function($($argument,)* &raw mut error) };
        let said = || format!("{}: {}", stringify!($function), $crate::through_c::message(&error));
        let done = status == $crate::status::AirglowStatus::Ok;
        done.then_some(()).ok_or_else(|| airglow_conformance::Refusal::from(said()))
    }};
}
pub(crate) use attempt;

/// A context and what was made from it.
pub(crate) struct ThroughC {
    pub context: *mut AirglowContext,
    held: Vec<Box<dyn FnOnce()>>,
}

impl ThroughC {
    /// Adopts a host's device for what `ask` adds to requirements.
    pub(crate) fn adopt(
        host: &HostDevice<'_>,
        ask: impl FnOnce(*mut AirglowRequirements) -> Result<(), Refusal>,
    ) -> Result<Self, Refusal> {
        let mut asked = null_mut();
        attempt!(airglow_requirements_new, &raw mut asked)?;
        let adopted = ask(asked).and_then(|()| adopt(host, asked));
        // SAFETY: they were read by the calls above alone.
        unsafe { airglow_requirements_drop(asked) };
        Ok(Self { context: adopted?, held: Vec::new() })
    }

    /// Holds what `make` hands over; `drop` drops it.
    pub(crate) fn hold<T: 'static>(
        &mut self,
        drop: unsafe extern "C" fn(*mut T),
        make: impl FnOnce(*mut *mut T) -> Result<(), Refusal>,
    ) -> Result<*mut T, Refusal> {
        let mut made = null_mut();
        let result = make(&raw mut made);
        // SAFETY: it came from the function that goes with `drop`, and is not used again.
        self.held.push(Box::new(move || unsafe { drop(made) }));
        result.map(|()| made)
    }

    /// Holds a frame that `prepare` prepares.
    pub(crate) fn prepare(
        &mut self,
        prepare: impl FnOnce(*mut *mut AirglowPrepared) -> Result<(), Refusal>,
    ) -> Result<*mut AirglowPrepared, Refusal> {
        self.hold(airglow_prepared_drop, prepare)
    }
}

impl Drop for ThroughC {
    fn drop(&mut self) {
        // The context first: what was made from it may outlive it.
        // SAFETY: it came from its function and is not used again.
        unsafe { airglow_context_drop(self.context) };
        self.held.drain(..).for_each(|drop| drop());
    }
}

/// The uses that a prepared frame lists.
pub(crate) fn uses(prepared: *const AirglowPrepared) -> Result<Vec<AirglowAccess>, Refusal> {
    let mut count = 0;
    attempt!(airglow_prepared_accesses, prepared, null_mut(), &raw mut count)?;
    // SAFETY: zero bytes are a valid access.
    let mut uses = vec![unsafe { zeroed::<AirglowAccess>() }; count];
    attempt!(airglow_prepared_accesses, prepared, uses.as_mut_ptr(), &raw mut count)?;
    Ok(uses)
}

/// The first and the last use listed of each of these resources.
pub(crate) fn ends(
    prepared: *const AirglowPrepared,
    resources: &[Number],
) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
    let uses = uses(prepared)?;
    let ends = |number: &Number| {
        let all = uses.iter().filter(|used| (used.resource, used.index) == *number).map(known);
        let all = all.collect::<Result<Vec<_>, _>>()?;
        Ok(all.first().copied().zip(all.last().copied()))
    };
    resources.iter().map(ends).collect()
}

/// The access of the table that has those numbers.
fn known(used: &AirglowAccess) -> Result<Access, Refusal> {
    let numbers = (used.stage, used.access, used.writes != 0);
    let same = |access: &&Access| {
        (access.stage().as_raw(), access.access().as_raw(), access.writes()) == numbers
            && (used.layout == 0 || access.layout().as_raw() as u32 == used.layout)
    };
    let found = Access::ALL.iter().find(same).copied();
    found.ok_or_else(|| format!("no use has stage {:#x} and access {:#x}", used.stage, used.access).into())
}

/// A host's resource as a binding.
pub(crate) fn binding((resource, index): Number, given: &Given) -> AirglowBinding {
    // SAFETY: zero bytes are a valid binding.
    let none = AirglowBinding { resource, index, ..unsafe { zeroed() } };
    match given {
        Given::Buffer(buffer) => AirglowBinding {
            buffer: buffer.raw().as_raw(),
            size: buffer.size(),
            usage: buffer.desc().usage.as_raw(),
            ..none
        },
        Given::Image(image) => AirglowBinding {
            image: image.raw().as_raw(),
            format: image.desc().format.as_raw() as u32,
            usage: image.desc().usage.as_raw(),
            extent: [image.desc().extent[0], image.desc().extent[1]],
            mips: image.desc().mips,
            ..none
        },
    }
}

/// Records a prepared frame with these resources.
pub(crate) fn record<'a>(
    prepared: *const AirglowPrepared,
    recorder: &mut Recorder<'_>,
    resources: impl IntoIterator<Item = (Number, &'a Given)>,
) -> Result<(), Refusal> {
    let bindings: Vec<_> = resources.into_iter().map(|(number, given)| binding(number, given)).collect();
    let commands = recorder.command_buffer().as_raw();
    attempt!(airglow_prepared_record, prepared, commands, bindings.as_ptr(), bindings.len())
}

/// A function of Vulkan as the header has it.
pub(crate) fn function<F: Copy>(function: F) -> AirglowFunction {
    // SAFETY: function pointers of one size, and cast back before they are called.
    unsafe { std::mem::transmute_copy(&function) }
}

/// What a host states of its device; extensions and features are added by [`adopt`].
pub(crate) fn adopt_info(host: &HostDevice<'_>) -> AirglowAdoptInfo {
    AirglowAdoptInfo {
        struct_size: size_of::<AirglowAdoptInfo>() as u32,
        api_version: host.api_version,
        get_instance_proc_addr: function(host.get_instance_proc_addr),
        get_device_proc_addr: function(host.get_device_proc_addr),
        instance: host.instance.as_raw(),
        physical_device: host.physical_device.as_raw(),
        device: host.device.as_raw(),
        queue_family: host.queue_family,
        frames_in_flight: 1,
        // SAFETY: zero bytes are a valid description.
        ..unsafe { zeroed() }
    }
}

/// Adopts a host's device for what `requirements` ask.
pub(crate) fn adopt(
    host: &HostDevice<'_>,
    requirements: *const AirglowRequirements,
) -> Result<*mut AirglowContext, Refusal> {
    let names = |texts: &[&str]| texts.iter().map(|text| CString::new(*text)).collect::<Result<Vec<_>, _>>();
    let extensions = names(host.extensions)?;
    let features = names(&host.features.iter().map(|feature| feature.name()).collect::<Vec<_>>())?;
    let extension_names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let feature_names: Vec<_> = features.iter().map(|name| name.as_ptr()).collect();
    let info = AirglowAdoptInfo {
        requirements,
        extension_names: extension_names.as_ptr(),
        extension_count: extension_names.len(),
        feature_names: feature_names.as_ptr(),
        feature_count: feature_names.len(),
        ..adopt_info(host)
    };
    let mut context = null_mut();
    attempt!(airglow_context_adopt, &raw const info, &raw mut context)?;
    Ok(context)
}
