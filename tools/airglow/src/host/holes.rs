//! Holes of masked materials for bake rays: where the base colour's alpha is below the cutoff, light passes.

use airglow_bake::Mask;
use airglow_scene::{AlphaMode, Image, Mesh, Scene, Texture, Wrap};

/// The mask of one instance.
pub struct Holes<'a> {
    key: Vec<u8>,
    solid: Box<dyn Fn(usize, [f32; 2]) -> bool + Sync + 'a>,
}

impl Holes<'_> {
    /// As the bake wants it.
    pub fn mask(&self) -> Mask<'_> {
        Mask { key: &self.key, solid: &*self.solid }
    }
}

/// For each instance of the scene, its holes if its material has any.
pub fn of_scene(scene: &Scene) -> Vec<Option<Holes<'_>>> {
    scene
        .instances
        .iter()
        .map(|instance| {
            let material = &scene.materials[instance.material];
            let AlphaMode::Mask { cutoff } = material.alpha else { return None };
            let texture = material.base_color_texture?;
            let (mesh, image) = (&scene.meshes[instance.mesh], scene.images.get(texture.image)?);
            let factor = material.base_color[3];
            (!mesh.uv0.is_empty()).then(|| Holes {
                key: key(&texture, image, factor, cutoff),
                solid: Box::new(move |triangle, weights| {
                    factor * alpha(&texture, image, uv(mesh, triangle, weights)) >= cutoff
                }),
            })
        })
        .collect()
}

/// Everything that the answer depends on, for the cache.
fn key(texture: &Texture, image: &Image, factor: f32, cutoff: f32) -> Vec<u8> {
    let mut key = format!("{texture:?} {factor} {cutoff} {} {} ", image.width, image.height).into_bytes();
    key.extend(image.pixels.iter().map(|pixel| pixel[3]));
    key
}

/// Texture coordinates at the weights of a triangle's second and third vertex.
fn uv(mesh: &Mesh, triangle: usize, weights: [f32; 2]) -> [f32; 2] {
    let corner = |k: usize| {
        let index = mesh.indices.get(3 * triangle + k).copied().unwrap_or_default();
        mesh.uv0.get(index as usize).copied().unwrap_or_default()
    };
    let [a, b, c] = [corner(0), corner(1), corner(2)];
    [0, 1].map(|i| a[i] + weights[0] * (b[i] - a[i]) + weights[1] * (c[i] - a[i]))
}

/// Alpha of the nearest texel.
fn alpha(texture: &Texture, image: &Image, uv: [f32; 2]) -> f32 {
    let [u, v] = texture.transformed(uv);
    let x = wrapped(u, texture.wrap[0], image.width);
    let y = wrapped(v, texture.wrap[1], image.height);
    image.linear(x, y).map_or(1.0, |pixel| pixel[3])
}

/// The texel along one axis that a coordinate falls into.
fn wrapped(coordinate: f32, wrap: Wrap, size: u32) -> u32 {
    let within = match wrap {
        Wrap::Repeat => coordinate - coordinate.floor(),
        Wrap::MirroredRepeat => {
            let pair = coordinate.rem_euclid(2.0);
            if pair < 1.0 { pair } else { 2.0 - pair }
        }
        Wrap::ClampToEdge => coordinate.clamp(0.0, 1.0),
    };
    ((within * size as f32) as u32).min(size.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_wrap_as_stated() {
        let texels = |wrap| [1.3, -0.1, 0.6].map(|u| wrapped(u, wrap, 4));
        assert_eq!(texels(Wrap::Repeat), [1, 3, 2]);
        assert_eq!(texels(Wrap::MirroredRepeat), [2, 0, 2]);
        assert_eq!(texels(Wrap::ClampToEdge), [3, 0, 2]);
    }
}
