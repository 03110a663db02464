//! Transfer vectors of a host's own mesh, on the CPU: host arrays in, host arrays out.

use std::ffi::{c_char, c_void};
use std::mem::offset_of;
use std::ops::ControlFlow;

use airglow_bake::{
    BakeError, BelowHorizon, Mesh, Occluder, Occluders, Progress, Report, Settings, Threads, bake,
};
use glam::Mat4;

use crate::input::{Versioned, array, array_mut, exclusive, string, versioned};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// What visibility is below the tangent plane of a vertex, where no ray is traced.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowBelowHorizon {
    /// The share of the cosine-weighted upper hemisphere that is free.
    Mean = 0,
    /// 1: what other geometry blocks, without the vertex's own surface.
    Visible = 1,
    /// 0: the surface blocks its own lower hemisphere.
    Blocked = 2,
}

/// Triangles that block light, from both sides, beside those of the mesh itself. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowOccluder {
    /// Name used in errors; null for "occluder".
    pub name: *const c_char,
    /// Three floats a vertex, metres.
    pub positions: *const f32,
    /// Vertices.
    pub vertex_count: usize,
    /// Three a triangle.
    pub indices: *const u32,
    /// Indices.
    pub index_count: usize,
    /// From its space to the object space of the mesh: affine, column-major. All zero is the identity.
    pub transform: [f32; 16],
}

/// A mesh to be baked, and how. Positions, normals and vectors are in its object space.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowBakeInfo {
    /// `sizeof(AirglowBakeInfo)`.
    pub struct_size: u32,
    /// Bands, 1 to 6: order^2 coefficients a vertex. 0 is 4.
    pub order: u32,
    /// Name used in errors; null for "mesh".
    pub name: *const c_char,
    /// Three floats a vertex, metres.
    pub positions: *const f32,
    /// Three floats a vertex, outward, of any length; a zero normal gives a zero vector.
    pub normals: *const f32,
    /// Vertices.
    pub vertex_count: usize,
    /// Three a triangle.
    pub indices: *const u32,
    /// Indices.
    pub index_count: usize,
    /// Rays a vertex, 1 to 1048576. 0 is 256.
    pub rays: u32,
    /// Threads, which end with the call. 0 and 1 are the caller's alone. The bits do not depend on it.
    pub threads: u32,
    /// Longest ray in metres; 0 is without end.
    pub reach: f32,
    /// Decorrelates two bakes of one mesh.
    pub seed: u32,
    /// More triangles that block light.
    pub occluders: *const AirglowOccluder,
    /// How many.
    pub occluder_count: usize,
    /// Where static visibility vectors are written, as many values as transfer, for incident radiance; or null.
    pub visibility: *mut f32,
    /// An `AirglowBelowHorizon`, for visibility.
    pub below_horizon: u32,
    /// Not used; 0.
    pub reserved: u32,
    /// Told how many vertices are done, about every thirtieth of a second, by one thread at a time; not 0 stops the
    /// bake. May be null.
    pub progress: Option<unsafe extern "C" fn(user: *mut c_void, done: usize, count: usize) -> u32>,
    /// Handed to `progress`.
    pub user: *mut c_void,
}

// SAFETY: `#[repr(C)]`, its size first, numbers, pointers and an optional function; fields of 8 bytes are at multiples
// of 8.
unsafe impl Versioned for AirglowBakeInfo {
    const OLDEST: usize = offset_of!(Self, occluders);
}

/// What a bake did.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowBakeStats {
    /// Rays traced.
    pub rays: u64,
    /// Rays that met an occluder.
    pub blocked: u64,
    /// Vertices whose normal is zero.
    pub zero_normals: u64,
    /// Wall-clock time in seconds.
    pub seconds: f64,
}

/// Bakes transfer vectors: `order^2` values a vertex, vertex-major, to be given to `airglow_relight_add_mesh`. They
/// carry 1/pi and no albedo. The same input gives the same bits on any number of threads. `stats` may be null.
///
/// # Safety
/// All arrays of `info` have as many elements as it says; `transfer` has room for `transfer_count` values, which must be
/// `vertex_count * order^2`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_bake(
    info: *const AirglowBakeInfo,
    transfer: *mut f32,
    transfer_count: usize,
    stats: *mut AirglowBakeStats,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the arrays.
    unsafe {
        edge(error, || {
            let info: AirglowBakeInfo = versioned(info, "info")?;
            let settings = settings(&info)?;
            let needed = info.vertex_count.checked_mul(settings.coefficient_count());
            if needed != Some(transfer_count) || transfer_count == 0 {
                return Err(Failure::argument(
                    "transfer_count",
                    "give vertex_count * order * order, above 0",
                ));
            }
            let transfer = array_mut(transfer, transfer_count, "transfer")?;
            let name = string(info.name, "name", "mesh")?;
            let mesh = Mesh {
                name,
                positions: array(info.positions.cast(), info.vertex_count, "positions")?,
                normals: array(info.normals.cast(), info.vertex_count, "normals")?,
                indices: array(info.indices, info.index_count, "indices")?,
            };
            let mut occluders = vec![mesh.occluder()];
            for occluder in array(info.occluders, info.occluder_count, "occluders")? {
                occluders.push(triangles(occluder)?);
            }
            let occluders = Occluders::build(&occluders)?;
            let threads = Threads::new(info.threads.min(MOST_THREADS) as usize);
            let mut progress = HostProgress { tell: info.progress, user: info.user };
            let baked = bake(&mesh, Mat4::IDENTITY, &occluders, &settings, &threads, &mut progress)?;
            transfer.copy_from_slice(&baked.transfer.coefficients);
            if let Some(values) = &baked.transfer.visibility {
                array_mut(info.visibility, transfer_count, "visibility")?.copy_from_slice(values);
            }
            if !stats.is_null() {
                *exclusive(stats, "stats")? = AirglowBakeStats {
                    rays: baked.stats.rays,
                    blocked: baked.stats.blocked,
                    zero_normals: baked.stats.zero_normals as u64,
                    seconds: baked.stats.time.as_secs_f64(),
                };
            }
            Ok(())
        })
    }
}

/// More would not make it faster; a count from memory never set would ask the system for billions.
const MOST_THREADS: u32 = 1024;

fn settings(info: &AirglowBakeInfo) -> Result<Settings, Failure> {
    let default = Settings::default();
    let below = match info.below_horizon {
        0 => BelowHorizon::Mean,
        1 => BelowHorizon::Visible,
        2 => BelowHorizon::Blocked,
        _ => return Err(Failure::argument("below_horizon", "give an AirglowBelowHorizon")),
    };
    let settings = Settings {
        order: if info.order == 0 { default.order } else { info.order as usize },
        rays: if info.rays == 0 { default.rays } else { info.rays },
        visibility: (!info.visibility.is_null()).then_some(below),
        reach: if info.reach == 0.0 { default.reach } else { info.reach },
        seed: info.seed,
    };
    settings.check()?;
    Ok(settings)
}

/// # Safety
/// As [`airglow_bake`].
unsafe fn triangles<'a>(occluder: &AirglowOccluder) -> Result<Occluder<'a>, Failure> {
    let identity = occluder.transform == [0.0; 16];
    // SAFETY: the caller's promise is ours.
    unsafe {
        Ok(Occluder {
            name: string(occluder.name, "the name of an occluder", "occluder")?,
            positions: array(occluder.positions.cast(), occluder.vertex_count, "positions of an occluder")?,
            indices: array(occluder.indices, occluder.index_count, "indices of an occluder")?,
            transform: if identity { Mat4::IDENTITY } else { Mat4::from_cols_array(&occluder.transform) },
            mask: None,
        })
    }
}

struct HostProgress {
    tell: Option<unsafe extern "C" fn(*mut c_void, usize, usize) -> u32>,
    user: *mut c_void,
}

// SAFETY: the pointer is only handed back to the host, which is told that any thread calls.
unsafe impl Send for HostProgress {}

impl Progress for HostProgress {
    fn report(&mut self, report: &Report) -> ControlFlow<()> {
        let Some(tell) = self.tell else { return ControlFlow::Continue(()) };
        // SAFETY: the host's function with the host's pointer.
        match unsafe { tell(self.user, report.vertices, report.vertex_count) } {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }
}

impl From<BakeError> for Failure {
    fn from(error: BakeError) -> Self {
        let status = match error {
            BakeError::Cancelled => AirglowStatus::Cancelled,
            _ => AirglowStatus::InvalidArgument,
        };
        Self::new(status, error.to_string())
    }
}
