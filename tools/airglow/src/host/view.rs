//! What the draws of one view share.

use std::sync::{Arc, Mutex, PoisonError};

use airglow_scene::{Camera, FloatImage};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Quat, Vec3};

/// `Frame` of `host/frame.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct ViewConstants {
    clip_from_world: [[f32; 4]; 4],
    direction_from_clip: [[f32; 4]; 4],
    map_from_world: [[f32; 4]; 4],
    eye: [f32; 4],
    ambient: [f32; 4],
}

impl ViewConstants {
    /// A camera's view in a picture of the given aspect; `rotation` is world from environment map, `ambient` the
    /// radiance of a white surface where no pass lights it.
    pub fn new(camera: &Camera, aspect: f32, rotation: Quat, ambient: [f32; 3]) -> Self {
        let (clip_from_view, view) = (camera.clip_from_view(aspect), camera.view());
        let without_translation = Mat4::from_mat3(glam::Mat3::from_mat4(view));
        Self {
            clip_from_world: (clip_from_view * view).to_cols_array_2d(),
            direction_from_clip: (clip_from_view * without_translation).inverse().to_cols_array_2d(),
            map_from_world: Mat4::from_quat(rotation.inverse()).to_cols_array_2d(),
            eye: camera.position().extend(1.0).to_array(),
            ambient: Vec3::from(ambient).extend(0.0).to_array(),
        }
    }
}

impl ViewConstants {
    /// The same, moved in the picture, whose sides are 2 long.
    #[must_use]
    pub fn moved(self, [x, y]: [f32; 2]) -> Self {
        let moved = |matrix| {
            let move_by = Mat4::from_translation(Vec3::new(x, y, 0.0));
            (move_by * Mat4::from_cols_array_2d(&matrix)).to_cols_array_2d()
        };
        Self { clip_from_world: moved(self.clip_from_world), ..self }
    }
}

/// The view of a plan that is recorded again: what was set last counts.
#[derive(Clone, Debug)]
pub struct SharedView(Arc<Mutex<ViewConstants>>);

impl SharedView {
    /// Starts with `view`.
    pub fn new(view: ViewConstants) -> Self {
        Self(Arc::new(Mutex::new(view)))
    }

    /// The view set last.
    pub fn get(&self) -> ViewConstants {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts from the next recording on.
    pub fn set(&self, view: ViewConstants) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = view;
    }
}

/// Distance of neighbouring views, metres: that of a person's eyes.
const EYES_APART: f32 = 0.064;

/// The same camera `count` times, side by side along its right, around where it stands: two make a stereo pair.
pub fn row(camera: &Camera, count: u32) -> Vec<Camera> {
    let middle = 0.5 * (count as f32 - 1.0);
    let moved = |index: u32| {
        let right = EYES_APART * (index as f32 - middle);
        Camera { transform: camera.transform * Mat4::from_translation(right * Vec3::X), ..camera.clone() }
    };
    (0..count).map(moved).collect()
}

/// `aspect` of a picture.
pub fn aspect(size: [u32; 2]) -> f32 {
    size[0] as f32 / size[1].max(1) as f32
}

/// The picture of `rgb` triples.
pub fn picture(size: [u32; 2], values: &[f32]) -> FloatImage {
    let pixels = values.as_chunks::<3>().0.to_vec();
    FloatImage { width: size[0] as usize, height: size[1] as usize, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_scene::{Projection, Sphere};

    #[test]
    fn views_stand_in_a_row_around_the_camera() {
        let camera = Camera::framing(Sphere { center: [1.0, 2.0, 3.0], radius: 1.5 });
        assert_eq!(row(&camera, 1), std::slice::from_ref(&camera));
        let pair = row(&camera, 2);
        let (apart, right) = (pair[1].position() - pair[0].position(), camera.transform.x_axis.truncate());
        assert!((apart - 0.064 * right).length() < 1e-5, "{apart} apart, right is {right}");
        let middle = 0.5 * (pair[0].position() + pair[1].position());
        assert!((middle - camera.position()).length() < 1e-5, "{middle} {}", camera.position());
        assert!(pair.iter().all(|eye| eye.direction() == camera.direction()));
    }

    #[test]
    fn the_middle_of_the_picture_looks_where_the_camera_looks() {
        let mut camera = Camera::framing(Sphere { center: [1.0, 2.0, 3.0], radius: 1.5 });
        for infinite in [false, true] {
            if let (Projection::Perspective { far, .. }, true) = (&mut camera.projection, infinite) {
                *far = None;
            }
            let view = ViewConstants::new(&camera, 1.5, Quat::IDENTITY, [0.0; 3]);
            let near =
                Mat4::from_cols_array_2d(&view.direction_from_clip) * glam::Vec4::new(0.0, 0.0, 0.0, 1.0);
            let direction = (near.truncate() / near.w).normalize();
            assert!((direction - camera.direction()).length() < 1e-4, "{direction} {}", camera.direction());
        }
    }
}
