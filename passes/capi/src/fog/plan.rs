//! What our graph makes of a view: its plan as text, as JSON or as a diagram.

use airglow_fog::{ACCESSES, Fog, Frame};
use airglow_gpu::Record;
use airglow_gpu::ash::vk::{Format, ImageUsageFlags};
use airglow_graph::{Graph, ImageDesc};

use super::AirglowFog;
use super::view::AirglowFogView;
use crate::input::{shared, versioned};
use crate::plan::write_plan;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::AirglowText;

/// Writes the plan that the library's graph makes of a view of `width * height` pixels: what it uses, its barriers, and
/// what was left out, why, and what would bring it back. The host's images are handed over as their use wants them; depth
/// is of 32 bits. The format is an `AirglowPlanFormat`.
///
/// # Safety
/// `view` as with `airglow_fog_prepare`; `text` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_plan(
    fog: *const AirglowFog,
    width: u32,
    height: u32,
    view: *const AirglowFogView,
    format: u32,
    text: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let AirglowFog { context, fog } = shared(fog, "fog")?;
            let graph = graph(fog, [width, height], &versioned(view, "view")?)?;
            write_plan(context, graph, format, text)
        })
    }
}

/// # Safety
/// As [`AirglowFogView::read`].
unsafe fn graph(fog: &Fog, size: [u32; 2], view: &AirglowFogView) -> Result<Graph<Record>, Failure> {
    // SAFETY: the caller's promise is ours.
    let view = unsafe { view.read(fog.settings().phase, Vec::new())? };
    let mut graph = Graph::<Record>::new();
    let formats = [fog.settings().format, Format::D32_SFLOAT, fog.settings().format];
    let [surface, depth, target] = [0, 1, 2].map(|at| {
        let (name, access) = ACCESSES[at];
        let usage = access.image_usage() | ImageUsageFlags::SAMPLED;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(size[0], size[1], formats[at]) };
        graph.import_image(&format!("{name} of the host"), desc, access, access)
    });
    fog.add(&mut graph, &Frame { size, surface, depth, target: Some(target), view })?;
    Ok(graph)
}
