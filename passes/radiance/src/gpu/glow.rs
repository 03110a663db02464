//! Emitters as the kernels weigh them that place and keep samples: what they would send unhidden, and how they moved.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::EmitterTriangle;

/// A triangle that emits or moved: `Glow` of `radiance/sample.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DeviceGlow {
    /// Centre, metres, and area, m2.
    pub place: [f32; 4],
    /// Radiance, W/sr/m2.
    pub radiance: [f32; 4],
    /// The farthest way of a corner since the frame before, times the radiance that the triangle shows or hides.
    pub moved: [f32; 4],
    /// Change of its radiance.
    pub dimmed: [f32; 4],
}

impl DeviceGlow {
    /// Those of the triangles that emit, or that changed since `before`, the same triangles in the frame before, or these again.
    #[must_use]
    pub fn of(triangles: &[EmitterTriangle], before: &[EmitterTriangle]) -> Vec<Self> {
        // What moves shows or hides no more than the brightest there is, before or after.
        let all = triangles.iter().chain(before);
        let brightest = all.map(EmitterTriangle::radiance).fold(Vec3::ZERO, Vec3::max);
        let glow = |(now, before): (&EmitterTriangle, &EmitterTriangle)| {
            let [[a, b, c], old] = [now.positions(), before.positions()];
            let step = [a, b, c].iter().zip(&old).map(|(now, old)| now.distance(*old)).fold(0.0, f32::max);
            let area = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(c - a).length();
            let largest = area([a, b, c]).max(area(old));
            let (radiance, dimmed) = (now.radiance(), (now.radiance() - before.radiance()).abs());
            let glow = Self {
                place: ((a + b + c) / 3.0).extend(largest).to_array(),
                radiance: radiance.extend(0.0).to_array(),
                moved: (step * brightest).extend(0.0).to_array(),
                dimmed: dimmed.extend(0.0).to_array(),
            };
            (radiance.max_element() > 0.0 || step > 0.0 || dimmed.max_element() > 0.0).then_some(glow)
        };
        let mut glows: Vec<_> = triangles.iter().zip(before).filter_map(glow).collect();
        if glows.is_empty() {
            glows.push(Self::default()); // a buffer cannot be empty
        }
        glows
    }
}
