//! Plans as text, JSON or a diagram.
#![allow(dead_code, reason = "helpers of passes, of which there may be none")]

use airglow_gpu::{Context, Record};
use airglow_graph::Graph;

use crate::status::Failure;
use crate::text::{AirglowText, write_text};

/// How a plan is written.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowPlanFormat {
    /// Text made to be compared.
    Text = 0,
    /// JSON.
    Json = 1,
    /// A mermaid diagram.
    Mermaid = 2,
}

/// Compiles a graph and writes its plan in the format that the host numbers.
///
/// # Safety
/// As [`write_text`].
pub(crate) unsafe fn write_plan(
    context: &Context,
    graph: Graph<Record>,
    format: u32,
    text: *mut AirglowText,
) -> Result<(), Failure> {
    const JSON: u32 = AirglowPlanFormat::Json as u32;
    const MERMAID: u32 = AirglowPlanFormat::Mermaid as u32;
    let problem = |error: &dyn std::error::Error| Failure::argument("the frame", &error.to_string());
    let plan = graph.compile(&context.graph_limits()).map_err(|error| problem(&error))?;
    let written = match format {
        0 => plan.text(),
        JSON => plan.json().map_err(|error| problem(&error))?,
        MERMAID => plan.mermaid(),
        _ => return Err(Failure::argument("format", "give an AirglowPlanFormat")),
    };
    // SAFETY: the caller's promise is ours.
    unsafe { write_text(text, &written) }
}
