use super::*;
use crate::sh;

/// An Unreal-like host: Z up, left-handed, centimetres, clockwise, positions relative to the camera.
fn centimetres() -> World {
    World {
        axes: Axes::Z_UP_LEFT_HANDED,
        metres_per_unit: 0.01,
        front_face: Winding::Clockwise,
        normal_map_green: NormalMapGreen::Down,
        depth: Depth { reversed: true, near: 10.0, far: None, orthographic: false },
        origin: DVec3::new(100.0, -200.0, 300.0),
        ..World::default()
    }
}

#[test]
fn positions_go_there_and_back() {
    let world = centimetres();
    // 1 m forward, 2 m right, 3 m up of the world's zero.
    let host = DVec3::new(100.0, 200.0, 300.0) - world.origin;
    let found = world.position(host);
    assert!((found - DVec3::new(2.0, 3.0, -1.0)).length() < 1e-14, "{found}");
    let back = world.host_position(found);
    assert!((back - host).length() < 1e-11, "{back} instead of {host}");
    assert_eq!(world.direction(DVec3::X), DVec3::NEG_Z);
    assert_eq!(world.host_direction(DVec3::NEG_Z), DVec3::X);
    assert_eq!(World::default().position(host), host);
}

#[test]
fn a_face_s_normal_points_out_of_the_front() {
    // Counter-clockwise seen from above in airglow's axes: right, away, then left.
    let airglow = [DVec3::ZERO, DVec3::X, DVec3::NEG_Z];
    let worlds = [
        (World::default(), false),
        (World { axes: Axes::Y_UP_LEFT_HANDED, ..World::default() }, false),
        (centimetres(), true),
        (World { axes: Axes::Y_DOWN_RIGHT_HANDED, front_face: Winding::Clockwise, ..World::default() }, true),
    ];
    for (world, clockwise) in worlds {
        let mut host = airglow.map(|corner| world.host_position(corner));
        if clockwise {
            host.swap(1, 2);
        }
        let normal = world.face_sign() * (host[1] - host[0]).cross(host[2] - host[0]);
        let found = world.direction(normal.normalize());
        assert!((found - DVec3::Y).length() < 1e-12, "{world:?}: {found}");
    }
}

#[test]
fn harmonics_are_those_of_the_same_light() {
    let order = 6;
    let coefficients: Vec<f64> = (0..36).map(|i| (1.7 * f64::from(i)).sin()).collect();
    let axes = [
        Axes::Y_UP_RIGHT_HANDED,
        Axes::Y_UP_LEFT_HANDED,
        Axes::Z_UP_LEFT_HANDED,
        Axes::Z_UP_RIGHT_HANDED,
        Axes::Y_DOWN_RIGHT_HANDED,
    ];
    for axes in axes {
        let world = World { axes, ..World::default() };
        let mut turned = vec![0.0; 36];
        world.harmonics(order).unwrap().apply(&coefficients, &mut turned).unwrap();
        for host in
            [DVec3::X, DVec3::new(0.3, -0.5, 0.8).normalize(), DVec3::new(-0.1, 0.2, -0.97).normalize()]
        {
            let expected = sh::reconstruct(order, &coefficients, host).unwrap();
            let found = sh::reconstruct(order, &turned, world.direction(host)).unwrap();
            assert!((found - expected).abs() < 1e-13, "{axes:?} towards {host}: {found} {expected}");
        }
    }
}

#[test]
fn only_orthogonal_matrices_turn_harmonics() {
    for bad in [DMat3::from_diagonal(DVec3::new(1.0, 1.0, 2.0)), DMat3::NAN, DMat3::ZERO] {
        assert!(matches!(Rotation::from_matrix(3, bad), Err(MathError::Orthogonal { .. })), "{bad}");
    }
    assert_eq!(Rotation::from_matrix(9, DMat3::IDENTITY), Err(MathError::Order { order: 9 }));
}

#[test]
fn depth_is_in_metres() {
    let [a, b, c, d] = centimetres().depth_coefficients();
    // 5 m away: near / distance.
    let found = (a + b * 0.02) / (c + d * 0.02);
    assert!((found - 5.0).abs() < 1e-14, "{found}");
}

#[test]
fn what_no_host_can_mean_is_refused() {
    let good = centimetres();
    good.check().unwrap();
    let bad = [
        (World { metres_per_unit: 0.0, ..good }, "metres per unit"),
        (World { pre_exposure: f64::NAN, ..good }, "pre-exposure"),
        (World { origin: DVec3::new(0.0, f64::INFINITY, 0.0), ..good }, "origin"),
        (World { jitter: [f64::NAN, 0.0], ..good }, "jitter"),
        (World { views: 0, ..good }, "views"),
        (World { depth: Depth { near: -1.0, ..good.depth }, ..good }, "near plane"),
    ];
    for (world, what) in bad {
        let error = world.check().unwrap_err().to_string();
        assert!(error.contains(what), "{error}");
    }
}
