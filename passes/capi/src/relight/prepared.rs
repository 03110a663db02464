//! A frame as data, made from what the host says of it, and what changes it before it is recorded again.

use std::sync::Arc;

use airglow_gpu::Recorder;
use airglow_relight::{Bindings, Orientation, Prepared, Resource};

use super::frame::{AirglowRelightFrame, AirglowRelightInstance, orientation, quaternion, read};
use super::resources::{number, uses};
use super::sky::Sky;
use super::{AirglowRelight, misuse};
use crate::binding::{Bound, Imported};
use crate::input::{array, one_of, shared, versioned};
use crate::pass::{Frame, give};
use crate::prepared::AirglowPrepared;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::write_array;

/// A frame of the pass.
pub(super) struct RelightFrame {
    prepared: Prepared,
    sky: Option<Arc<Sky>>,
}

impl Frame for RelightFrame {
    const PASS: &'static str = "relight";
    type Bindings = Bindings;

    fn bind(&self, bound: &Bound<'_>) -> Result<Bindings, Failure> {
        let mut bindings = Bindings::default();
        for (wanted, imported) in bound.all() {
            let mut needs = self.prepared.needs.iter().map(|(resource, _)| *resource);
            let Some(resource) = needs.find(|resource| number(*resource) == *wanted) else { continue };
            match imported.clone() {
                Imported::Image(view) => drop(bindings.images.insert(resource, view)),
                Imported::Buffer(slice) => drop(bindings.buffers.insert(resource, slice)),
            }
        }
        Ok(bindings)
    }

    fn record(&self, recorder: &mut Recorder<'_>, bindings: &mut Bindings) -> Result<(), Failure> {
        let needed = |wanted| self.prepared.needs.iter().any(|(resource, _)| *resource == wanted);
        if let Some(sky) = self.sky.as_ref().filter(|_| needed(Resource::Environment)) {
            bindings.images.insert(Resource::Environment, sky.bind(recorder)?);
        }
        Ok(self.prepared.record(recorder, bindings)?)
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
            give(prepared, "prepared", || {
                let relight = shared(relight, "relight")?;
                let state = &mut *relight.state();
                let read = read(state, &versioned(frame, "frame")?)?;
                let prepared = state.relight.prepare(&relight.context, &read.frame)?;
                let coefficients = state.relight.settings().coefficients() as u64;
                let uses = uses(&prepared, coefficients, read.sky.is_some());
                Ok(AirglowPrepared::new(&relight.context, uses, RelightFrame { prepared, sky: read.sky }))
            })
        })
    }
}

/// Where the results of an instance lie in the buffer of results. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowResultRange {
    /// First byte: the offset of the instance's vertex buffer.
    pub offset: u64,
    /// Bytes.
    pub size: u64,
    /// Vertices.
    pub vertex_count: u32,
    /// Not used.
    pub reserved: u32,
}

/// Lists where the results of each instance lie, in the order of the frame; none when the pass was left out. `*count` as
/// with `airglow_prepared_accesses`.
///
/// # Safety
/// `ranges` is null or has room for `*count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_ranges(
    prepared: *const AirglowPrepared,
    ranges: *mut AirglowResultRange,
    count: *mut usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    let row = |range: &airglow_relight::ResultRange| AirglowResultRange {
        offset: range.offset,
        size: range.size,
        vertex_count: range.vertices,
        reserved: 0,
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &RelightFrame = shared(prepared, "prepared")?.of()?;
            write_array(ranges, count, &frame.prepared.ranges.iter().map(row).collect::<Vec<_>>())
        })
    }
}

/// Turns the light and the instances of a prepared frame, in the frame's order; it counts from the next recording on. Of
/// the instances only `rotation` and `inverted` are read.
///
/// # Safety
/// `light_rotation` has four values; `instances` has `instance_count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_turn(
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
            let frame: &RelightFrame = shared(prepared, "prepared")?.of()?;
            let Some(rotations) = &frame.prepared.rotations else {
                return Err(misuse(
                    "the frame",
                    "nothing in it turns: its light is given for each vertex, or none",
                ));
            };
            Ok(rotations.set(quaternion(light), &turned)?)
        })
    }
}

/// Sets what each band of the light of a prepared frame is multiplied with, red, green and blue, from the next recording on:
/// the zonal filter of a convolution about every direction, such as that of a medium before an environment. All 1 at first.
/// For light that turns: an environment's, or one vector for all.
///
/// # Safety
/// `factors` has `3 * band_count` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_set_filter(
    prepared: *const AirglowPrepared,
    factors: *const f64,
    band_count: usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &RelightFrame = shared(prepared, "prepared")?.of()?;
            let factors = array(factors.cast::<[f64; 3]>(), band_count, "factors")?;
            let Some(rotations) = &frame.prepared.rotations else {
                return Err(misuse("the frame", "it has no light that bands could be multiplied of"));
            };
            Ok(rotations.set_filter(factors)?)
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
pub unsafe extern "C" fn airglow_relight_show(
    prepared: *const AirglowPrepared,
    instance: usize,
    shown: u32,
    shadowed: u32,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &RelightFrame = shared(prepared, "prepared")?.of()?;
            let (shown, shadowed) =
                (one_of("shown", shown, &[false, true])?, one_of("shadowed", shadowed, &[false, true])?);
            frame.prepared.shown.set(instance, shown)?;
            Ok(frame.prepared.shown.set_shadowed(instance, shadowed)?)
        })
    }
}

/// Puts the light of a prepared frame on (1) or out (0), from the next recording on. While it is out nothing is recorded:
/// results are not to be read, all is black.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_set_lit(
    prepared: *const AirglowPrepared,
    lit: u32,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let lit = one_of("lit", lit, &[false, true])?;
            let frame: &RelightFrame = shared(prepared, "prepared")?.of()?;
            frame.prepared.shown.set_lit(lit);
            Ok(())
        })
    }
}
