//! Transients in shared memory: no two at once in one place, and a wait for whoever had each byte before.

use crate::event::{holds, written};
use crate::violation::{Kind, Violation};
use airglow_graph::{Placement, Plan, ResourceDesc, Sharing};
use ash::vk::{AccessFlags2 as A, PipelineStageFlags2 as S};

/// Checks what [`Plan::sharing`] proposes, byte by byte.
///
/// # Errors
/// The first two transients in one place at one time, or the first takeover without a sufficient wait.
pub fn check_sharing<R>(plan: &Plan<R>, sharing: &Sharing) -> Result<(), Violation> {
    for to in &sharing.placements {
        let neighbours: Vec<&Placement> =
            sharing.placements.iter().filter(|other| in_one_place(plan, to, other)).collect();
        let at_once = neighbours.iter().find(|other| {
            let (a, b) = (to.lifetime, other.lifetime);
            other.resource != to.resource && a.first <= b.last && b.first <= a.last
        });
        if let Some(other) = at_once {
            let problem = format!("shares bytes with `{}` while both are in use", name(plan, other));
            return Err(fail(plan, to, problem, "place one of them elsewhere"));
        }
        // Between neighbouring ends of places every byte has the same predecessor.
        let mut ends: Vec<u64> = neighbours.iter().flat_map(|p| [p.offset, p.offset + p.bytes]).collect();
        ends.retain(|end| (to.offset..to.offset + to.bytes).contains(end));
        for byte in ends {
            let here = neighbours.iter().filter(|p| (p.offset..p.offset + p.bytes).contains(&byte));
            let before = |p: &&&Placement| (p.lifetime.last < to.lifetime.first, p.lifetime.last);
            match here.max_by_key(before) {
                Some(from) if from.resource != to.resource => check_handover(plan, sharing, from, to)?,
                _ => {}
            }
        }
    }
    Ok(())
}

/// Whether two places have bytes in common; buffers and images are in heaps of their own.
fn in_one_place<R>(plan: &Plan<R>, a: &Placement, b: &Placement) -> bool {
    let is_image = |p: &Placement| {
        let resource = plan.resources().get(p.resource.index());
        resource.is_some_and(|resource| matches!(resource.desc, ResourceDesc::Image(_)))
    };
    is_image(a) == is_image(b) && a.offset < b.offset + b.bytes && b.offset < a.offset + a.bytes
}

fn check_handover<R>(
    plan: &Plan<R>,
    sharing: &Sharing,
    from: &Placement,
    to: &Placement,
) -> Result<(), Violation> {
    let (first, second) = (scope(plan, from), scope(plan, to));
    let waits = sharing.handovers.iter().any(|handover| {
        (handover.from, handover.to, handover.before) == (from.resource, to.resource, to.lifetime.first)
            && holds(handover.src_stage, first.0)
            && handover.src_access.contains(written(first.1))
            && holds(handover.dst_stage, second.0)
            && handover.dst_access.contains(second.1)
    });
    if waits {
        return Ok(());
    }
    let problem = format!("takes memory over from `{}` without waiting for all of it", name(plan, from));
    let mend = format!("hand over from {:?} / {:?} to {:?}", first.0, written(first.1), second.0);
    Err(fail(plan, to, problem, &mend))
}

/// All stages and accesses of a transient.
fn scope<R>(plan: &Plan<R>, of: &Placement) -> (S, A) {
    let uses = plan.accesses().filter(|(_, used)| used.resource == of.resource);
    uses.fold((S::NONE, A::NONE), |(stage, access), (_, used)| (stage | used.stage, access | used.flags))
}

fn name<R>(plan: &Plan<R>, of: &Placement) -> String {
    let resource = plan.resources().get(of.resource.index());
    resource.map_or_else(|| "?".to_owned(), |resource| resource.name.to_string())
}

fn fail<R>(plan: &Plan<R>, at: &Placement, problem: String, mend: &str) -> Violation {
    let step = plan.steps().get(at.lifetime.first);
    Violation {
        kind: Kind::Sharing,
        place: step.map_or_else(|| "?".to_owned(), |step| format!("pass `{}`", step.name)),
        resource: name(plan, at),
        mip: 0,
        layer: 0,
        problem,
        mend: mend.to_owned(),
    }
}
