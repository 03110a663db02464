//! Emitters that show a picture: screens and windows, as triangles that each have the mean of what they show.
//!
//! The picture is constant over each of its texels, so the mean over a triangle is a sum of areas of the triangle's parts
//! within texels, by clipping (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974): no light is lost or added.

use glam::{DVec2, DVec3};

use crate::{RadianceError, Triangle};

/// Most times that a triangle is cut in four.
const MOST_CUTS: u32 = 8;
/// Most texels that the longest side of a part may span.
const MOST_TEXELS: f64 = 1024.0;

/// Radiance as a picture, W/sr/m2, linear RGB: row by row, the first where v is 0; it repeats outside of `[0, 1]`.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// Columns and rows.
    pub size: [usize; 2],
    /// As many texels.
    pub texels: &'a [[f32; 3]],
}

impl Picture<'_> {
    /// A triangle that shows the picture between `places`, (u, v) of its corners, as triangles whose sides span at most
    /// `texels` texels, each of the mean radiance of what it shows. The fewer texels the finer: a part as wide as a ray of a
    /// sample's cube map is fine enough.
    ///
    /// # Errors
    /// [`RadianceError::Length`] unless there are as many texels as the size says; [`RadianceError::Value`] for a texel, corner or
    /// place that is not finite, or negative radiance; [`RadianceError::Setting`] for a picture without texels, for more than
    /// 1024 texels a part, and for so few that there would be more than 65 536 parts.
    pub fn triangles(
        &self,
        corners: [DVec3; 3],
        places: [DVec2; 3],
        texels: f64,
    ) -> Result<Vec<Triangle>, RadianceError> {
        self.check()?;
        if !places.iter().all(|place| place.is_finite()) || !corners.iter().all(|corner| corner.is_finite()) {
            let value = format!("{corners:?} at {places:?}");
            return Err(RadianceError::Value { what: "triangle that shows a picture", index: 0, value });
        }
        let size = DVec2::new(self.size[0] as f64, self.size[1] as f64);
        let [a, b, c] = places.map(|place| place * size);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let cuts = (longest / texels).log2().ceil().max(0.0);
        if !(texels > 0.0 && texels <= MOST_TEXELS && cuts <= f64::from(MOST_CUTS)) {
            let range = "at most 1024 and more than a 256th of what the triangle's longest side spans";
            return Err(RadianceError::setting("texels of a part", texels, range));
        }
        let mut parts = vec![(corners, [a, b, c])];
        for _ in 0..cuts as u32 {
            parts = parts.into_iter().flat_map(cut).collect();
        }
        let part =
            |(corners, places): ([DVec3; 3], [DVec2; 3])| Triangle { corners, radiance: self.mean(places) };
        Ok(parts.into_iter().map(part).collect())
    }

    pub(crate) fn check(&self) -> Result<(), RadianceError> {
        let [width, height] = self.size;
        let (expected, actual) = (width.saturating_mul(height), self.texels.len());
        if expected == 0 {
            let value = format!("{width} x {height}");
            return Err(RadianceError::setting("the picture's size", value, "at least one texel"));
        }
        if expected != actual {
            return Err(RadianceError::Length { what: "the picture's texels", expected, actual });
        }
        let bad = |texel: &[f32; 3]| texel.iter().any(|x| !x.is_finite() || *x < 0.0);
        match self.texels.iter().position(bad) {
            None => Ok(()),
            Some(index) => {
                let value = format!("{:?}", self.texels[index]);
                Err(RadianceError::Value { what: "texel of a picture", index, value })
            }
        }
    }

    /// Mean over a triangle, corners in texels; the texel at its middle where it has no area.
    pub(crate) fn mean(&self, corners: [DVec2; 3]) -> DVec3 {
        let [a, b, c] = corners;
        let (low, high) = (a.min(b).min(c).floor(), a.max(b).max(c).ceil());
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        let (columns, rows) = ((high.x - low.x) as usize, (high.y - low.y) as usize);
        for texel in 0..columns * rows {
            let corner = low + DVec2::new((texel % columns) as f64, (texel / columns) as f64);
            let inside = area(&within(&corners, corner)).abs();
            (sum, total) = (sum + inside * self.at(corner), total + inside);
        }
        if total > 0.0 { sum / total } else { self.at(((a + b + c) / 3.0).floor()) }
    }

    /// The texel of this corner, the picture repeated.
    fn at(&self, corner: DVec2) -> DVec3 {
        let [width, height] = self.size;
        let column = corner.x.rem_euclid(width as f64) as usize;
        let row = corner.y.rem_euclid(height as f64) as usize;
        DVec3::from(self.texels[row.min(height - 1) * width + column.min(width - 1)].map(f64::from))
    }
}

type Part = ([DVec3; 3], [DVec2; 3]);

/// A triangle in four.
fn cut(([a, b, c], [p, q, r]): Part) -> [Part; 4] {
    let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
    let [pq, qr, rp] = [p.midpoint(q), q.midpoint(r), r.midpoint(p)];
    [
        ([a, ab, ca], [p, pq, rp]),
        ([ab, b, bc], [pq, q, qr]),
        ([ca, bc, c], [rp, qr, r]),
        ([ab, bc, ca], [pq, qr, rp]),
    ]
}

/// What of a polygon lies in the unit square at `corner`.
fn within(polygon: &[DVec2], corner: DVec2) -> Vec<DVec2> {
    let mut left = polygon.to_vec();
    for (axis, limit) in [
        (DVec2::X, corner.x),
        (DVec2::NEG_X, -corner.x - 1.0),
        (DVec2::Y, corner.y),
        (DVec2::NEG_Y, -corner.y - 1.0),
    ] {
        let height = |point: DVec2| axis.dot(point) - limit;
        let mut kept = Vec::with_capacity(left.len() + 1);
        for (i, point) in left.iter().enumerate() {
            let next = left[(i + 1) % left.len()];
            let [here, there] = [height(*point), height(next)];
            if here >= 0.0 {
                kept.push(*point);
            }
            if (here >= 0.0) != (there >= 0.0) {
                kept.push(point.lerp(next, here / (here - there)));
            }
        }
        left = kept;
    }
    left
}

/// Of a polygon, positive counter-clockwise.
fn area(polygon: &[DVec2]) -> f64 {
    let pairs = polygon.iter().zip(polygon.iter().cycle().skip(1));
    0.5 * pairs.map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    fn flux(triangles: &[Triangle]) -> DVec3 {
        let of = |triangle: &Triangle| {
            let [a, b, c] = triangle.corners;
            0.5 * (b - a).cross(c - a).length() * triangle.radiance
        };
        triangles.iter().map(of).sum()
    }

    /// However finely a triangle is cut, it sends the same light, that of the areas of its texels.
    #[test]
    fn cuts_lose_no_light() {
        let texels: Vec<[f32; 3]> = (0..12).map(|i| [i as f32, (i * i % 7) as f32, 1.0]).collect();
        let picture = Picture { size: [4, 3], texels: &texels };
        let places = [DVec2::new(0.1, -0.3), DVec2::new(0.9, 0.2), DVec2::new(0.3, 1.4)];
        let whole = picture.triangles(CORNERS, places, 100.0).unwrap();
        assert_eq!(whole.len(), 1);
        for (span, count) in [(4.0, 4), (2.0, 16), (0.5, 256)] {
            let parts = picture.triangles(CORNERS, places, span).unwrap();
            let (found, expected) = (flux(&parts), flux(&whole));
            assert_eq!(parts.len(), count);
            assert!(found.distance(expected) < 1e-12, "{span}: {found} is not {expected}");
            assert!((found.z - 0.5).abs() < 1e-12, "{found}");
        }
        // Half of two texels each: a quarter of the square below its diagonal has the second column.
        let halves = Picture { size: [2, 1], texels: &[[0.0; 3], [4.0, 0.0, 0.0]] };
        let corner = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let mean = halves.triangles(CORNERS, corner, 9.0).unwrap()[0].radiance.x;
        assert!((mean - 1.0).abs() < 1e-12, "{mean} is not 1");
    }

    #[test]
    fn faults_are_named() {
        let places = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let refused = |size, texels: &[[f32; 3]], span| {
            Picture { size, texels }.triangles(CORNERS, places, span).unwrap_err().to_string()
        };
        assert!(refused([0, 1], &[], 1.0).contains("size"));
        assert!(refused([2, 1], &[[1.0; 3]], 1.0).contains("1 elements but 2"));
        assert!(refused([1, 1], &[[f32::NAN; 3]], 1.0).contains("texel of a picture 0"));
        assert!(refused([1, 1], &[[1.0; 3]], 0.0).contains("texels of a part"));
        assert!(refused([1, 1], &[[1.0; 3]], 1e-4).contains("256th"));
        let flat = Picture { size: [1, 1], texels: &[[2.0; 3]] };
        assert_eq!(flat.triangles(CORNERS, [DVec2::ONE; 3], 1.0).unwrap()[0].radiance, DVec3::splat(2.0));
    }
}
