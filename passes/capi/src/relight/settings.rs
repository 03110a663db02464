//! What the pass is prepared for, and the bytes it takes, before anything is made.

use airglow_gpu::ash::vk;
use airglow_relight::{LightKind, Method, Output, Settings, Storage};

use crate::input::{Versioned, one_of, store, versioned};
use crate::pass::{self, Settings as _};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// How the vectors of a mesh are stored on the device.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowStorage {
    /// 32-bit floats.
    F32 = 0,
    /// 16-bit floats, half the bytes; values up to 63.96.
    F16 = 1,
}

/// What is written for each vertex.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowOutput {
    /// The colour: four floats, radiance of a white diffuse surface in W/sr/m2, the fourth 1.
    Colour = 0,
    /// The incident radiance, SH RGB: `3 * order^2` floats, for shaders that need direction.
    Incident = 1,
}

/// How it is written.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowMethod {
    /// A compute pass writes the vertex buffer.
    Compute = 0,
    /// A fragment pass over a packed rectangle, copied into the vertex buffer; colours only, the same bits.
    Fragment = 1,
}

/// What kind of light arrives.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowLightKind {
    /// One SH RGB vector for a mesh, rotated into the space of each instance.
    Uniform = 0,
    /// One SH RGB vector for each vertex, already in the space of the instance.
    Vertex = 1,
}

/// What the pass is prepared for. Zero is the default of every field.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRelightSettings {
    /// `sizeof(AirglowRelightSettings)`.
    pub struct_size: u32,
    /// Bands of every vector, 1 to 6; order^2 coefficients. 0 is 4.
    pub order: u32,
    /// An `AirglowStorage`.
    pub storage: u32,
    /// An `AirglowOutput`.
    pub output: u32,
    /// An `AirglowMethod`.
    pub method: u32,
    /// An `AirglowLightKind`.
    pub light: u32,
    /// 1: instances may bring a dynamic visibility vector for each vertex.
    pub visibility: u32,
    /// 1: instances of meshes without vectors may bring the normals of their vertices, for colours.
    pub normals: u32,
    /// 1: texels of environments that are not finite or negative are counted (`airglow_relight_health_latest`).
    pub health: u32,
    /// Not used; 0.
    pub reserved: u32,
}

// SAFETY: `#[repr(C)]`, its size first, integers of 4 bytes.
unsafe impl Versioned for AirglowRelightSettings {
    const OLDEST: usize = 8;
}

impl pass::Settings for AirglowRelightSettings {
    type Read = Settings;

    fn read(&self) -> Result<Settings, Failure> {
        let settings = Settings {
            order: if self.order == 0 { Settings::default().order } else { self.order as usize },
            storage: one_of("storage", self.storage, &[Storage::F32, Storage::F16])?,
            output: one_of("output", self.output, &[Output::Colour, Output::Incident])?,
            method: one_of("method", self.method, &[Method::Compute, Method::Fragment])?,
            light: one_of("light", self.light, &[LightKind::Uniform, LightKind::Vertex])?,
            visibility: one_of("visibility", self.visibility, &[false, true])?,
            normals: one_of("normals", self.normals, &[false, true])?,
            health: one_of("health", self.health, &[false, true])?,
        };
        settings.check()?;
        Ok(settings)
    }
}

/// Bytes that the settings take, before anything is made; a prepared frame says its own
/// (`airglow_prepared_resources`).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRelightBytes {
    /// Of the vectors of a mesh with that many vertices; twice until its first frame is recorded.
    pub vectors: u64,
    /// Of the results of an instance of it.
    pub results: u64,
    /// `VkBufferUsageFlags` that the host's buffer of results needs for the pass, beside its own.
    pub results_usage: u32,
    /// Not used.
    pub reserved: u32,
}

/// Says the bytes of a mesh of `vertex_count` vertices and of its results.
///
/// # Safety
/// `settings` points at as many bytes as it says; `bytes` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_bytes(
    settings: *const AirglowRelightSettings,
    vertex_count: u32,
    bytes: *mut AirglowRelightBytes,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(bytes, "bytes", || {
                let settings = versioned(settings, "settings")?.read()?;
                let usage = match settings.method {
                    Method::Compute => vk::BufferUsageFlags::STORAGE_BUFFER,
                    Method::Fragment => vk::BufferUsageFlags::TRANSFER_DST,
                };
                let vertices = u64::from(vertex_count);
                Ok(AirglowRelightBytes {
                    vectors: vertices.next_multiple_of(64) * settings.vector_bytes(),
                    results: vertices * settings.output_bytes(),
                    results_usage: usage.as_raw(),
                    reserved: 0,
                })
            })
        })
    }
}
