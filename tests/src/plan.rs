//! Compiling as every test does: with the independent checker looking at the plan.

use airglow_conformance::plan::checked;
use airglow_graph::{Graph, Limits, Options, Plan};

/// Compiles, and fails the test unless the checker finds the plan sound and no barrier redundant.
///
/// # Panics
/// On a graph that does not compile, a violation, or a redundant barrier, with the plan.
pub fn compile<R>(graph: Graph<R>, limits: &Limits) -> Plan<R> {
    compile_with(graph, limits, &Options::default())
}

/// [`compile`] with choices.
///
/// # Panics
/// As [`compile`].
pub fn compile_with<R>(graph: Graph<R>, limits: &Limits, options: &Options) -> Plan<R> {
    checked(graph, limits, options).unwrap_or_else(|problem| panic!("{problem}"))
}
