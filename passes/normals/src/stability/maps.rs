//! Maps that break filters of normals.

use airglow_math::sequence::{hammersley, uniform_sphere};

use super::{BRDFS, Case};
use crate::NormalsError;
use crate::map::NormalMap;

/// Grooves of eight texels: two modes.
pub(super) fn grooves(size: usize) -> Result<NormalMap, NormalsError> {
    let side = |i: usize| if (i % size) & 4 == 0 { [0.6, 0.0, 0.8] } else { [-0.6, 0.0, 0.8] };
    NormalMap::from_vectors(size, size, &(0..size * size).map(side).collect::<Vec<_>>())
}

pub(super) fn cases() -> Result<Vec<Case>, NormalsError> {
    let map = |width: usize, height: usize, normal: &dyn Fn(usize) -> [f32; 3]| {
        NormalMap::from_vectors(width, height, &(0..width * height).map(normal).collect::<Vec<_>>())
    };
    let case = |name, input, map, level, bound| Case { name, input, map, level, brdfs: &BRDFS, bound };
    let sphere = |i: usize| uniform_sphere(hammersley(i as u32, 4096)).as_vec3().to_array();
    let broken = |i: usize| match i % 7 {
        0 => [0.0; 3],
        1 => [f32::NAN; 3],
        2 => [1e-40, 0.0, 0.0],
        3 => [f32::INFINITY, 0.0, 1.0],
        _ => [0.3, 0.1, 1.0],
    };
    let below = |i: usize| if i.is_multiple_of(2) { [0.8, 0.0, -0.6] } else { [0.0, 0.6, 0.8] };
    let antipodal = |i: usize| if i.is_multiple_of(2) { [1.0, 0.0, 0.0] } else { [-1.0, 0.0, 0.0] };
    let six = |i: usize| {
        let angle = (i * i % 6) as f32;
        [0.4 * angle.cos(), 0.4 * angle.sin(), 0.9]
    };
    Ok(vec![
        case("all normals equal", "8 x 8, tilted by 13 degrees", map(8, 8, &|_| [0.2, 0.1, 0.97])?, 3, 0.01),
        case("all normals equal, one level up", "the same", map(8, 8, &|_| [0.2, 0.1, 0.97])?, 1, 0.01),
        case("two antipodal clusters", "8 x 8, +X and -X in turn", map(8, 8, &antipodal)?, 3, 0.02),
        case("zero, NaN, denormal and infinite texels", "8 x 8", map(8, 8, &broken)?, 3, 0.01),
        case("normals below the horizon", "8 x 8, half of them", map(8, 8, &below)?, 3, 0.01),
        case("one texel", "1 x 1", map(1, 1, &|_| [0.3, 0.0, 0.95])?, 0, 0.01),
        case("a row of texels", "1 x 9, six normals", map(1, 9, &six)?, 3, 0.02),
        case("a size that is no power of two", "13 x 7, six normals", map(13, 7, &six)?, 3, 0.02),
        case("fewer normals than lobes", "16 x 16 grooves, two normals", grooves(16)?, 4, 0.01),
        Case {
            brdfs: &BRDFS[..4],
            ..case("kappa to 0", "64 x 64, all over the sphere", map(64, 64, &sphere)?, 6, 0.2)
        },
    ])
}
