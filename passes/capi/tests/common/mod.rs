//! Building hosts in C and C++, and what their structures measure.

#![expect(clippy::panic, clippy::unwrap_used, reason = "helpers fail the test they are called from")]
#![allow(dead_code, reason = "each test uses some of it")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the room.
pub const ROOM: &str = env!("CARGO_MANIFEST_DIR");

/// What a strict host compiles with.
const STRICT: [&str; 5] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"];

/// Runs a command; what it misses is named.
pub fn run(command: &mut Command, mend: &str) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; {mend}"));
    let said = [&output.stdout[..], &output.stderr[..]].map(String::from_utf8_lossy).concat();
    assert!(output.status.success(), "{command:?} failed; {mend}\n{said}");
    output
}

/// A compiler as a strict host calls it, for one language.
pub fn compiler(program: &str, standard: &str) -> Command {
    let mut command = Command::new(program);
    command.arg(standard).args(STRICT).arg(format!("{ROOM}/include"));
    command
}

/// Builds the libraries of a package, with dependencies as the whole workspace has them, which are then not built once
/// more with fewer features; the folder they are in.
pub fn build(package: &str) -> PathBuf {
    let program = std::env::current_exe().unwrap();
    let folder = program.ancestors().nth(2).unwrap().to_owned();
    let profile = folder.file_name().and_then(|name| name.to_str()).unwrap();
    let profile = if profile == "debug" { "dev" } else { profile };
    let target = folder.parent().unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--locked", "--quiet", "--lib", "--profile", profile, "--package", package]);
    cargo.args(["--package", "airglow-cli", "--package", "xtask", "--target-dir"]);
    run(cargo.arg(target).current_dir(ROOM), "cargo builds the library");
    folder
}

/// Linker arguments for the static and for the shared library `name` in `folder`.
pub fn linked(folder: &Path, name: &str) -> [(&'static str, Vec<String>); 2] {
    let path = folder.display();
    [
        ("static", vec![format!("{path}/lib{name}.a"), "-lpthread".into(), "-ldl".into(), "-lm".into()]),
        ("shared", vec![format!("-L{path}"), format!("-l{name}"), format!("-Wl,-rpath,{path}")]),
    ]
}

/// Builds a host in C++ with a library; the program.
pub fn host(source: &Path, name: &str, libraries: &[String]) -> PathBuf {
    let program = scratch().join(name);
    let mut command = compiler("g++", "-std=c++17");
    command.arg(format!("-I{ROOM}/examples/common")).args(["-O1", "-o"]).arg(&program).arg(source);
    run(command.args(libraries).arg("-lvulkan"), VULKAN);
    program
}

/// Runs a host under validation; its picture's bytes, three a pixel.
pub fn picture(program: &Path, [width, height]: [usize; 2]) -> Vec<u8> {
    let picture = program.with_extension("ppm");
    run_validated(program, &picture);
    let bytes = fs::read(picture).unwrap();
    let header = format!("P6 {width} {height} 255\n");
    assert!(bytes.starts_with(header.as_bytes()) && bytes.len() == header.len() + 3 * width * height);
    bytes[header.len()..].to_vec()
}

/// Where files of the tests go.
pub fn scratch() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("capi");
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs a program under core and synchronisation validation, which must be on and silent; what it said.
pub fn run_validated(program: &Path, argument: &Path) -> String {
    let folder = program.with_extension("settings");
    fs::create_dir_all(&folder).unwrap();
    let settings = "khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG\n\
        khronos_validation.report_flags = error,warn,info\n\
        khronos_validation.enables = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT\n\
        khronos_validation.log_filename = stdout\n";
    let path = folder.join("vk_layer_settings.txt");
    fs::write(&path, settings).unwrap();
    let mut command = Command::new(program);
    command.arg(argument).env("VK_LAYER_SETTINGS_PATH", path);
    command.env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation");
    let output =
        run(&mut command, "install the layers (Debian: vulkan-validationlayers mesa-vulkan-drivers)");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION"), "validation is not on:\n{said}");
    let wrong = |line: &&str| line.contains("(ERROR") || line.contains("(WARN");
    assert_eq!(said.lines().find(wrong), None, "{said}");
    said
}

/// Names of structures with their sizes and alignments in Rust.
#[macro_export]
macro_rules! sizes {
    ($($name:ty),* $(,)?) => {
        [$((stringify!($name), size_of::<$name>(), align_of::<$name>())),*]
    };
}

/// Compiles the header as C with an assertion for each size.
pub fn assert_sizes(file: &str, sizes: &[(&str, usize, usize)]) {
    let mut text = "#include \"airglow.h\"\n".to_owned();
    for (name, size, align) in sizes {
        let pointer = format!("struct {{ char c; {name} v; }}");
        text += &format!("_Static_assert(sizeof({name}) == {size}, \"size of {name}\");\n");
        text += &format!("_Static_assert(sizeof({pointer}) == {}, \"alignment of {name}\");\n", size + align);
    }
    let source = scratch().join(file);
    fs::write(&source, text).unwrap();
    run(compiler("gcc", "-std=c11").arg("-fsyntax-only").arg(source), COMPILER);
}

/// How to get a compiler.
pub const COMPILER: &str = "install g++ (Debian: g++)";

/// How to get what hosts are built with.
pub const VULKAN: &str = "install g++ and Vulkan's headers (Debian: g++ libvulkan-dev)";
