//! What triangles show, and what dims it on its way, as the kernel of texels reads it: `radiance/surface.glsl`, seen from the
//! host.

use bytemuck::{Pod, Zeroable};

use crate::shown::Pyramid;
use crate::{Lights, RadianceError};

/// A triangle that shows a picture.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DeviceSurface {
    /// (u, v) of two corners.
    pub first: [f32; 4],
    /// (u, v) of the third, and texels along a metre.
    pub last: [f32; 4],
    /// Place of the first texel, columns, rows, and levels.
    pub picture: [u32; 4],
}

/// All of them, with the texels of all levels of all pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfaces {
    /// Triangles that show pictures: the first ones after those of uniform radiance.
    pub shown: Vec<DeviceSurface>,
    /// RGB, 0.
    pub texels: Vec<[f32; 4]>,
    /// How many triangles show pictures; there is one entry more where there are none, since a buffer cannot be empty.
    pub count: u32,
    /// 1/m, RGB.
    pub extinction: [f32; 3],
}

impl Surfaces {
    /// Those of lights that were checked.
    ///
    /// # Errors
    /// As [`Control::set`](crate::Control::set), for pictures.
    pub fn new(lights: &Lights<'_>) -> Result<Self, RadianceError> {
        let mut texels = Vec::new();
        let mut pictures = Vec::new();
        for picture in lights.pictures {
            let pyramid = Pyramid::new(picture)?;
            let [columns, rows] = picture.size.map(|side| side as u32);
            pictures.push([texels.len() as u32, columns, rows, pyramid.levels.len() as u32]);
            let levels = pyramid.levels.iter().flat_map(|level| &level.texels);
            texels.extend(levels.map(|[r, g, b]| [*r, *g, *b, 0.0]));
        }
        let surface = |shown: &crate::Shown| {
            let [p, q, r] = shown.places.map(|place| place.as_vec2());
            let picture = *pictures.get(shown.picture)?;
            let density = shown.density(lights.pictures[shown.picture].size) as f32;
            Some(DeviceSurface { first: [p.x, p.y, q.x, q.y], last: [r.x, r.y, density, 0.0], picture })
        };
        let mut shown: Vec<_> = lights.shown.iter().filter_map(surface).collect();
        let count = shown.len() as u32;
        shown.resize(shown.len().max(1), DeviceSurface::default());
        texels.resize(texels.len().max(1), [0.0; 4]);
        Ok(Self { shown, texels, count, extinction: lights.extinction })
    }
}
