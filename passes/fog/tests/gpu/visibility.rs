//! A host's shadow map within the airlight: absent by default, obeyed at each tap where there is one.

use airglow_fog::bench::{Ray, WALL, settings};
use airglow_fog::reference::airlight::{Sight, airlight};
use airglow_fog::{Bench, Fog, Light, Medium, Phase, Preset, Settings};
use airglow_gpu::{GpuError, Recorder};
use airglow_tests::device::fixture_with;
use airglow_tests::reflect::spirv_root;
use glam::DVec3;

const EXTINCTION: f64 = 0.1;

/// A ray straight through the wall or away from it, with a lamp beside it.
fn ray(direction: DVec3, distance: f64) -> Ray {
    let medium =
        Medium { extinction: [EXTINCTION; 3], albedo: [1.0; 3], phase: Phase::Isotropic, thinning: None };
    let light = Light::point(DVec3::new(2.0, 1.0, -5.0), [1.0; 3]);
    Ray { eye: DVec3::ZERO, medium, light, direction, distance }
}

#[test]
fn no_light_arrives_where_the_host_says_so() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let slanted = DVec3::new(0.3, 0.1, -1.0).normalize();
    let before = WALL / slanted.z;
    let rays = [ray(slanted, 0.999 * before), ray(DVec3::Z, 30.0), ray(slanted, 40.0)];
    let open = bench.airlight(&settings(&rays[0].medium, Preset::Reference), &rays).unwrap();
    let walled = bench.airlight_with_wall(&rays).unwrap();
    assert_eq!(walled[..2], open[..2], "before the wall all of the light arrives");
    assert!(open[0][0] > 0.0 && open[1][0] > 0.0);

    // Through the wall: the taps before it alone. They are 16 on the whole ray, so that its end is told to one of them.
    let light = rays[2].light.position;
    let sight = Sight { along: light.dot(slanted), offset: light.cross(slanted).length() };
    let truth = EXTINCTION * airlight(EXTINCTION, sight, 0.0, before, Phase::Isotropic).unwrap();
    let [found, whole] = [walled[2][0], open[2][0]].map(f64::from);
    assert!(found < whole && (found / truth - 1.0).abs() < 0.15, "{found} instead of {truth} of {whole}");
}

#[test]
fn airlight_is_truly_absent_beyond_the_wall() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    // A box that begins at the wall leaves of the ray what lies beyond it.
    let bounds =
        airglow_fog::Bounds { low: DVec3::new(-50.0, -50.0, -50.0), high: DVec3::new(50.0, 50.0, WALL) };
    let mut beyond = ray(DVec3::new(0.3, 0.1, -1.0).normalize(), 40.0);
    beyond.light.bounds = Some(bounds);
    let open = bench.airlight(&settings(&beyond.medium, Preset::Reference), &[beyond]).unwrap();
    assert!(open[0][0] > 0.0);
    assert_eq!(bench.airlight_with_wall(&[beyond]).unwrap(), [[0.0; 3]]);
}

#[test]
fn without_a_hook_there_is_no_branch() {
    let bytes = |name: &str| std::fs::metadata(spirv_root().join(name)).unwrap().len();
    let without = bytes("fog/airlight_rows.FOG_TAPS16.isotropic.spv");
    let with = bytes("fog/airlight_rows_wall.isotropic.spv");
    assert!(without < with, "{without} bytes without, {with} with");
}
