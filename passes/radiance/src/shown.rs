//! Emitters whose radiance is read from a picture where a ray meets them: screens and windows, at every frame another.
//!
//! A picture is a pyramid of means (Williams, "Pyramidal Parametrics", 1983). A ray reads it, linearly between texels and
//! levels, at the level whose texels are as wide as the ray: nothing that many rays would see falls between them.

use glam::{DVec2, DVec3};

use crate::{Picture, RadianceError, Triangle};

/// A triangle that shows a part of a picture, the same from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    /// Corners, metres.
    pub corners: [DVec3; 3],
    /// (u, v) of the corners, the picture repeated.
    pub places: [DVec2; 3],
    /// Index into [`Lights::pictures`](crate::Lights::pictures).
    pub picture: usize,
}

/// A level of a pyramid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Level {
    /// Columns and rows.
    pub size: [usize; 2],
    pub texels: Vec<[f32; 3]>,
}

/// A picture and what it is from farther and farther away: sides halved, rounded down, to one texel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pyramid {
    pub levels: Vec<Level>,
}

impl Pyramid {
    pub(crate) fn new(picture: &Picture<'_>) -> Result<Self, RadianceError> {
        picture.check()?;
        let mut levels = vec![Level { size: picture.size, texels: picture.texels.to_vec() }];
        while let Some(last) = levels.last().filter(|level| level.size != [1, 1]) {
            let next = last.halved();
            levels.push(next);
        }
        Ok(Self { levels })
    }

    /// What is seen at (u, v) through texels of a level, linearly between levels; the first and the last beyond them.
    pub(crate) fn at(&self, place: DVec2, level: f64) -> DVec3 {
        let level = level.clamp(0.0, (self.levels.len() - 1) as f64);
        let finer = level.floor() as usize;
        let coarser = (finer + 1).min(self.levels.len() - 1);
        self.levels[finer].at(place).lerp(self.levels[coarser].at(place), level - level.floor())
    }
}

impl Level {
    /// Means over the texels of half as many a side.
    fn halved(&self) -> Self {
        let size = self.size.map(|side| (side / 2).max(1));
        let mean = |texel: usize| {
            let [x, y] = [texel % size[0], texel / size[0]];
            let (columns, rows) = (parts(x, size[0], self.size[0]), parts(y, size[1], self.size[1]));
            let mut sum = DVec3::ZERO;
            for (row, height) in &rows {
                for (column, width) in &columns {
                    let texel = self.texels[row * self.size[0] + column];
                    sum += *width * *height * DVec3::from(texel.map(f64::from));
                }
            }
            sum.as_vec3().to_array()
        };
        Self { size, texels: (0..size[0] * size[1]).map(mean).collect() }
    }

    /// Linearly between the middles of texels, the picture repeated.
    fn at(&self, place: DVec2) -> DVec3 {
        let [width, height] = self.size;
        let at = place * DVec2::new(width as f64, height as f64) - 0.5;
        let (low, part) = (at.floor(), at - at.floor());
        let texel = |x: f64, y: f64| {
            let column = ((low.x + x).rem_euclid(width as f64) as usize).min(width - 1);
            let row = ((low.y + y).rem_euclid(height as f64) as usize).min(height - 1);
            DVec3::from(self.texels[row * width + column].map(f64::from))
        };
        let above = texel(0.0, 0.0).lerp(texel(1.0, 0.0), part.x);
        above.lerp(texel(0.0, 1.0).lerp(texel(1.0, 1.0), part.x), part.y)
    }
}

/// The old texels that a new one covers, and what part of it each is.
fn parts(new: usize, new_count: usize, old_count: usize) -> Vec<(usize, f64)> {
    let width = old_count as f64 / new_count as f64;
    let (begin, end) = (new as f64 * width, (new + 1) as f64 * width);
    let old = begin.floor() as usize..(end.ceil() as usize).min(old_count);
    let inside = |old: usize| (end.min((old + 1) as f64) - begin.max(old as f64)) / width;
    old.map(|old| (old, inside(old))).collect()
}

impl Shown {
    /// The triangle of the mean radiance that it shows.
    pub(crate) fn mean(&self, picture: &Picture<'_>) -> Triangle {
        let size = DVec2::new(picture.size[0] as f64, picture.size[1] as f64);
        Triangle { corners: self.corners, radiance: picture.mean(self.places.map(|place| place * size)) }
    }

    /// Texels of a picture of this size along a metre of the triangle, the geometric mean over directions; 0 where it has
    /// no area.
    pub(crate) fn density(&self, size: [usize; 2]) -> f64 {
        let [[a, b, c], [p, q, r]] = [self.corners, self.places.map(|place| place.extend(0.0))];
        let area = (b - a).cross(c - a).length();
        let shown = (q - p).cross(r - p).length() * (size[0] * size[1]) as f64;
        if area > 0.0 { (shown / area).sqrt() } else { 0.0 }
    }

    /// Refuses what is not finite, and pictures that are not there.
    pub(crate) fn check(shown: &[Self], pictures: usize) -> Result<(), RadianceError> {
        let sound = |shown: &Self| {
            let finite = shown.corners.iter().all(|corner| corner.is_finite());
            finite && shown.places.iter().all(|place| place.is_finite()) && shown.picture < pictures
        };
        match shown.iter().position(|shown| !sound(shown)) {
            None => Ok(()),
            Some(index) => {
                let value = format!("{:?}", shown[index]);
                Err(RadianceError::Value { what: "triangle that shows a picture", index, value })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_keep_the_mean_and_middles_of_texels_are_the_texels() {
        let texels: Vec<[f32; 3]> = (0..35).map(|i| [i as f32, (i * i % 11) as f32, 1.0]).collect();
        let pyramid = Pyramid::new(&Picture { size: [7, 5], texels: &texels }).unwrap();
        let sizes: Vec<_> = pyramid.levels.iter().map(|level| level.size).collect();
        assert_eq!(sizes, [[7, 5], [3, 2], [1, 1]]);
        let mean = |level: &Level| {
            let sum: DVec3 = level.texels.iter().map(|texel| DVec3::from(texel.map(f64::from))).sum();
            sum / level.texels.len() as f64
        };
        let all: Vec<_> = pyramid.levels.iter().map(mean).collect();
        assert!(all.iter().all(|level| level.distance(all[0]) < 1e-5), "{all:?}");
        let middle = pyramid.at(DVec2::new(2.5 / 7.0, 3.5 / 5.0), 0.0);
        assert!((middle.x - 23.0).abs() < 1e-9, "{middle} is not texel 23");
        let between = pyramid.at(DVec2::new(0.4, -0.7), 1.25);
        let [finer, coarser] = [1.0, 2.0].map(|level| pyramid.at(DVec2::new(0.4, -0.7), level));
        assert!(between.distance(finer.lerp(coarser, 0.25)) < 1e-12);
        assert_eq!(pyramid.at(DVec2::ZERO, 99.0), pyramid.at(DVec2::ONE, 2.0));
    }
}
