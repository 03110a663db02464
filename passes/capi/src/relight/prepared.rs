//! A frame as data, made from what the host says of it.

use std::ffi::CString;
use std::sync::{Arc, Mutex};

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Context, Label, Location};
use airglow_graph::{BufferDesc, ImageDesc, ResourceDesc};
use airglow_relight::{Bindings, Need, Orientation, Prepared, Resource, Settings};

use super::frame::{AirglowRelightFrame, AirglowRelightInstance, orientation, quaternion, read};
use super::sky::Sky;
use super::{AirglowRelight, misuse};
use crate::binding::Kept;
use crate::input::{array, exclusive, one_of, shared, store, take, versioned};
use crate::status::{AirglowError, AirglowStatus, edge};

/// A frame of the pass, ready to be recorded, and again in later frames while meshes, light and sizes stay. One thread
/// at a time.
pub struct AirglowPrepared {
    pub(super) context: Arc<Context>,
    pub(super) prepared: Prepared,
    /// Of a vector.
    pub(super) coefficients: u64,
    pub(super) sky: Option<Arc<Sky>>,
    /// What the library made for the frame.
    pub(super) scratch: Bindings,
    /// What it was recorded with.
    pub(super) kept: Mutex<Kept<Bindings>>,
    /// Names that the host was given pointers to, by resource and by stage.
    pub(super) names: Names,
}

/// Texts with a nul at their end, in the order of the frame's needs and stages.
pub(super) struct Names {
    pub resources: Vec<CString>,
    pub stages: Vec<CString>,
}

impl Names {
    fn new(prepared: &Prepared) -> Self {
        // None of them has a nul within.
        let text = |name: String| CString::new(name).unwrap_or_default();
        Self {
            resources: prepared.needs.iter().map(|(resource, _)| text(resource.to_string())).collect(),
            stages: prepared.stages.iter().map(|stage| text(stage.name.to_owned())).collect(),
        }
    }
}

impl AirglowPrepared {
    pub(super) fn new(
        context: Arc<Context>,
        prepared: Prepared,
        settings: &Settings,
        sky: Option<Arc<Sky>>,
    ) -> Self {
        let (names, scratch) = (Names::new(&prepared), Bindings::default());
        let coefficients = settings.coefficients() as u64;
        Self { context, prepared, coefficients, sky, scratch, kept: Mutex::default(), names }
    }
}

/// Prepares a frame. Memory for the device is made for tables of a new size of environment alone; what the frame itself
/// needs is listed by `airglow_prepared_resources` and made by the host or by `airglow_prepared_make_scratch`.
///
/// # Safety
/// `frame` points at as many bytes as it says, its instances are as many as it says; `prepared` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_prepare(
    relight: *const AirglowRelight,
    frame: *const AirglowRelightFrame,
    prepared: *mut *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(prepared, "prepared", || {
                let relight = shared(relight, "relight")?;
                let context = Arc::clone(&relight.context);
                let state = &mut *relight.state();
                let read = read(state, &versioned(frame, "frame")?)?;
                let prepared = state.relight.prepare(&context, &read.frame)?;
                let prepared = AirglowPrepared::new(context, prepared, state.relight.settings(), read.sky);
                Ok(Box::into_raw(Box::new(prepared)))
            })
        })
    }
}

/// Makes the scratch of a frame, charged to the pass in the context's memory, for hosts that would not place it
/// themselves. Calling it again is nothing.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_make_scratch(
    prepared: *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointer.
    unsafe {
        edge(error, || {
            let frame = exclusive(prepared, "prepared")?;
            let mut made = Bindings::default();
            for (resource, need) in &frame.prepared.needs {
                let Need::Scratch(desc) = need else { continue };
                let name = resource.to_string();
                let label = Label::new("relight", &name);
                match desc {
                    ResourceDesc::Buffer(desc) => {
                        let usage = desc.usage | buffer_usage(&frame.prepared, *resource);
                        let desc = BufferDesc { usage, ..*desc };
                        let buffer = frame.context.create_buffer(label, &desc, Location::Device)?;
                        made.buffers.insert(*resource, (&buffer).into());
                    }
                    ResourceDesc::Image(desc) => {
                        let uses = uses(&frame.prepared, *resource);
                        let usage = uses.fold(desc.usage, |usage, access| usage | access.image_usage());
                        let image = frame.context.create_image(label, &ImageDesc { usage, ..*desc })?;
                        made.images.insert(*resource, image.full_view()?);
                    }
                }
            }
            frame.scratch = made;
            frame.kept().forget();
            Ok(())
        })
    }
}

/// The uses of a resource, in order.
pub(super) fn uses(prepared: &Prepared, resource: Resource) -> impl Iterator<Item = airglow_graph::Access> {
    let uses = prepared.stages.iter().flat_map(|stage| &stage.uses);
    uses.filter(move |used| used.resource == resource).map(|used| used.access)
}

/// The usage that the frame asks of a buffer.
pub(super) fn buffer_usage(prepared: &Prepared, resource: Resource) -> BufferUsageFlags {
    uses(prepared, resource).fold(BufferUsageFlags::empty(), |usage, access| usage | access.buffer_usage())
}

/// Turns the light and the instances of a prepared frame, in the frame's order; it counts from the next recording on. Of
/// the instances only `rotation` and `inverted` are read.
///
/// # Safety
/// `light_rotation` has four values; `instances` has `instance_count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_turn(
    prepared: *const AirglowPrepared,
    light_rotation: *const f64,
    instances: *const AirglowRelightInstance,
    instance_count: usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let light = *shared(light_rotation.cast::<[f64; 4]>(), "light_rotation")?;
            let given = array(instances, instance_count, "instances")?;
            let turned: Vec<Orientation> =
                given.iter().map(|given| orientation(given.rotation, given.inverted)).collect();
            let Some(rotations) = &shared(prepared, "prepared")?.prepared.rotations else {
                return Err(misuse(
                    "the frame",
                    "nothing in it turns: its light is given for each vertex, or none",
                ));
            };
            Ok(rotations.set(quaternion(light), &turned)?)
        })
    }
}

/// Shows (1) or hides (0) an instance of a prepared frame, and says whether its dynamic visibility blocks anything (1) or
/// not (0); it counts from the next recording on. Nothing is recorded for what is away, and the frame stays as it is.
/// Results of a hidden instance are not to be read.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_show(
    prepared: *const AirglowPrepared,
    instance: usize,
    shown: u32,
    shadowed: u32,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let all = &shared(prepared, "prepared")?.prepared.shown;
            let (shown, shadowed) =
                (one_of("shown", shown, &[false, true])?, one_of("shadowed", shadowed, &[false, true])?);
            all.set(instance, shown)?;
            Ok(all.set_shadowed(instance, shadowed)?)
        })
    }
}

/// Puts the light of a prepared frame on (1) or out (0), from the next recording on. While it is out nothing is recorded:
/// results are not to be read, all is black.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_set_lit(
    prepared: *const AirglowPrepared,
    lit: u32,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let lit = one_of("lit", lit, &[false, true])?;
            shared(prepared, "prepared")?.prepared.shown.set_lit(lit);
            Ok(())
        })
    }
}

/// Drops a prepared frame. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_drop(prepared: *mut AirglowPrepared) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(prepared)) };
}
