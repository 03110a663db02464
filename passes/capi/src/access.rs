//! What a prepared frame uses, as data for the host's own frame graph.
#![allow(dead_code, reason = "helpers of passes, of which there may be none")]

use std::ffi::{CString, c_char};

use airglow_gpu::ash::vk::{BufferUsageFlags, ImageUsageFlags};
use airglow_graph::{Access, ResourceDesc};

use crate::status::Failure;

/// Where a resource of a frame comes from.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowOrigin {
    /// The library keeps it and synchronises it.
    Library = 0,
    /// The host gives it, bound when the frame is recorded.
    Host = 1,
    /// It lives within the frame: bound by the host, or made by `airglow_prepared_make_scratch`.
    Scratch = 2,
}

/// One use of one resource by one step. Elements of arrays never grow; names live as long as the prepared frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowAccess {
    /// An enumeration of the pass: `AirglowRelightResource`, `AirglowFogResource` and the like.
    pub resource: u32,
    /// See there; 0 where nothing is said.
    pub index: u32,
    /// An `AirglowOrigin`.
    pub origin: u32,
    /// The step, counted from 0 in the order of recording.
    pub step: u32,
    /// `VkPipelineStageFlags2`.
    pub stage: u64,
    /// `VkAccessFlags2`.
    pub access: u64,
    /// `VkImageLayout`; 0 for buffers.
    pub layout: u32,
    /// 1: the step writes it.
    pub writes: u32,
    /// Name of the resource.
    pub name: *const c_char,
    /// Name of the step.
    pub step_name: *const c_char,
}

/// One resource of a frame. Elements of arrays never grow; names live as long as the prepared frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowResourceInfo {
    /// See `AirglowAccess`.
    pub resource: u32,
    /// See `AirglowAccess`.
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

/// A resource as the header numbers it: kind and index.
pub(crate) type Number = (u32, u32);

/// What a pass says of a resource.
pub(crate) enum What {
    /// A buffer of so many bytes.
    Buffer(AirglowOrigin, u64),
    /// An image.
    Image(AirglowOrigin),
    /// What lives within the frame.
    Scratch(ResourceDesc),
}

/// A resource of a frame, as its pass says it.
pub(crate) struct Resource {
    pub number: Number,
    pub name: String,
    pub what: What,
}

/// A step of a frame: its name, and each resource that it uses.
pub(crate) struct Step<'a> {
    pub name: &'a str,
    pub uses: Vec<(Number, Access)>,
}

/// All that a frame uses, as the host reads it.
pub(crate) struct Uses {
    pub resources: Vec<AirglowResourceInfo>,
    pub accesses: Vec<AirglowAccess>,
    /// What is to be made, by the number of its resource.
    pub scratch: Vec<(Number, ResourceDesc)>,
    /// Names of the resources in their order.
    pub names: Vec<String>,
    /// What the host was given pointers to.
    _texts: Vec<CString>,
}

impl Uses {
    /// Uses of resources that are not listed are left out.
    pub(crate) fn new(resources: Vec<Resource>, steps: &[Step<'_>]) -> Self {
        // None of them has a nul within.
        let text = |name: &str| CString::new(name).unwrap_or_default();
        let names: Vec<_> = resources.iter().map(|resource| text(&resource.name)).collect();
        let step_names: Vec<_> = steps.iter().map(|step| text(step.name)).collect();
        let named = resources.iter().zip(&names);
        let rows: Vec<_> =
            named.map(|(resource, name)| info(resource, uses(steps, resource.number), name)).collect();
        let mut accesses = Vec::new();
        for (place, (step, step_name)) in (0..).zip(steps.iter().zip(&step_names)) {
            for (number, access) in &step.uses {
                let row = rows.iter().find(|row| (row.resource, row.index) == *number);
                accesses.extend(row.map(|row| used(row, *access, place, step_name)));
            }
        }
        let scratch = |resource: &Resource| match &resource.what {
            What::Scratch(desc) => Some((resource.number, *desc)),
            _ => None,
        };
        let scratch = resources.iter().filter_map(scratch).collect();
        let (names, texts) = (resources.into_iter().map(|resource| resource.name).collect(), names);
        Self {
            resources: rows,
            accesses,
            scratch,
            names,
            _texts: texts.into_iter().chain(step_names).collect(),
        }
    }

    /// The resource of a number, with its name.
    pub(crate) fn find(&self, number: Number) -> Option<(&AirglowResourceInfo, &str)> {
        let mut all = self.resources.iter().zip(&self.names);
        let (row, name) = all.find(|(row, _)| (row.resource, row.index) == number)?;
        Some((row, name))
    }

    /// The resource of a number that the host binds, with its name.
    pub(crate) fn wanted(&self, (wanted, index): Number) -> Result<(&AirglowResourceInfo, &str), Failure> {
        match self.find((wanted, index)) {
            Some((row, name)) if row.origin == AirglowOrigin::Library as u32 => {
                Err(Failure::argument(name, "it is the library's own; leave it out of the bindings"))
            }
            Some(found) => Ok(found),
            None => {
                let problem =
                    format!("the frame does not use resource {wanted}, index {index}; leave it out");
                Err(Failure::argument("bindings", &problem))
            }
        }
    }
}

/// The uses of a resource, in order.
fn uses(steps: &[Step<'_>], number: Number) -> impl Iterator<Item = Access> {
    let all = steps.iter().flat_map(|step| &step.uses);
    all.filter(move |(used, _)| *used == number).map(|(_, access)| *access)
}

/// A resource as the host reads it.
fn info(resource: &Resource, uses: impl Iterator<Item = Access>, name: &CString) -> AirglowResourceInfo {
    let (origin, bytes, image) = match &resource.what {
        What::Buffer(origin, bytes) => (*origin, *bytes, None),
        What::Image(origin) => (*origin, 0, Some(None)),
        What::Scratch(ResourceDesc::Buffer(desc)) => (AirglowOrigin::Scratch, desc.size, None),
        What::Scratch(ResourceDesc::Image(desc)) => {
            (AirglowOrigin::Scratch, desc.bytes().unwrap_or(0), Some(Some(desc)))
        }
    };
    let buffer = BufferUsageFlags::empty();
    let usage = match image {
        Some(_) => uses.fold(ImageUsageFlags::empty(), |all, access| all | access.image_usage()).as_raw(),
        None => uses.fold(buffer, |all, access| all | access.buffer_usage()).as_raw(),
    };
    let desc = image.flatten();
    AirglowResourceInfo {
        resource: resource.number.0,
        index: resource.number.1,
        origin: origin as u32,
        format: desc.map_or(0, |desc| desc.format.as_raw() as u32),
        bytes,
        extent: desc.map_or([0, 0], |desc| [desc.extent[0], desc.extent[1]]),
        usage,
        is_image: u32::from(image.is_some()),
        name: name.as_ptr(),
    }
}

/// A use as the host reads it.
fn used(row: &AirglowResourceInfo, access: Access, step: u32, step_name: &CString) -> AirglowAccess {
    AirglowAccess {
        resource: row.resource,
        index: row.index,
        origin: row.origin,
        step,
        stage: access.stage().as_raw(),
        access: access.access().as_raw(),
        layout: if row.is_image == 1 { access.layout().as_raw() as u32 } else { 0 },
        writes: u32::from(access.writes()),
        name: row.name,
        step_name: step_name.as_ptr(),
    }
}
