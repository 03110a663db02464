//! Developer commands, run as `cargo run -p xtask -- COMMAND`.

mod arcade;
mod cloister;
#[cfg(test)]
mod common_tests;
mod compile;
mod court;
mod debug_set;
mod dusk;
mod error;
mod files;
mod glb;
mod header;
mod latitudes;
mod manifest;
mod mesh;
mod portability;
mod products;
mod relief;
mod room;
mod room_lines;
mod sculpture;
mod shaders;
mod stone;
mod street;
mod translate;
mod walker;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(about = "Developer commands of airglow")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compile what the manifests in shaders/glsl/* list into shaders/spirv, and write the table of `portability`
    Shaders {
        /// Write nothing; fail with a list when the committed SPIR-V differs from a fresh compile
        #[arg(long)]
        check: bool,
        /// Only the entries of this room (the first folder of their files)
        #[arg(long, value_name = "NAME")]
        room: Option<String>,
        /// Instead, write modules with source and line numbers here, for frame captures (needs glslangValidator)
        #[arg(long, value_name = "DIR", conflicts_with = "check")]
        debug_set: Option<PathBuf>,
    },
    /// Write docs/shader-portability.md: which shader naga translates to WGSL, HLSL and MSL, and why not
    Portability {
        /// Write nothing; fail when the committed table differs
        #[arg(long)]
        check: bool,
    },
    /// Write passes/capi/include/airglow.h, the header of the library for hosts in C and C++
    Header {
        /// Write nothing; fail when the committed header differs
        #[arg(long)]
        check: bool,
    },
    /// Make a pass's room from the template: crate, shader, tests, and the lines that name it
    Room {
        /// One lower-case word, such as `fog`
        name: String,
        /// Instead, remove this room: its folders, and the lines that name it
        #[arg(long)]
        remove: bool,
    },
    /// Make assets/mesh/cloister.glb, columns under the open sky, from assets/mesh/nave.glb
    Cloister,
    /// Make assets/mesh/court.glb, the demo scene's building, with its maps of stone, and its sky, assets/env/dusk_512.exr
    Court,
    /// Write shaders/glsl/shadow/product3.glsl to product6.glsl, products of spherical harmonics as straight-line code
    Products,
    /// Make assets/mesh/street.glb, the scene of lamps in fog
    Street,
    /// Make assets/mesh/walker.glb, a figure with a skin that walks
    Walker,
    /// Make assets/normalmap and the meshes of the two scenes that show it, grooves.glb and weave.glb
    Relief,
}

/// The workspace around the current folder; elsewhere, the one this command was built in.
fn workspace() -> PathBuf {
    let is_workspace = |folder: &&Path| folder.join("shaders/glsl/common").is_dir();
    let current = std::env::current_dir().unwrap_or_default();
    let built_in = Path::new(env!("CARGO_MANIFEST_DIR"));
    let around = current.ancestors().find(is_workspace).or_else(|| built_in.ancestors().nth(2));
    around.unwrap_or(&current).to_owned()
}

/// Where includes and the manifest's files are looked up.
fn shader_root() -> PathBuf {
    workspace().join("shaders/glsl")
}

fn run(command: Command) -> Result<(), error::Error> {
    let glsl = shader_root();
    match command {
        Command::Cloister => cloister::make(&workspace().join("assets")),
        Command::Court => {
            court::make(&workspace().join("assets")).and_then(|()| dusk::make(&workspace().join("assets")))
        }
        Command::Street => street::make(&workspace().join("assets")),
        Command::Walker => walker::make(&workspace().join("assets")),
        Command::Products => products::make(&glsl),
        Command::Relief => relief::make(&workspace().join("assets")),
        Command::Room { name, remove: false } => room::make(&workspace(), &name),
        Command::Room { name, remove: true } => room::remove(&workspace(), &name),
        Command::Header { check } => header::run(&workspace(), check),
        Command::Portability { check } => portability::run(&workspace(), check),
        Command::Shaders { room, debug_set: Some(folder), .. } => {
            debug_set::write(&glsl, &folder, &shaders::modules(&glsl, room.as_deref())?)
        }
        Command::Shaders { check, room, debug_set: None } => {
            shaders::run(&glsl, &workspace().join("shaders/spirv"), room.as_deref(), check)?;
            if check { Ok(()) } else { portability::run(&workspace(), false) }
        }
    }
}

fn main() -> ExitCode {
    match run(Arguments::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
