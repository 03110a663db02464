//! The plan as text made to be diffed: one fact a line, names instead of numbers, so that one more pass adds
//! its own lines and changes no others.

use super::{Barriers, CullReason, ImageBarrier, Plan, PlanAccess, PlanResource, Step};
use crate::handle::{ImageRange, ResourceId};
use crate::resource::{Origin, ResourceDesc};
use ash::vk::{self, AccessFlags2, PipelineStageFlags2};
use std::fmt::{self, Display, Formatter, Write};

impl<R> Plan<R> {
    /// The plan as text, ending in a newline.
    pub fn text(&self) -> String {
        let mut out = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_text(&mut out);
        out
    }

    fn write_text(&self, out: &mut String) -> fmt::Result {
        writeln!(out, "resources")?;
        for resource in &self.resources {
            self.write_resource(out, resource)?;
        }
        self.write_barriers(out, "acquire", "  ", &self.acquires)?;
        writeln!(out, "steps")?;
        for step in &self.steps {
            self.write_step(out, step)?;
        }
        self.write_barriers(out, "exit", "  ", &self.final_barriers)?;
        self.write_barriers(out, "release", "  ", &self.releases)?;
        writeln!(out, "culled")?;
        for culled in &self.culled {
            writeln!(out, "  {}: {}", culled.pass, culled.reason)?;
        }
        writeln!(out, "left out")?;
        for left in &self.left_out {
            let time = left.time.map_or("not measured".to_owned(), |time| format!("{:.3} ms", time * 1e3));
            let crate::LeftOut { what, why, bytes, would_return, .. } = left;
            writeln!(out, "  {what}: {why}; saves {bytes} B, time {time}; returns with {would_return}")?;
        }
        if !self.pipelines.is_empty() {
            writeln!(out, "pipelines")?;
        }
        for crate::RoomPipelines { room, prepared } in &self.pipelines {
            writeln!(out, "  {room}: {prepared} prepared")?;
        }
        let bytes = self.bytes();
        writeln!(out, "bytes")?;
        writeln!(out, "  imported {} B", bytes.imported)?;
        writeln!(out, "  transient {} B, at most {} B at once", bytes.transient, bytes.transient_peak)?;
        if bytes.sharing_would_save > 0 {
            writeln!(out, "  sharing memory would save about {} B", bytes.sharing_would_save)?;
        }
        Ok(())
    }

    fn write_resource(&self, out: &mut String, resource: &PlanResource) -> fmt::Result {
        write!(out, "  {}: {}", resource.name, resource.desc)?;
        match resource.origin {
            Origin::Imported { .. } => write!(out, ", imported")?,
            Origin::Transient => write!(out, ", transient")?,
        }
        if !resource.exports.is_empty() {
            write!(out, ", exported")?;
        }
        match resource.lifetime {
            Some(l) => writeln!(out, ", {} .. {}", self.steps[l.first].name, self.steps[l.last].name),
            None => writeln!(out, ", not used"),
        }
    }

    fn write_step(&self, out: &mut String, step: &Step<R>) -> fmt::Result {
        let suitable = if step.async_suitable { ", async suitable" } else { "" };
        writeln!(out, "  {} ({:?}{suitable})", step.name, step.kind)?;
        self.write_barriers(out, "barrier", "    ", &step.barriers)?;
        for access in &step.accesses {
            writeln!(out, "    {}", self.access_line(access))?;
        }
        Ok(())
    }

    fn access_line(&self, access: &PlanAccess) -> String {
        let resource = &self.resources[access.resource.index()];
        let verb = match (access.output, access.keeps_contents) {
            (None, _) => "read",
            (Some(_), true) => "update",
            (Some(_), false) => "write",
        };
        let version = match access.output {
            Some(output) => format!("v{} -> v{output}", access.version),
            None => format!("v{}", access.version),
        };
        let part = part(resource, access.range);
        format!("{verb} {}{part} {version} as {:?}", resource.name, access.access)
    }

    fn write_barriers(&self, out: &mut String, word: &str, indent: &str, barriers: &Barriers) -> fmt::Result {
        let name = |id: ResourceId| &self.resources[id.index()];
        for b in &barriers.buffers {
            let scopes = scopes(b.src_stage, b.src_access, b.dst_stage, b.dst_access);
            let families = families(b.src_queue_family, b.dst_queue_family);
            let name = &name(b.resource).name;
            writeln!(
                out,
                "{indent}{word} {name}: {scopes}{families}; {:?} {}",
                b.cause,
                self.after(b.after)
            )?;
        }
        for b in &barriers.images {
            let ImageBarrier { old_layout, new_layout, .. } = b;
            let scopes = scopes(b.src_stage, b.src_access, b.dst_stage, b.dst_access);
            let layouts = match old_layout == new_layout {
                true => String::new(),
                false => format!(", {old_layout:?} -> {new_layout:?}"),
            };
            let families = families(b.src_queue_family, b.dst_queue_family);
            let part = part(name(b.resource), b.range);
            let name = &name(b.resource).name;
            let after = self.after(b.after);
            writeln!(out, "{indent}{word} {name}{part}: {scopes}{layouts}{families}; {:?} {after}", b.cause)?;
        }
        Ok(())
    }

    fn after(&self, step: Option<usize>) -> String {
        match step {
            Some(step) => format!("after {}", self.steps[step].name),
            None => "from before the plan".to_owned(),
        }
    }
}

/// Flags as ash names them, `NONE` for none.
pub(super) fn flags(debug: impl fmt::Debug) -> String {
    let text = format!("{debug:?}");
    if text.is_empty() { "NONE".to_owned() } else { text }
}

fn scopes(
    src_stage: PipelineStageFlags2,
    src_access: AccessFlags2,
    dst_stage: PipelineStageFlags2,
    dst_access: AccessFlags2,
) -> String {
    let side = |stage, access| format!("{} / {}", flags(stage), flags(access));
    format!("{} -> {}", side(src_stage, src_access), side(dst_stage, dst_access))
}

fn families(from: u32, to: u32) -> String {
    let name = |family: u32| match family {
        vk::QUEUE_FAMILY_EXTERNAL => "external".to_owned(),
        vk::QUEUE_FAMILY_FOREIGN_EXT => "foreign".to_owned(),
        family => family.to_string(),
    };
    if from == to { String::new() } else { format!(", queue family {} -> {}", name(from), name(to)) }
}

/// ` mips 0..2 layers 0..6`, or nothing for the whole of a resource.
fn part(resource: &PlanResource, range: ImageRange) -> String {
    let (mips, layers) = resource.desc.subresources();
    let span = |word: &str, base: u32, count: u32, total: u32| match count == total {
        true => String::new(),
        false => format!(" {word} {base}..{}", base + count),
    };
    span("mips", range.base_mip, range.mips, mips) + &span("layers", range.base_layer, range.layers, layers)
}

impl Display for ResourceDesc {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Buffer(buffer) => write!(f, "buffer {} B, usage {}", buffer.size, flags(buffer.usage)),
            Self::Image(image) => {
                let [x, y, z] = image.extent;
                write!(f, "image {x}x{y}x{z} {:?}", image.format)?;
                write!(f, ", {} mips, {} layers", image.mips, image.layers)?;
                if image.cube {
                    write!(f, " (cube)")?;
                }
                write!(f, ", samples {}, usage {}", image.samples.as_raw(), flags(image.usage))
            }
        }
    }
}

impl Display for CullReason {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::WritesNothing => write!(f, "it writes nothing and has no side effect"),
            Self::Unread { resources } => {
                write!(f, "nothing reads or exports what it writes ({})", resources.join(", "))
            }
            Self::ReadOnlyByCulled { resources, readers } => {
                let (resources, readers) = (resources.join(", "), readers.join(", "));
                write!(f, "only culled passes ({readers}) read what it writes ({resources})")
            }
        }
    }
}
