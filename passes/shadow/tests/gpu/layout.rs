//! What Rust states is what the shaders have.

use airglow_shadow::kernels::{ROW_BINDINGS, RowConstants, VISIBILITY_BINDINGS, VisibilityConstants};
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;

#[test]
fn host_structs_are_as_the_compiler_laid_them_out() {
    let without_normals: Vec<_> =
        VISIBILITY_BINDINGS.into_iter().filter(|binding| binding.binding != 6).collect();
    for order in 3..=6 {
        let module = Module::load(&format!("shadow/visibility.EXPONENTIAL0.ORDER{order}.spv")).unwrap();
        module.assert_bindings(&without_normals);
        let layout =
            host_layout!(VisibilityConstants { count, degree, norm, reach, cut, window, flags, end, first });
        module.push_constants.as_ref().unwrap().assert_matches(&layout);
        let module =
            Module::load(&format!("shadow/visibility.EXPONENTIAL0.NORMALS.ORDER{order}.spv")).unwrap();
        module.assert_bindings(&VISIBILITY_BINDINGS);
        let module = Module::load(&format!("shadow/rows.EXPONENTIAL1.ORDER{order}.spv")).unwrap();
        module.assert_bindings(&ROW_BINDINGS);
        let layout = host_layout!(RowConstants { count, degree, norm, whole, repeat, end });
        module.push_constants.as_ref().unwrap().assert_matches(&layout);
    }
}
