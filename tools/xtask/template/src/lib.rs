//! Exposure: the colours of a buffer times 2^stops.
//!
//! ```text
//! c' = 2^s c         s in stops; alpha stays
//! ```
//! after ISO 12232:2019, in which exposure values are powers of two.
//!
//! ```
//! use airglow___room__::{__Room__, Settings};
//! use airglow_gpu::{Context, Record};
//! use airglow_graph::{Buffer, Graph, Handle};
//!
//! /// Declares the pass behind what made `colours`; a later pass reads the handle that this returns.
//! fn expose(pass: &__Room__, graph: &mut Graph<Record>, colours: Handle<Buffer>, count: u32) -> Handle<Buffer> {
//!     pass.add(graph, colours, count)
//! }
//!
//! /// Once, when the device is there.
//! fn prepare(context: &Context) -> Result<__Room__, airglow___room__::__Room__Error> {
//!     __Room__::new(context, Settings { stops: -1.5 })
//! }
//! ```
#![forbid(unsafe_code)]

pub mod curve;
mod declare;
mod error;
mod record;
pub mod reference;
mod settings;

pub use declare::{ACCESSES, declare};
pub use error::__Room__Error;
pub use record::{BINDINGS, Bindings, PushConstants, __Room__};
pub use settings::{MAX_STOPS, Settings};
