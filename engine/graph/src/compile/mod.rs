//! From a declaration to a plan, in named phases.

use crate::error::GraphError;
use crate::graph::{Graph, Limits};
use crate::plan::Plan;

pub(crate) fn compile<R>(graph: Graph<R>, limits: &Limits) -> Result<Plan<R>, GraphError> {
    let _ = limits;
    Err(GraphError::Pass {
        pass: graph.declaration.passes.first().map(|p| p.name.clone()).unwrap_or_default(),
        problem: "the phases of the compiler are not linked in".to_owned(),
        mend: "wait for the next revision".to_owned(),
    })
}
