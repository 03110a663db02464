//! One file for each command: its arguments, and what it does with the rooms of the library.

pub mod compare;

use crate::cli::{Cli, Command};
use crate::failure::Outcome;
use crate::output::Output;

/// Runs the command asked for.
pub fn run(cli: Cli, output: &Output) -> Outcome {
    match cli.command {
        Command::Compare(arguments) => compare::run(&arguments, output),
    }
}
