//! The pass inside a host with a device of its own, under validation.

use airglow_gpu::{Context, Options};
use airglow_relight::Relight;
use airglow_tests::conformance::{HostDevice, Outputs, conform_adopting};

use super::settings;
use crate::relight::conformance::{Both, assert_written};

fn outputs(method: u32, texels: bool) -> Outputs {
    let requirements = Relight::requirements(&settings(method).read().unwrap());
    let make = |context: &Context, host: &HostDevice<'_>| Both::new(context, host, method, texels);
    conform_adopting(make, &requirements, &Options::default())
}

#[test]
fn rust_and_c_give_the_same_bits() {
    let by_image = outputs(0, false);
    assert_written(&by_image);
    assert_eq!(outputs(0, true), by_image, "texels of the host give what its image gives");
    assert_eq!(outputs(1, false), by_image, "the fragment method gives what compute gives");
}
