//! What Rust states is what the shaders have.

use airglow_shadow::kernels::{ROW_BINDINGS, RowConstants, VISIBILITY_BINDINGS, VisibilityConstants};
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;

#[test]
fn host_structs_are_as_the_compiler_laid_them_out() {
    for order in 3..=6 {
        let module = Module::load(&format!("shadow/visibility.EXPONENTIAL0.ORDER{order}.spv")).unwrap();
        module.assert_bindings(&VISIBILITY_BINDINGS[..6]);
        let layout = host_layout!(VisibilityConstants {
            sphere_count,
            degree,
            norm,
            reach,
            window,
            clamped,
            end,
            first
        });
        module.push_constants.as_ref().unwrap().assert_matches(&layout);
        let module =
            Module::load(&format!("shadow/visibility.EXPONENTIAL0.NORMALS.ORDER{order}.spv")).unwrap();
        module.assert_bindings(&VISIBILITY_BINDINGS[..7]);
        let module = Module::load(&format!("shadow/rows.EXPONENTIAL2.ORDER{order}.spv")).unwrap();
        module.assert_bindings(&ROW_BINDINGS);
        let layout = host_layout!(RowConstants { count, degree, norm, whole, repeat, end });
        module.push_constants.as_ref().unwrap().assert_matches(&layout);
    }
}
