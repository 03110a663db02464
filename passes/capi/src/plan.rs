//! Plans as text, JSON or a diagram.
#![allow(dead_code, reason = "helpers of passes, of which there may be none")]

use airglow_graph::Plan;

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

/// Writes a plan in the format that the host numbers.
///
/// # Safety
/// As [`write_text`].
pub(crate) unsafe fn write_plan<R>(
    plan: &Plan<R>,
    format: u32,
    text: *mut AirglowText,
) -> Result<(), Failure> {
    const JSON: u32 = AirglowPlanFormat::Json as u32;
    const MERMAID: u32 = AirglowPlanFormat::Mermaid as u32;
    let written = match format {
        0 => plan.text(),
        JSON => plan.json().map_err(|error| Failure::argument("the plan", &error.to_string()))?,
        MERMAID => plan.mermaid(),
        _ => return Err(Failure::argument("format", "give an AirglowPlanFormat")),
    };
    // SAFETY: the caller's promise is ours.
    unsafe { write_text(text, &written) }
}
