//! One file for each command: its arguments, and what it does with the rooms of the library.

pub mod bake;
pub mod compare;
pub mod devices;
pub mod eval;
pub mod explain;
pub mod plan;
pub mod render;
pub mod report;
pub mod scene;
pub mod stability;

use crate::cli::{Cli, Command};
use crate::failure::Outcome;
use crate::output::Output;

/// Runs the command asked for.
pub fn run(cli: Cli, output: &Output) -> Outcome {
    let global = &cli.global;
    match cli.command {
        Command::Devices(arguments) => devices::run(&arguments, output),
        Command::Bake(arguments) => bake::run(&arguments, output),
        Command::Render(arguments) => render::run(&arguments, global, output),
        Command::Compare(arguments) => compare::run(&arguments, output),
        Command::Plan(arguments) => plan::run(&arguments, global, output),
        Command::Report(arguments) => report::run(&arguments, global, output),
        Command::Stability(arguments) => stability::run(&arguments, global, output),
        Command::Explain(arguments) => explain::run(&arguments, global, output),
        Command::Eval(arguments) => eval::run(&arguments, global, output),
    }
}
