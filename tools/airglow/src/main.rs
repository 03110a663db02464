//! The airglow command: the first host of the library, and the instruments that measure it.
//!
//! Each command has one file under `commands`; what they share lies below: `host` opens a device and draws frames as an
//! engine would, `measure` says what their passes do and take, `report` holds measurements and plots, `window` shows frames
//! live, `compare` holds image errors, `eval` runs a pass's own code on rows of parameters.
#![cfg_attr(
    not(feature = "relight"),
    allow(dead_code, unused_variables, reason = "without a pass, what draws and measures has nothing to do")
)]

mod cli;
mod commands;
mod compare;
mod eval;
mod failure;
mod files;
mod global;
mod host;
#[cfg(feature = "relight")]
mod measure;
mod output;
mod report;
mod scene_options;
mod text;
#[cfg(all(feature = "view", feature = "relight"))]
mod window;

use std::process::ExitCode;

use clap::Parser;

use crate::cli::Cli;
use crate::output::Output;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let output = Output::new(&cli.global);
    match cli.command.run(&cli.global, &output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output.failure(&failure);
            ExitCode::from(failure.exit_code())
        }
    }
}
