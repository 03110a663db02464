//! Lamps and figures as the mouse takes and moves them.

use airglow_scene::{LightKind, LocalTransform, Scene};
use glam::{Vec2, Vec3};

use super::projection::Projection;

/// Points of a handle's radius.
pub const HANDLE: f32 = 7.0;

/// Something that can be dragged.
#[derive(Clone, Debug, PartialEq)]
pub struct Handle {
    /// What it is.
    pub what: What,
    /// Where it is, metres.
    pub at: Vec3,
    /// For people.
    pub name: String,
}

/// Part of a scene, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// A near emitter.
    Emitter(usize),
    /// A point or spot light.
    Light(usize),
    /// A figure.
    Figure(usize),
}

/// All that can be dragged in a scene, figures where they are `seconds` after its time 0.
pub fn handles(scene: &Scene, seconds: f64) -> Vec<Handle> {
    let emitters = scene.emitters.iter().enumerate().map(|(index, emitter)| Handle {
        what: What::Emitter(index),
        at: emitter.center.into(),
        name: emitter.name.clone(),
    });
    let lights = scene.lights.iter().enumerate().filter_map(|(index, light)| match light.kind {
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
            Some(Handle { what: What::Light(index), at: position.into(), name: light.name.clone() })
        }
        LightKind::Directional { .. } => None,
    });
    let figures = scene.figures.iter().enumerate().filter_map(|(index, figure)| {
        let root = *scene.pose(figure, seconds as f32).get(figure.root)?;
        let at = root.w_axis.truncate();
        Some(Handle { what: What::Figure(index), at, name: figure.name.clone() })
    });
    emitters.chain(lights).chain(figures).collect()
}

/// The handle under the mouse.
pub fn under(handles: &[Handle], projection: &Projection, mouse: Vec2, scale: f32) -> Option<usize> {
    let apart = |handle: &Handle| Some(projection.pixel(handle.at)?.0.distance(mouse));
    let near = |(number, handle)| Some((number, apart(handle)?));
    let nearest = handles.iter().enumerate().filter_map(near).min_by(|a, b| a.1.total_cmp(&b.1))?;
    (nearest.1 < 1.8 * HANDLE * scale).then_some(nearest.0)
}

impl Handle {
    /// Where it goes when the mouse drags it to a pixel: lamps in the plane of the picture, figures on their ground.
    pub fn dragged(&self, projection: &Projection, mouse: Vec2) -> Option<Vec3> {
        match self.what {
            What::Emitter(_) | What::Light(_) => projection.beside(self.at, mouse),
            What::Figure(_) => projection.level(self.at, mouse),
        }
    }

    /// Moves it by so much.
    pub fn shift(&self, scene: &mut Scene, by: Vec3) {
        let moved = |place: [f32; 3]| (Vec3::from(place) + by).to_array();
        match self.what {
            What::Emitter(index) => {
                if let Some(emitter) = scene.emitters.get_mut(index) {
                    emitter.center = moved(emitter.center);
                }
            }
            What::Light(index) => {
                let kind = scene.lights.get_mut(index).map(|light| &mut light.kind);
                if let Some(LightKind::Point { position, .. } | LightKind::Spot { position, .. }) = kind {
                    *position = moved(*position);
                }
            }
            What::Figure(index) => {
                let Some(root) = scene.figures.get(index).map(|figure| figure.root) else { return };
                match scene.nodes.get_mut(root).map(|node| &mut node.local) {
                    Some(LocalTransform::Components { translation, .. }) => *translation += by,
                    Some(LocalTransform::Matrix(matrix)) => matrix.w_axis += by.extend(0.0),
                    None => {}
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_scene::{Camera, Light, Sphere};

    #[test]
    fn a_lamp_follows_the_mouse() {
        let position = [0.2, 0.9, -0.3];
        let kind = LightKind::Point { position, intensity: [1.0; 3], range: None };
        let lamp = Light { name: "lamp".to_owned(), node: 0, kind };
        let mut scene = Scene { lights: vec![lamp], ..Scene::default() };
        let camera = Camera::framing(Sphere { center: [0.0; 3], radius: 2.0 });
        let projection = Projection::new(&camera, [320, 240]);
        let before = handles(&scene, 0.0);
        let pixel = projection.pixel(before[0].at).unwrap().0;
        assert_eq!(under(&before, &projection, pixel + Vec2::new(5.0, 3.0), 1.0), Some(0));
        assert_eq!(under(&before, &projection, pixel + Vec2::new(50.0, 3.0), 1.0), None);
        let mouse = pixel + Vec2::new(40.0, -25.0);
        let by = before[0].dragged(&projection, mouse).unwrap() - before[0].at;
        before[0].shift(&mut scene, by);
        let after = projection.pixel(handles(&scene, 0.0)[0].at).unwrap().0;
        assert!(after.distance(mouse) < 0.1, "{after} instead of {mouse}");
    }
}
