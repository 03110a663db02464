//! A host in C++ builds against both libraries, runs in silence under validation, and lights its mesh.

#![expect(clippy::panic, clippy::unwrap_used, reason = "helpers fail the test they are called from")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const ROOM: &str = env!("CARGO_MANIFEST_DIR");
/// Side of the picture of `examples/host.cpp`.
const SIDE: usize = 128;

/// What a strict host compiles with.
const STRICT: [&str; 5] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"];

/// Runs a command; what it misses is named.
fn run(command: &mut Command, mend: &str) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; {mend}"));
    let said = [&output.stdout[..], &output.stderr[..]].map(String::from_utf8_lossy).concat();
    assert!(output.status.success(), "{command:?} failed; {mend}\n{said}");
    output
}

/// Where this build's libraries go: beside the folder of the test programs.
fn libraries() -> PathBuf {
    let program = std::env::current_exe().unwrap();
    program.ancestors().nth(2).unwrap().to_owned()
}

/// Builds both libraries as a host's build does, without the features that tests of the workspace switch on.
fn build() -> PathBuf {
    let folder = libraries();
    let profile = folder.file_name().and_then(|name| name.to_str()).unwrap();
    let profile = if profile == "debug" { "dev" } else { profile };
    let target = folder.parent().unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--package", "airglow-capi", "--profile", profile, "--target-dir"]);
    run(cargo.arg(target).current_dir(ROOM), "cargo builds the library");
    folder
}

fn scratch() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("capi");
    fs::create_dir_all(&folder).unwrap();
    folder
}

const COMPILER: &str = "install g++ (Debian: g++)";

#[test]
fn the_header_compiles_alone_as_c99_and_as_cpp17() {
    for (compiler, standard, file) in [("gcc", "-std=c99", "header.c"), ("g++", "-std=c++17", "header.cpp")] {
        let source = scratch().join(file);
        fs::write(&source, "#include \"airglow.h\"\nint main(void) { return airglow_version() == 0; }\n")
            .unwrap();
        let mut command = Command::new(compiler);
        command.args(STRICT).arg(format!("{ROOM}/include")).args([standard, "-fsyntax-only"]).arg(source);
        run(&mut command, COMPILER);
    }
}

#[test]
fn a_host_in_cpp_lights_its_mesh_with_either_library() {
    let libraries = build();
    let path = libraries.display();
    let linked = [
        ("static", vec![format!("{path}/libairglow.a"), "-lpthread".into(), "-ldl".into(), "-lm".into()]),
        ("shared", vec![format!("-L{path}"), "-lairglow".into(), format!("-Wl,-rpath,{path}")]),
    ];
    let pictures = linked.map(|(name, libraries)| {
        let program = scratch().join(format!("host_{name}"));
        let mut command = Command::new("g++");
        command
            .args(["-std=c++17", "-O1"])
            .args(STRICT)
            .arg(format!("{ROOM}/include"))
            .arg("-o")
            .arg(&program);
        command.arg(format!("{ROOM}/examples/host.cpp")).args(libraries).arg("-lvulkan");
        run(&mut command, "install g++ and Vulkan's headers (Debian: g++ libvulkan-dev)");
        light(&program, name)
    });
    assert!(pictures[0] == pictures[1], "the two libraries give other pictures");
    let at = |x: usize, y: usize| {
        let pixel = &pictures[0][3 * (y * SIDE + x)..][..3];
        pixel.iter().map(|&value| u32::from(value)).sum::<u32>()
    };
    // The sun is low over the left edge: it lights the dome's left flank, and the plain right of it is in shadow.
    let (plain, flank, far_flank, shadow) = (at(5, 5), at(25, 83), at(67, 83), at(79, 83));
    assert!(flank > plain && plain > far_flank, "flank {flank}, plain {plain}, far flank {far_flank}");
    assert!(shadow + 20 < plain, "shadow {shadow}, plain {plain}");
}

/// Runs a host under core and synchronisation validation; its picture's bytes.
fn light(program: &Path, name: &str) -> Vec<u8> {
    let folder = scratch().join(name);
    fs::create_dir_all(&folder).unwrap();
    let settings = "khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG\n\
        khronos_validation.report_flags = error,warn,info\n\
        khronos_validation.enables = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT\n\
        khronos_validation.log_filename = stdout\n";
    fs::write(folder.join("vk_layer_settings.txt"), settings).unwrap();
    let picture = folder.join("relit.ppm");
    let mut command = Command::new(program);
    command.arg(&picture).env("VK_LAYER_SETTINGS_PATH", folder.join("vk_layer_settings.txt"));
    command.env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation");
    let output =
        run(&mut command, "install the layers (Debian: vulkan-validationlayers mesa-vulkan-drivers)");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION"), "validation is not on:\n{said}");
    let wrong = |line: &&str| line.contains("(ERROR") || line.contains("(WARN");
    assert_eq!(said.lines().find(wrong), None, "{said}");
    let bytes = fs::read(picture).unwrap();
    let header = format!("P6 {SIDE} {SIDE} 255\n");
    assert!(bytes.starts_with(header.as_bytes()) && bytes.len() == header.len() + 3 * SIDE * SIDE);
    bytes[header.len()..].to_vec()
}
