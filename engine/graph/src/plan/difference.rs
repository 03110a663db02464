//! What another declaration would change: passes, resources, bytes, barriers, and what is left out.

use super::{Plan, PlanBytes};
use std::collections::BTreeSet;
use std::fmt::{self, Display, Formatter};

/// From one plan to another. Passes and resources are the same where their names are.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct PlanDifference {
    /// Passes only the second plan runs, in its order.
    pub passes_added: Vec<String>,
    /// Passes only the first plan runs, in its order.
    pub passes_removed: Vec<String>,
    /// Resources only the second plan uses.
    pub resources_added: Vec<String>,
    /// Resources only the first plan uses.
    pub resources_removed: Vec<String>,
    /// Resources both use, of different size.
    pub resized: Vec<Resized>,
    /// What only the second plan leaves out.
    pub left_out: Vec<String>,
    /// What only the first plan leaves out.
    pub brought_back: Vec<String>,
    /// Barriers of the first plan and of the second.
    pub barriers: [usize; 2],
    /// Pipelines that all rooms together hold ready, in the first plan and in the second.
    pub pipelines: [usize; 2],
    /// Bytes of the first plan and of the second.
    pub bytes: [PlanBytes; 2],
}

/// A resource of another size.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Resized {
    /// Its name.
    pub resource: String,
    /// Bytes in the first plan and in the second, where known before allocation.
    pub bytes: [Option<u64>; 2],
}

impl<R> Plan<R> {
    /// What changes from this plan to another.
    pub fn difference<S>(&self, other: &Plan<S>) -> PlanDifference {
        let (passes, other_passes) = (self.pass_names(), other.pass_names());
        let (resources, other_resources) = (self.used_names(), other.used_names());
        let (left_out, other_left_out) = (self.left_out_names(), other.left_out_names());
        PlanDifference {
            passes_added: without(&other_passes, &passes),
            passes_removed: without(&passes, &other_passes),
            resources_added: without(&other_resources, &resources),
            resources_removed: without(&resources, &other_resources),
            resized: self.resized(other),
            left_out: without(&other_left_out, &left_out),
            brought_back: without(&left_out, &other_left_out),
            barriers: [self.barrier_count(), other.barrier_count()],
            pipelines: [self.pipeline_count(), other.pipeline_count()],
            bytes: [self.bytes(), other.bytes()],
        }
    }

    /// All barriers: acquires, before steps, final, releases.
    pub fn barrier_count(&self) -> usize {
        let steps: usize = self.steps.iter().map(|step| step.barriers.len()).sum();
        self.acquires.len() + steps + self.final_barriers.len() + self.releases.len()
    }

    fn pipeline_count(&self) -> usize {
        self.pipelines.iter().map(|room| room.prepared).sum()
    }

    fn pass_names(&self) -> Vec<&str> {
        self.steps.iter().map(|step| step.name.as_ref()).collect()
    }

    fn used_names(&self) -> Vec<&str> {
        let used = self.resources.iter().filter(|resource| resource.lifetime.is_some());
        used.map(|resource| resource.name.as_ref()).collect()
    }

    fn left_out_names(&self) -> Vec<&str> {
        self.left_out.iter().map(|left_out| left_out.what.as_ref()).collect()
    }

    fn resized<S>(&self, other: &Plan<S>) -> Vec<Resized> {
        let mut resized = Vec::new();
        for resource in self.resources.iter().filter(|resource| resource.lifetime.is_some()) {
            let same = other.resources.iter().find(|o| o.name == resource.name && o.lifetime.is_some());
            if let Some(same) = same.filter(|same| same.bytes != resource.bytes) {
                let bytes = [resource.bytes, same.bytes];
                resized.push(Resized { resource: resource.name.to_string(), bytes });
            }
        }
        resized
    }
}

/// The names of `all` that are not among `known`, in order.
fn without(all: &[&str], known: &[&str]) -> Vec<String> {
    let known: BTreeSet<&str> = known.iter().copied().collect();
    all.iter().filter(|name| !known.contains(**name)).map(|name| (*name).to_owned()).collect()
}

impl PlanDifference {
    /// Whether nothing changes that a difference tells.
    pub fn is_empty(&self) -> bool {
        let Self { barriers, pipelines, bytes, .. } = *self;
        let same = Self { barriers, pipelines, bytes, ..Self::default() };
        *self == same && barriers[0] == barriers[1] && pipelines[0] == pipelines[1] && bytes[0] == bytes[1]
    }
}

impl Display for PlanDifference {
    /// One fact a line: `+` for what only the second plan has, `-` for what only the first has, `~` for a change.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return writeln!(f, "no difference");
        }
        let lists = [
            ("+ pass", &self.passes_added),
            ("- pass", &self.passes_removed),
            ("+ resource", &self.resources_added),
            ("- resource", &self.resources_removed),
            ("+ left out", &self.left_out),
            ("- left out", &self.brought_back),
        ];
        for (word, names) in lists {
            names.iter().try_for_each(|name| writeln!(f, "{word} {name}"))?;
        }
        let known = |bytes: Option<u64>| bytes.map_or("unknown".to_owned(), |bytes| format!("{bytes} B"));
        for Resized { resource, bytes: [before, after] } in &self.resized {
            writeln!(f, "~ resource {resource}: {} -> {}", known(*before), known(*after))?;
        }
        let [before, after] = self.bytes;
        let counts = [
            ("barriers", self.barriers[0] as u64, self.barriers[1] as u64, ""),
            ("pipelines", self.pipelines[0] as u64, self.pipelines[1] as u64, ""),
            ("imported", before.imported, after.imported, " B"),
            ("transient", before.transient, after.transient, " B"),
            ("transient at once", before.transient_peak, after.transient_peak, " B"),
        ];
        for (name, before, after, unit) in counts.into_iter().filter(|(_, before, after, _)| before != after)
        {
            let change = i128::from(after) - i128::from(before);
            writeln!(f, "~ {name}: {before}{unit} -> {after}{unit} ({change:+}{unit})")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::{Access, BufferDesc, Graph, LeftOut, Limits, PassKind, Plan};

    fn plan(size: u64, emitters: bool) -> Plan<()> {
        let mut graph = Graph::new();
        graph.pipelines("relight", 2);
        graph.pipelines("relight", usize::from(emitters));
        let mut relight = graph.pass("relight", PassKind::Compute);
        let mut colours =
            relight.create_buffer("colours", BufferDesc::new(size), Access::ComputeStorageWrite);
        relight.record(());
        if emitters {
            let mut pass = graph.pass("emitters", PassKind::Compute);
            colours = pass.update(colours, Access::ComputeStorageReadWrite);
            pass.record(());
        } else {
            graph.leave_out(LeftOut {
                what: "emitters".to_owned(),
                why: "none".to_owned(),
                bytes: 0,
                time: None,
                would_return: "one".to_owned(),
            });
        }
        graph.export(colours, Access::VertexBuffer);
        graph.compile(&Limits::default()).unwrap()
    }

    #[test]
    fn a_difference_names_what_comes_and_goes() {
        let difference = plan(16, true).difference(&plan(32, false));
        let expected = "- pass emitters\n+ left out emitters\n~ resource colours: 16 B -> 32 B\n\
                        ~ barriers: 3 -> 2 (-1)\n~ pipelines: 3 -> 2 (-1)\n~ transient: 16 B -> 32 B (+16 B)\n\
                        ~ transient at once: 16 B -> 32 B (+16 B)\n";
        assert_eq!(difference.to_string(), expected);
    }

    #[test]
    fn a_plan_does_not_differ_from_itself() {
        let difference = plan(16, true).difference(&plan(16, true));
        assert!(difference.is_empty());
        assert_eq!(difference.to_string(), "no difference\n");
    }
}
