//! Uses of resources as data, for the host's own frame graph.

use std::ffi::c_char;

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
    /// An `AirglowResource`, in fog an `AirglowFogResource`.
    pub resource: u32,
    /// See there.
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
