//! The command line: what can be asked, in words that need no prior knowledge of the project.

use clap::{Parser, Subcommand};

#[cfg(all(feature = "normals", feature = "relight"))]
use crate::commands::maps;
#[cfg(all(feature = "view", feature = "relight"))]
use crate::commands::view;
use crate::commands::{bake, compare, devices, requirements};
#[cfg(feature = "relight")]
use crate::commands::{eval, explain, plan, render, report, stability};
#[cfg(all(feature = "relight", feature = "shadow"))]
use crate::commands::{film, spheres};
use crate::failure::Outcome;
use crate::global::Global;
use crate::output::Output;

const FIRST_STEPS: &str = "\
First steps:
  airglow devices                                 list the Vulkan devices of this machine
  airglow render assets/scenes/spot.toml -o spot.png
                                                  bake (once, then cached) and draw a scene
  airglow view assets/scenes/spot.toml            the same, live in a window
  airglow plan assets/scenes/spot.toml            show what a frame does, and what it leaves out
  airglow report relight -o out/report            measure the pass: error against time

Exit codes:
  0  done
  1  failed while working (files, Vulkan)
  2  the command line could not be understood
  3  a check failed (compare --max-flip, stability, --validate)
  4  no device fits --device, or it lacks something that is required
  5  an input was refused (scene, environment, CSV); the message says how to mend it";

/// Real-time lighting passes for Vulkan: bake, draw, measure and explain.
#[derive(Debug, Parser)]
#[command(name = "airglow", version, after_help = FIRST_STEPS, arg_required_else_help = true)]
pub struct Cli {
    #[command(flatten)]
    pub global: Global,
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    Devices(devices::Arguments),
    Requirements(requirements::Arguments),
    Bake(bake::Arguments),
    #[cfg(feature = "relight")]
    Render(render::Arguments),
    #[cfg(all(feature = "view", feature = "relight"))]
    View(view::Arguments),
    #[cfg(all(feature = "relight", feature = "shadow"))]
    Film(film::Arguments),
    #[cfg(all(feature = "relight", feature = "shadow"))]
    Spheres(spheres::Arguments),
    #[cfg(all(feature = "normals", feature = "relight"))]
    Maps(maps::Arguments),
    Compare(compare::Arguments),
    #[cfg(feature = "relight")]
    Plan(plan::Arguments),
    #[cfg(feature = "relight")]
    Report(report::Arguments),
    #[cfg(feature = "relight")]
    Stability(stability::Arguments),
    #[cfg(feature = "relight")]
    Explain(explain::Arguments),
    #[cfg(feature = "relight")]
    Eval(eval::Arguments),
}

impl Command {
    /// Runs the command asked for.
    pub fn run(self, global: &Global, output: &Output) -> Outcome {
        match self {
            Self::Devices(arguments) => devices::run(&arguments, output),
            Self::Requirements(arguments) => requirements::run(&arguments, output),
            Self::Bake(arguments) => bake::run(&arguments, output),
            #[cfg(feature = "relight")]
            Self::Render(arguments) => render::run(&arguments, global, output),
            #[cfg(all(feature = "view", feature = "relight"))]
            Self::View(arguments) => view::run(&arguments, global, output),
            #[cfg(all(feature = "relight", feature = "shadow"))]
            Self::Film(arguments) => film::run(&arguments, global, output),
            #[cfg(all(feature = "relight", feature = "shadow"))]
            Self::Spheres(arguments) => spheres::run(&arguments, output),
            #[cfg(all(feature = "normals", feature = "relight"))]
            Self::Maps(arguments) => maps::run(&arguments, global, output),
            Self::Compare(arguments) => compare::run(&arguments, output),
            #[cfg(feature = "relight")]
            Self::Plan(arguments) => plan::run(&arguments, global, output),
            #[cfg(feature = "relight")]
            Self::Report(arguments) => report::run(&arguments, global, output),
            #[cfg(feature = "relight")]
            Self::Stability(arguments) => stability::run(&arguments, global, output),
            #[cfg(feature = "relight")]
            Self::Explain(arguments) => explain::run(&arguments, global, output),
            #[cfg(feature = "relight")]
            Self::Eval(arguments) => eval::run(&arguments, global, output),
        }
    }
}
