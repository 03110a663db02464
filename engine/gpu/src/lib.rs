//! Vulkan under a plan: adopt a host's device, memory, pipelines, recording, timing and readback.
//!
//! The library never opens a device, submits, waits or starts a thread. A host hands over its device
//! ([`Context::adopt`]), starts frames ([`Context::begin_frame`]) and has a compiled plan recorded into its own
//! command buffer ([`Execution::record`]). Passes see only safe types: [`Recorder`], [`Resources`], [`Buffer`],
//! [`Image`] and pipelines.

mod adopt;
mod allocator;
mod breadcrumbs;
mod calibration;
mod clock;
mod context;
mod counts;
mod create;
mod error;
mod execute;
mod feature;
mod frame;
mod functions;
mod health;
mod histories;
mod ledger;
mod memory;
mod offer;
#[cfg(feature = "open")]
pub mod open;
mod options;
mod patch;
mod pipeline;
mod readback;
mod recorder;
pub mod requirements;
mod resources;
mod retire;
mod shared;
#[cfg(feature = "surface")]
pub mod surface;
mod tally;
mod timing;
mod transients;

pub use adopt::AdoptInfo;
pub use allocator::{Allocation, Allocator, BlockAllocator, Location, Request};
pub use ash;
pub use breadcrumbs::PassReached;
pub use calibration::Calibration;
pub use context::Context;
pub use counts::Counts;
pub use error::GpuError;
pub use execute::{Execution, Recorded};
pub use feature::{Feature, FeatureSet, FeatureStructs};
pub use health::{Health, HealthCounts};
pub use histories::Histories;
pub use ledger::OwnerBytes;
pub use memory::{Buffer, BufferSlice, Image, ImageView, Label, Sampler, SamplerDesc, ViewDesc};
pub use offer::{Missing, Offer};
pub use options::{DeviceMask, Options};
pub use patch::{FeatureStorage, patch_features};
pub use pipeline::{
    BindingDesc, BindingKind, Blend, ComputePipeline, ComputePipelineDesc, DepthState, GraphicsPipeline,
    GraphicsPipelineDesc, Kernel, MAX_BINDINGS, Outside, Permutations, Pipelines, Stages, VertexAttribute,
    VertexBufferLayout, words,
};
pub use readback::{Readback, texels};
pub use recorder::{Binding, ColorAttachment, DepthAttachment, Load, Recorder, Rendering};
pub use requirements::{FeatureNeed, Requirements};
pub use resources::{Imports, Record, Resources};
pub use tally::{Counted, Look, Records, TALLY_BINDINGS, Tally};
pub use timing::{FrameTimes, PassStatistics, PassTime, Timing, TimingSummary};
