//! Compiling with the independent checker looking at the plan.

use airglow_graph::{Graph, Limits, Options, Plan};

use crate::Refusal;

/// Compiles a graph into a plan that the checker finds sound and without a redundant barrier.
///
/// # Errors
/// Why the graph does not compile; a violation or a redundant barrier, with the plan.
pub fn checked<R>(graph: Graph<R>, limits: &Limits, options: &Options) -> Result<Plan<R>, Refusal> {
    let plan = graph.compile_with(limits, options)?;
    match airglow_checker::check(&plan) {
        Ok(report) if report.redundant.is_empty() => Ok(plan),
        Ok(report) => Err(format!("{report}\n{}", plan.text()).into()),
        Err(violation) => Err(format!("{violation}\n{}", plan.text()).into()),
    }
}
