//! From a declaration to a plan, in named phases, one file each:
//! extents -> validate -> hazards -> order -> cull -> lifetimes -> barriers.
//!
//! Hazards come before order: order relies on each resource's versions being one chain, which is what the
//! hazards phase proves.

#[cfg(test)]
mod barrier_tests;
mod barriers;
mod coalesce;
mod cull;
mod epochs;
mod extents;
mod hazards;
mod histories;
mod lifetimes;
mod lives;
mod order;
mod scope;
mod validate;

use crate::declaration::Declaration;
use crate::error::GraphError;
use crate::options::{Limits, Options};
use crate::pass::{Pass, Use};
use crate::plan::{Plan, PlanAccess, Step};
use ash::vk;
use lives::Lives;

/// `payloads` are those of the passes declared, in their order.
pub(crate) fn compile<R>(
    mut declaration: Declaration,
    payloads: Vec<Option<R>>,
    limits: &Limits,
    options: &Options,
) -> Result<Plan<R>, GraphError> {
    extents::extents(&mut declaration, options)?;
    validate::validate(&mut declaration, limits)?;
    let payloads = require_payloads(&declaration, payloads)?;
    let lives = Lives::of(&declaration);
    hazards::hazards(&declaration, &lives)?;
    let order = order::order(&declaration, &lives, options.seed)?;
    let cull = cull::cull(&declaration, &lives);
    let order: Vec<usize> = order.into_iter().filter(|pass| cull.alive[*pass]).collect();
    let resources = lifetimes::lifetimes(&declaration, &order);
    let barriers = barriers::barriers(&declaration, &order, limits);
    let histories = histories::histories(&declaration);
    Ok(Plan {
        steps: steps(declaration.passes, payloads, &order, barriers.steps),
        resources,
        acquires: barriers.acquires,
        final_barriers: barriers.exits,
        releases: barriers.releases,
        culled: cull.culled,
        histories,
        left_out: declaration.left_out,
        pipelines: declaration.pipelines,
        queue_family: limits.queue_family,
    })
}

fn require_payloads<R>(declaration: &Declaration, payloads: Vec<Option<R>>) -> Result<Vec<R>, GraphError> {
    let with_names = payloads.into_iter().zip(&declaration.passes);
    with_names
        .map(|(payload, pass)| {
            payload.ok_or_else(|| GraphError::Pass {
                pass: pass.name.clone(),
                problem: "has no payload".to_owned(),
                mend: "end its declaration with `record`".to_owned(),
            })
        })
        .collect()
}

/// Puts passes, payloads and barriers together, in order.
fn steps<R>(
    passes: Vec<Pass>,
    payloads: Vec<R>,
    order: &[usize],
    barriers: Vec<crate::plan::Barriers>,
) -> Vec<Step<R>> {
    let mut declared: Vec<Option<(Pass, R)>> = passes.into_iter().zip(payloads).map(Some).collect();
    let ordered = order.iter().filter_map(|pass| declared[*pass].take());
    ordered
        .zip(barriers)
        .map(|((pass, payload), barriers)| Step {
            accesses: pass.uses.iter().map(plan_access).collect(),
            name: pass.name,
            kind: pass.kind,
            async_suitable: pass.async_suitable,
            barriers,
            payload,
        })
        .collect()
}

fn plan_access(declared: &Use) -> PlanAccess {
    let Use { resource, version, output, range, access, keeps, is_image } = *declared;
    PlanAccess {
        resource,
        range,
        access,
        stage: access.stage(),
        flags: access.access(),
        layout: if is_image { access.layout() } else { vk::ImageLayout::UNDEFINED },
        version,
        output,
        keeps_contents: keeps,
    }
}
