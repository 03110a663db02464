//! What is lit: vertices of one mesh or of many instances, that share one tree and one set of samples.

use std::ops::ControlFlow;

use airglow_radiance::{Hierarchy, Part, Receiver};
use glam::{DMat3, DVec3};

use super::AirglowRadiance;
use crate::input::{Versioned, array, shared, take, versioned};
use crate::pass::give;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// Vertices that light is sampled for, on the device, with room for samples. Any thread may use it.
pub struct AirglowRadianceReceiver {
    pub(super) receiver: Receiver,
}

/// Consecutive vertices of a receiver whose light lies in a buffer of its own: an instance. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRadiancePart {
    /// The first vertex.
    pub first: u32,
    /// How many.
    pub count: u32,
    /// Turns directions from the space of positions and emitters into that of the part's light, orthogonal, column-major:
    /// the inverse of an instance's rotation, mirrored or not. All zero is the identity.
    pub turn: [f64; 9],
}

/// Vertices in one space, that of the emitters: a mesh, or all instances placed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRadianceReceiverInfo {
    /// `sizeof(AirglowRadianceReceiverInfo)`.
    pub struct_size: u32,
    /// Not used; 0.
    pub reserved: u32,
    /// Three floats a vertex, metres.
    pub positions: *const f32,
    /// Vertices.
    pub vertex_count: usize,
    /// Transfer vectors (`airglow_bake`), `order^2` values a vertex, that say where light matters; null for vectors of
    /// length 1.
    pub transfer: *const f32,
    /// Values of them: `order^2 * vertex_count`, or 0.
    pub transfer_count: usize,
    /// The instances; null for one of all vertices.
    pub parts: *const AirglowRadiancePart,
    /// How many; 0 for one of all vertices.
    pub part_count: usize,
}

// SAFETY: `#[repr(C)]`, its size first, integers and pointers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowRadianceReceiverInfo {
    const OLDEST: usize = size_of::<Self>();
}

/// Makes a receiver: the tree over its vertices, and its memory on the device. Copies go to the device with the first frame
/// that is recorded with it.
///
/// # Safety
/// `info` points at as many bytes as it says, and its arrays have as many elements as it says; `receiver` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_receiver_new(
    radiance: *const AirglowRadiance,
    info: *const AirglowRadianceReceiverInfo,
    receiver: *mut *mut AirglowRadianceReceiver,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(receiver, "receiver", || {
                let AirglowRadiance { context, radiance } = shared(radiance, "radiance")?;
                let info: AirglowRadianceReceiverInfo = versioned(info, "info")?;
                let positions = array(info.positions.cast(), info.vertex_count, "info.positions")?;
                let transfer = array(info.transfer, info.transfer_count, "info.transfer")?;
                let parts = parts(array(info.parts, info.part_count, "info.parts")?, positions.len())?;
                let tree = Hierarchy::build(positions, transfer, &mut |_, _| ControlFlow::Continue(()))?;
                let receiver = Receiver::new(context, *radiance.settings(), &tree, positions, &parts)?;
                Ok(AirglowRadianceReceiver { receiver })
            })
        })
    }
}

fn parts(given: &[AirglowRadiancePart], vertices: usize) -> Result<Vec<Part>, Failure> {
    let too_many = |_| Failure::argument("info.vertex_count", "it is more than 2^32");
    if given.is_empty() {
        return Ok(vec![Part { vertices: 0..vertices.try_into().map_err(too_many)?, turn: None }]);
    }
    let part = |part: &AirglowRadiancePart| {
        let end = part.first.checked_add(part.count);
        let end = end.ok_or_else(|| Failure::argument("info.parts", "a part ends past its vertices"))?;
        let [x, y, z] = [0, 3, 6].map(|at| DVec3::from_slice(&part.turn[at..]));
        let turn = (part.turn != [0.0; 9]).then_some(DMat3::from_cols(x, y, z));
        Ok(Part { vertices: part.first..end, turn })
    };
    given.iter().map(part).collect()
}

/// Takes the samples of a receiver anew with the next frame that is recorded: for a host that threw away a recorded frame.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_forget_samples(
    receiver: *const AirglowRadianceReceiver,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            shared(receiver, "receiver")?.receiver.forget_samples();
            Ok(())
        })
    }
}

/// Drops a receiver; what was prepared with it stays usable. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_receiver_drop(receiver: *mut AirglowRadianceReceiver) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(receiver)) };
}
