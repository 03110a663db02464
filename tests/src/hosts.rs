//! Hosts that differ in axes, hand, units, winding, normal maps, depth and pre-exposure.

use airglow_math::World;
use airglow_math::world::{Axes, Depth, NormalMapGreen, Winding};

/// One as glTF has it; one in centimetres, z up and left-handed, depth reversed and infinite, green down; one whose y
/// points down, clockwise, pre-exposed. All about the origin.
pub fn hosts() -> [World; 3] {
    let like_unreal = World {
        axes: Axes::Z_UP_LEFT_HANDED,
        metres_per_unit: 0.01,
        normal_map_green: NormalMapGreen::Down,
        depth: Depth { reversed: true, near: 10.0, far: None, orthographic: false },
        ..World::default()
    };
    let y_down = World {
        axes: Axes::Y_DOWN_RIGHT_HANDED,
        front_face: Winding::Clockwise,
        pre_exposure: 0.37,
        depth: Depth { near: 0.5, far: Some(90.0), ..Depth::default() },
        ..World::default()
    };
    [World::default(), like_unreal, y_down]
}
