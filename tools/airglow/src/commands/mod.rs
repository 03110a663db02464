//! One file for each command: its arguments, and what it does with the rooms of the library.

pub mod bake;
pub mod compare;
#[cfg(feature = "relight")]
pub mod debug;
pub mod devices;
#[cfg(feature = "relight")]
pub mod eval;
#[cfg(feature = "relight")]
pub mod explain;
#[cfg(all(feature = "relight", feature = "shadow"))]
pub mod film;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod maps;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod maps_baked;
#[cfg(feature = "relight")]
pub mod plan;
#[cfg(feature = "relight")]
pub mod render;
#[cfg(feature = "relight")]
pub mod report;
#[cfg(feature = "relight")]
pub mod report_frame;
pub mod requirements;
pub mod scene;
#[cfg(all(feature = "relight", feature = "shadow"))]
pub mod spheres;
#[cfg(feature = "relight")]
pub mod stability;
#[cfg(all(feature = "view", feature = "relight"))]
pub mod view;
#[cfg(feature = "relight")]
pub mod what_if;
#[cfg(feature = "relight")]
pub mod without;

use crate::cli::{Cli, Command};
use crate::failure::Outcome;
use crate::output::Output;

/// Runs the command asked for.
pub fn run(cli: Cli, output: &Output) -> Outcome {
    let global = &cli.global;
    match cli.command {
        Command::Devices(arguments) => devices::run(&arguments, output),
        Command::Requirements(arguments) => requirements::run(&arguments, output),
        Command::Bake(arguments) => bake::run(&arguments, output),
        #[cfg(feature = "relight")]
        Command::Render(arguments) => render::run(&arguments, global, output),
        #[cfg(all(feature = "view", feature = "relight"))]
        Command::View(arguments) => view::run(&arguments, global, output),
        #[cfg(all(feature = "relight", feature = "shadow"))]
        Command::Film(arguments) => film::run(&arguments, global, output),
        #[cfg(all(feature = "relight", feature = "shadow"))]
        Command::Spheres(arguments) => spheres::run(&arguments, output),
        #[cfg(all(feature = "normals", feature = "relight"))]
        Command::Maps(arguments) => maps::run(&arguments, global, output),
        Command::Compare(arguments) => compare::run(&arguments, output),
        #[cfg(feature = "relight")]
        Command::Plan(arguments) => plan::run(&arguments, global, output),
        #[cfg(feature = "relight")]
        Command::Report(arguments) => report::run(&arguments, global, output),
        #[cfg(feature = "relight")]
        Command::Stability(arguments) => stability::run(&arguments, global, output),
        #[cfg(feature = "relight")]
        Command::Explain(arguments) => explain::run(&arguments, global, output),
        #[cfg(feature = "relight")]
        Command::Eval(arguments) => eval::run(&arguments, global, output),
    }
}
