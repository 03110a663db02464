//! The plan as a mermaid flowchart: passes as boxes, resources as rounded boxes, versions on the arrows.

use super::Plan;
use std::fmt::Write;

impl<R> Plan<R> {
    /// The plan as mermaid's `flowchart`, ending in a newline. Culled passes are dashed.
    pub fn mermaid(&self) -> String {
        let mut out = String::from("flowchart TD\n");
        // Writing to a string cannot fail.
        for (i, resource) in self.resources.iter().enumerate().filter(|(_, r)| r.lifetime.is_some()) {
            let _ = writeln!(out, "  r{i}([\"{}\"])", escape(&resource.name));
        }
        for (i, step) in self.steps.iter().enumerate() {
            let _ = writeln!(out, "  p{i}[\"{}\"]", escape(&step.name));
            for access in &step.accesses {
                let r = access.resource.index();
                let label = format!("v{} {:?}", access.version, access.access);
                let _ = match access.output {
                    None => writeln!(out, "  r{r} -->|\"{label}\"| p{i}"),
                    Some(output) => {
                        let label = format!("v{output} {:?}", access.access);
                        writeln!(out, "  p{i} ==>|\"{label}\"| r{r}")
                    }
                };
            }
        }
        for (i, culled) in self.culled.iter().enumerate() {
            let (pass, reason) = (escape(&culled.pass), escape(&culled.reason.to_string()));
            let _ = writeln!(out, "  c{i}[\"{pass}: {reason}\"]:::culled");
        }
        if !self.culled.is_empty() {
            out.push_str("  classDef culled stroke-dasharray: 4\n");
        }
        out
    }
}

/// Mermaid's entities for what would end a quoted label.
fn escape(name: &str) -> String {
    name.replace('#', "#35;").replace('"', "#quot;")
}
