//! The pass inside a host with a device of its own, under validation.

use airglow_gpu::{Context, Options};
use airglow_relight::Relight;
use airglow_tests::conformance::{HostDevice, Outputs, conform_adopting};

use super::settings;
use crate::pass::Settings as _;
use crate::relight::conformance::{Both, Case, check_written, z_up};

fn outputs(case: Case<'_>) -> Outputs {
    let requirements = Relight::requirements(&settings(case.0).read().unwrap());
    let make = |context: &Context, host: &HostDevice<'_>| Both::new(context, host, case);
    conform_adopting(make, &requirements, &Options::default())
}

#[test]
fn rust_and_c_give_the_same_bits() {
    let by_image = outputs((0, false, None));
    check_written(&by_image).unwrap();
    assert_eq!(outputs((0, true, None)), by_image, "texels of the host give what its image gives");
    assert_eq!(outputs((1, false, None)), by_image, "the fragment method gives what compute gives");
}

#[test]
fn a_host_of_another_world_gets_the_bits_of_the_rust_road() {
    let world = z_up();
    let turned = outputs((0, false, Some(&world)));
    check_written(&turned).unwrap();
    assert_ne!(turned, outputs((0, false, None)), "the world changes what comes out");
}
