//! A mesh that the host's memory budget has no room for is refused with the settings that would fit, and they do.

use airglow_gpu::{AdoptInfo, Context, Options};
use airglow_relight::{Relight, RelightError, Settings, Storage};
use airglow_tests::device::open;

const VERTICES: u32 = 10_000;

#[test]
fn a_refused_mesh_names_the_settings_that_fit() {
    let device = open(&Relight::requirements(&Settings::default()));
    let mut extensions = Vec::new();
    let options = Options { memory_budget: Some(1_000_000), ..Options::default() };
    let info = AdoptInfo { options, ..device.adopt_info(&mut extensions, 2) };
    // SAFETY: the device is alive and outlives the context; nothing is submitted.
    let context = unsafe { Context::adopt(info) }.unwrap();
    let add = |settings: Settings| {
        let mut relight = Relight::new(&context, settings).unwrap();
        let vectors = vec![0.25; VERTICES as usize * settings.coefficients()];
        relight.add_mesh(&context, "terrain", VERTICES, Some(&vectors)).map(|_| relight)
    };
    let settings = Settings::default();
    let error = add(settings).map(drop).unwrap_err();
    let RelightError::Budget { size, left, .. } = &error else { panic!("{error}") };
    assert_eq!(*size, settings.mesh_bytes(VERTICES));
    let next = settings.next_that_fits(VERTICES, *left).unwrap();
    assert_eq!((next.order, next.storage), (4, Storage::F16), "{error}");
    assert!(error.to_string().ends_with("order 4 with F16 would fit"), "{error}");
    assert!(add(next).is_ok());
}
