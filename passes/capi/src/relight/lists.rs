//! What a prepared frame uses, as data for the host's own frame graph.

use std::ffi::c_char;

use airglow_graph::{Access, ResourceDesc};
use airglow_relight::{Need, Resource};

use super::prepared::{AirglowPrepared, buffer_usage, uses};
use super::resources::number;
use crate::access::{AirglowAccess, AirglowOrigin};
use crate::input::shared;
use crate::status::{AirglowError, AirglowStatus, edge};
use crate::text::write_array;

/// One resource of a frame. Elements of arrays never grow; names live as long as the prepared frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowResourceInfo {
    /// An `AirglowResource`.
    pub resource: u32,
    /// See `AirglowResource`.
    pub index: u32,
    /// An `AirglowOrigin`.
    pub origin: u32,
    /// `VkFormat` of a scratch image; 0 otherwise.
    pub format: u32,
    /// Bytes of a buffer, or of the texels of a scratch image; 0 for an image of the host's. A device may pad it.
    pub bytes: u64,
    /// Width and height of a scratch image; 0 otherwise.
    pub extent: [u32; 2],
    /// `VkBufferUsageFlags` or `VkImageUsageFlags` that the frame needs.
    pub usage: u32,
    /// 1: an image.
    pub is_image: u32,
    /// Its name.
    pub name: *const c_char,
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

/// Lists every use of every resource, step by step. Before recording, the host makes its own resources, and the scratch,
/// available to the first use listed of each, in that layout; afterwards it waits for the last. Between the steps the
/// library stands its own barriers; the packed rectangle's layouts are all its own. `*count` holds the size of
/// `accesses` before and the number of uses after; with `accesses` null only the number is written.
///
/// # Safety
/// `accesses` is null or has room for `*count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_accesses(
    prepared: *const AirglowPrepared,
    accesses: *mut AirglowAccess,
    count: *mut usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || write_array(accesses, count, &shared(prepared, "prepared")?.accesses())) }
}

/// Lists every resource that the frame uses, with its bytes, before anything is made. `*count` as with
/// `airglow_prepared_accesses`.
///
/// # Safety
/// `resources` is null or has room for `*count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_resources(
    prepared: *const AirglowPrepared,
    resources: *mut AirglowResourceInfo,
    count: *mut usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || write_array(resources, count, &shared(prepared, "prepared")?.resources())) }
}

/// Lists where the results of each instance lie, in the order of the frame; none when the pass was left out. `*count` as
/// with `airglow_prepared_accesses`.
///
/// # Safety
/// `ranges` is null or has room for `*count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_ranges(
    prepared: *const AirglowPrepared,
    ranges: *mut AirglowResultRange,
    count: *mut usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let listed: Vec<_> = shared(prepared, "prepared")?
                .prepared
                .ranges
                .iter()
                .map(|range| AirglowResultRange {
                    offset: range.offset,
                    size: range.size,
                    vertex_count: range.vertices,
                    reserved: 0,
                })
                .collect();
            write_array(ranges, count, &listed)
        })
    }
}

impl AirglowPrepared {
    fn accesses(&self) -> Vec<AirglowAccess> {
        let mut rows = Vec::new();
        for (step, (stage, step_name)) in self.prepared.stages.iter().zip(&self.names.stages).enumerate() {
            for used in &stage.uses {
                let place = self.prepared.needs.iter().position(|(resource, _)| *resource == used.resource);
                let Some(place) = place else { continue };
                let (resource, index) = number(used.resource);
                let is_image = self.is_image(used.resource);
                rows.push(AirglowAccess {
                    resource: resource as u32,
                    index,
                    origin: self.origin(place) as u32,
                    step: step as u32,
                    stage: used.access.stage().as_raw(),
                    access: used.access.access().as_raw(),
                    layout: if is_image { used.access.layout().as_raw() as u32 } else { 0 },
                    writes: u32::from(used.access.writes()),
                    name: self.names.resources[place].as_ptr(),
                    step_name: step_name.as_ptr(),
                });
            }
        }
        rows
    }

    fn resources(&self) -> Vec<AirglowResourceInfo> {
        let row = |(place, (resource, need)): (usize, &(Resource, Need))| {
            let image = match need {
                Need::Scratch(ResourceDesc::Image(desc)) => Some(desc),
                _ => None,
            };
            let bytes = match need {
                Need::Ours { buffer, .. } => buffer.size(),
                Need::Scratch(ResourceDesc::Buffer(desc)) => desc.size,
                Need::Scratch(ResourceDesc::Image(desc)) => desc.bytes().unwrap_or(0),
                Need::Host => self.host_bytes(*resource),
            };
            let is_image = self.is_image(*resource);
            let usage = match is_image {
                true => uses(&self.prepared, *resource)
                    .fold(0, |usage, access: Access| usage | access.image_usage().as_raw()),
                false => buffer_usage(&self.prepared, *resource).as_raw(),
            };
            let (kind, index) = number(*resource);
            AirglowResourceInfo {
                resource: kind as u32,
                index,
                origin: self.origin(place) as u32,
                format: image.map_or(0, |desc| desc.format.as_raw() as u32),
                bytes,
                extent: image.map_or([0, 0], |desc| [desc.extent[0], desc.extent[1]]),
                usage,
                is_image: u32::from(is_image),
                name: self.names.resources[place].as_ptr(),
            }
        };
        self.prepared.needs.iter().enumerate().map(row).collect()
    }

    fn is_image(&self, resource: Resource) -> bool {
        matches!(resource, Resource::Environment | Resource::Rectangle)
    }

    fn origin(&self, place: usize) -> AirglowOrigin {
        match &self.prepared.needs[place] {
            (Resource::Environment, _) if self.sky.is_some() => AirglowOrigin::Library,
            (_, Need::Ours { .. }) => AirglowOrigin::Library,
            (_, Need::Host) => AirglowOrigin::Host,
            (_, Need::Scratch(_)) => AirglowOrigin::Scratch,
        }
    }

    /// Bytes that a buffer of the host's must have.
    pub(super) fn host_bytes(&self, resource: Resource) -> u64 {
        let coefficients = self.coefficients;
        let vertices = |instance: u32| {
            self.prepared.ranges.get(instance as usize).map_or(0, |range| u64::from(range.vertices))
        };
        match resource {
            Resource::Results => self.prepared.ranges.last().map_or(0, |range| range.offset + range.size),
            Resource::UniformLight => 16 * coefficients,
            Resource::VertexLight(instance) => 12 * coefficients * vertices(instance),
            Resource::Visibility(instance) => 4 * coefficients * vertices(instance),
            Resource::Normals(instance) => 12 * vertices(instance),
            _ => 0,
        }
    }
}
