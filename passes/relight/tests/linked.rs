//! What a host's binary holds: the kernels of the pass, and none of their rivals.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

use airglow_relight::kernels;

/// Whether this program holds a committed module, byte for byte.
fn is_linked(program: &[u8], name: &str) -> bool {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders/spirv/relight/");
    let module = std::fs::read(format!("{root}{name}.spv")).unwrap();
    // A module's first words are much like another's; the middle is its own.
    let part = &module[module.len() / 2..];
    program.windows(part.len()).any(|window| window == part)
}

/// This program calls for every kernel and never names the rivals.
#[test]
fn rivals_are_not_linked_unless_they_are_called_for() {
    assert!(!kernels::all().is_empty());
    let program = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    assert!(is_linked(&program, "colour.uniform.ORDER4.f32"));
    for rival in
        ["bandwidth.planes.f32.VERTICES1.WORKGROUP64", "colour_rival.vertices.f16.VERTICES4.WORKGROUP64"]
    {
        assert!(!is_linked(&program, rival), "{rival} is in the program");
    }
}
