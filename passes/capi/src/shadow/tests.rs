//! The functions as a host calls them.

use std::ptr::{null, null_mut};

use airglow_shadow::MAX_SPHERES;

use super::conformance::*;
use super::prepared::*;
use super::*;
use crate::plan::AirglowPlanFormat;
use crate::prepared::*;
use crate::testing::{call, refused, sizes_refused, text, with_host};
use crate::through_c::ThroughC;

#[test]
fn null_is_refused_everywhere() {
    refused!(InvalidArgument, airglow_shadow_require, null_mut(), null());
    refused!(InvalidArgument, airglow_shadow_new, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_shadow_receivers_new, null(), null(), null(), 1, null_mut());
    refused!(InvalidArgument, airglow_shadow_prepare, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_shadow_set, null(), null(), 0, null(), null_mut());
    refused!(InvalidArgument, airglow_shadow_counts, null(), 1, null_mut());
    refused!(InvalidArgument, airglow_shadow_plan, null(), 0, null_mut());
    // SAFETY: null is nothing.
    unsafe {
        airglow_shadow_drop(null_mut());
        airglow_shadow_receivers_drop(null_mut());
    }
}

#[test]
fn what_no_shadow_is_is_refused_and_named() {
    with_host(&Shadow::requirements(), |host| {
        let mut made = ThroughC::adopt(host, ask).unwrap();
        let (shadow, receivers) = in_c(&mut made).unwrap();
        let (context, mut other) = (made.context, null_mut());
        let good = settings();
        for (wrong, word) in [
            (AirglowShadowSettings { order: 7, ..good }, "order 7"),
            (AirglowShadowSettings { normals: 2, ..good }, "normals"),
            (AirglowShadowSettings { unclamped: 2, ..good }, "unclamped"),
            (AirglowShadowSettings { reach: f64::NAN, ..good }, "reach"),
            (AirglowShadowSettings { window: -1.0, ..good }, "window"),
            (AirglowShadowSettings { clip: 0.9, ..good }, "clip"),
        ] {
            let said =
                refused!(InvalidArgument, airglow_shadow_new, context, &raw const wrong, &raw mut other);
            assert!(said.contains(word) && other.is_null(), "{said}");
        }
        sizes_refused(&good, |wrong| {
            refused!(InvalidStruct, airglow_shadow_new, context, wrong, &raw mut other)
        });
        let mut more = null_mut();
        let place = [0f32; 3];
        for (positions, count) in [(null(), 1), (place.as_ptr(), 0), (place.as_ptr(), usize::MAX)] {
            let (to, name) = (&raw mut more, null());
            let said =
                refused!(InvalidArgument, airglow_shadow_receivers_new, shadow, name, positions, count, to);
            assert!(said.contains("positions") || said.contains("number of receivers"), "{said}");
        }
        spheres_are_refused(prepare(&mut made, (shadow, receivers)).unwrap());
    });
}

/// Spheres, matrices, records and bindings of a frame.
fn spheres_are_refused(prepared: *const AirglowPrepared) {
    let [good, _] = spheres();
    let negative = AirglowSphere { radius: -1.0, ..good };
    let nowhere = AirglowSphere { center: [f64::NAN; 3], ..good };
    let many = vec![good; MAX_SPHERES + 1];
    let flat = [0.0; 16];
    for (spheres, count, matrix, word) in [
        (&raw const negative, 1, null(), "radius"),
        (&raw const nowhere, 1, null(), "centre"),
        (many.as_ptr(), many.len(), null(), "spheres"),
        (&raw const good, usize::MAX, null(), "spheres"),
        (null(), 1, null(), "spheres"),
        (&raw const good, 1, flat.as_ptr(), "matrix"),
    ] {
        let said =
            refused!(InvalidArgument, airglow_shadow_set, prepared, spheres, count, matrix, null_mut());
        assert!(said.contains(word), "{said}");
    }
    let plan = || text(|text| call!(airglow_shadow_plan, prepared, AirglowPlanFormat::Text as u32, text));
    assert!(plan().contains("shadow visibility"), "{}", plan());
    let mut blocks = 9;
    call!(airglow_shadow_set, prepared, &raw const good, 1, null(), &raw mut blocks);
    assert_eq!(blocks, 1);
    call!(airglow_shadow_set, prepared, null(), 0, null(), &raw mut blocks);
    assert_eq!(blocks, 0);
    assert!(plan().contains("nothing that moves blocks"), "{}", plan());
    let mut counts = AirglowShadowCounts { clusters: 9, open: 9, spheres: 9, clamped: 9 };
    let records = [[0u32, 0], [3, 1]];
    call!(airglow_shadow_counts, records.as_ptr().cast(), 2, &raw mut counts);
    let AirglowShadowCounts { clusters, open, spheres, clamped } = counts;
    assert_eq!([clusters, open, spheres, clamped], [2, 1, 3, 1]);
    refused!(InvalidArgument, airglow_shadow_counts, null(), usize::MAX, &raw mut counts);
    refused!(InvalidArgument, airglow_prepared_record, prepared, 0, null(), 0);
    let said = refused!(InvalidArgument, airglow_prepared_record, prepared, 1, null(), 0);
    assert!(said.contains("shadow positions"), "{said}");
    #[cfg(feature = "relight")]
    {
        let set_lit = crate::relight::prepared::airglow_relight_set_lit;
        let said = refused!(InvalidArgument, set_lit, prepared, 0);
        assert!(said.contains("a frame of shadow: give one of relight"), "{said}");
    }
}
