//! A cube map of triangles around a point, and its projection on spherical harmonics.
//!
//! Sun 2005, section 3.3.4, with the exact solid angle of each texel in the place of its midpoint rule. Triangles are
//! rasterised in homogeneous form (Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates",
//! 1997): no clipping, whatever lies behind the point or around it.

use airglow_math::sh::{coefficient_count, evaluate};
use airglow_math::sphere::cube::{Face, SolidAngles};
use glam::{DMat3, DVec3};

use super::slope::slopes;

use crate::shown::Pyramid;
use crate::{Incident, Lights, RadianceError, Triangle};

/// Cube maps of one face size, projected to one order.
#[derive(Clone, Debug)]
pub struct Cube {
    size: usize,
    order: usize,
    /// Rays along a side of a texel.
    rays: usize,
    /// Whether rays lie in rows and columns.
    straight: bool,
    /// Solid angle of each texel of a face.
    solid_angles: Vec<f64>,
    /// Basis at each texel's centre, `[face][y][x][coefficient]`.
    basis: Vec<f64>,
    /// Its gradients on the sphere, same shape; empty unless gradients are asked for.
    slopes: Vec<DVec3>,
}

/// What a ray sees: the radiance and distance of the nearest triangle.
#[derive(Clone, Copy)]
struct Seen {
    distance: f64,
    radiance: DVec3,
    /// The triangle's normal over its product with the unit ray.
    tilt: DVec3,
}

/// Where a ray meets a triangle: the shares of its corners, and the distance along the face's normal.
struct Hit {
    shares: [f64; 3],
    depth: f64,
}

/// What a triangle, by its number, sends to a ray, where that is not its one radiance.
type Shows<'a> = dyn Fn(usize, &Hit) -> Option<DVec3> + 'a;

const EMPTY: Seen = Seen { distance: f64::INFINITY, radiance: DVec3::ZERO, tilt: DVec3::ZERO };

impl Cube {
    /// Tables for faces of `size` by `size` texels.
    ///
    /// # Errors
    /// The order unless it is 1 to [`airglow_math::sh::MAX_ORDER`]; the size unless it is 1 to 512.
    pub fn new(order: usize, size: usize) -> Result<Self, RadianceError> {
        if !(1..=512).contains(&size) {
            return Err(RadianceError::setting("face size", size, "1 to 512 texels"));
        }
        let angles = SolidAngles::new(size)?;
        let mut solid_angles = Vec::with_capacity(size * size);
        for texel in 0..size * size {
            solid_angles.push(angles.get(texel % size, texel / size)?);
        }
        let mut basis = vec![0.0; 6 * size * size * coefficient_count(order)];
        airglow_math::sh::check_order(order)?;
        for (texel, values) in basis.chunks_exact_mut(coefficient_count(order)).enumerate() {
            let ray = ray(Face::ALL[texel / (size * size)], size, texel % size, texel / size % size);
            evaluate(order, ray.normalize(), values)?;
        }
        Ok(Self { size, order, rays: 1, straight: false, solid_angles, basis, slopes: Vec::new() })
    }

    /// The same cube, that sends `rays` by `rays` rays through each texel, whose basis is then taken in the middle of those
    /// that meet what emits.
    ///
    /// # Errors
    /// [`RadianceError::Setting`] unless there are 1 to 16.
    pub fn with_rays(mut self, rays: usize) -> Result<Self, RadianceError> {
        if !(1..=16).contains(&rays) {
            return Err(RadianceError::setting("rays", rays, "1 to 16 along a side of a texel"));
        }
        self.rays = rays;
        Ok(self)
    }

    /// The same cube, whose rays lie in rows and columns, as those of a rasteriser do.
    #[must_use]
    pub fn with_straight_rays(self) -> Self {
        Self { straight: true, ..self }
    }

    /// The same cube, whose samples hold gradients, too.
    #[must_use]
    pub fn with_gradients(mut self) -> Self {
        let count = coefficient_count(self.order);
        let face = self.size * self.size;
        for (texel, values) in self.basis.chunks_exact(count).enumerate() {
            let ray =
                ray(Face::ALL[texel / face], self.size, texel % self.size, texel / self.size % self.size);
            self.slopes.extend(slopes(self.order, ray.normalize(), values));
        }
        self
    }

    /// Radiance that arrives at `point` from triangles that hide one another. A triangle seen edge-on, of no area, or
    /// touching the point with its plane has no solid angle and is not seen.
    ///
    /// # Errors
    /// None that [`Cube::new`] has not found.
    pub fn sample(&self, point: DVec3, triangles: &[Triangle]) -> Result<Incident, RadianceError> {
        self.seen(point, triangles, &|_, _| None, DVec3::ZERO)
    }

    /// The same of all that lights are: pictures are read where rays meet them, and a medium dims what it is before.
    ///
    /// # Errors
    /// [`RadianceError::Length`] and [`RadianceError::Value`] for faulty pictures.
    pub fn sample_lights(&self, point: DVec3, lights: &Lights<'_>) -> Result<Incident, RadianceError> {
        lights.check()?;
        let pyramids: Vec<_> = lights.pictures.iter().map(Pyramid::new).collect::<Result<_, _>>()?;
        let width = 2.0 / self.fine() as f64;
        let shows = |number: usize, hit: &Hit| {
            let shown = lights.shown.get(number.checked_sub(lights.emitters.len())?)?;
            let places = shown.places.iter().zip(hit.shares).map(|(place, share)| share * *place);
            let texels = shown.density(lights.pictures[shown.picture].size) * width * hit.depth;
            Some(pyramids[shown.picture].at(places.sum(), texels.max(1e-30).log2()))
        };
        self.seen(point, &lights.triangles(), &shows, DVec3::from(lights.extinction.map(f64::from)))
    }

    fn seen(
        &self,
        point: DVec3,
        triangles: &[Triangle],
        shows: &Shows<'_>,
        extinction: DVec3,
    ) -> Result<Incident, RadianceError> {
        let mut incident = Incident::dark(self.order)?;
        if !self.slopes.is_empty() {
            incident.gradients = vec![DMat3::ZERO; incident.coefficients.len()];
        }
        let mut seen = vec![EMPTY; self.fine() * self.fine()];
        for face in Face::ALL {
            seen.fill(EMPTY);
            for (number, triangle) in triangles.iter().enumerate() {
                self.rasterise(face, point, triangle, &|hit| shows(number, hit), &mut seen);
            }
            for ray in seen.iter_mut().filter(|ray| extinction != DVec3::ZERO && ray.distance.is_finite()) {
                ray.radiance *= (-extinction * ray.distance).exp();
            }
            self.project(face, &seen, extinction, &mut incident)?;
        }
        Ok(incident)
    }

    /// Rays along a side of a face.
    fn fine(&self) -> usize {
        self.size * self.rays
    }

    /// Where a ray passes its face, in -1 to 1. Rows and columns are sheared, so that all rays of a texel have rows and columns
    /// of their own, and edges along the axes, which are many, pass as many rays as others do (Chiu, Shirley, Wang,
    /// "Multi-Jittered Sampling", Graphics Gems IV, 1994, without the jitter). The quarters of a face mirror one another, so
    /// that no turn of the axes changes what is seen.
    fn place(&self, x: usize, y: usize) -> [f64; 2] {
        let [middle_x, middle_y] = [x, y].map(|i| (2 * i + 1) as f64 - self.fine() as f64);
        let turn = match self.straight {
            true => 0.0,
            false => (middle_x * middle_y).signum(),
        };
        let shear = |across: usize| turn * ((2 * (across % self.rays) + 1) as f64 / self.rays as f64 - 1.0);
        [middle_x + shear(y), middle_y + shear(x)].map(|place| place / self.fine() as f64)
    }

    /// Keeps, in each ray of a face, the triangle if it is nearer than what is there.
    fn rasterise(
        &self,
        face: Face,
        point: DVec3,
        triangle: &Triangle,
        shows: &dyn Fn(&Hit) -> Option<DVec3>,
        seen: &mut [Seen],
    ) {
        let [mut a, mut b, c] = triangle.corners.map(|corner| corner - point);
        let mut volume = a.dot(b.cross(c));
        let turned = volume < 0.0;
        if turned {
            (a, b, volume) = (b, a, -volume);
        }
        let Some([columns, rows]) = self.rectangle(face, [a, b, c]) else { return };
        let edges = [b.cross(c), c.cross(a), a.cross(b)];
        if volume == 0.0 {
            return;
        }
        let normal = edges.iter().sum::<DVec3>();
        for y in rows[0]..rows[1] {
            for x in columns[0]..columns[1] {
                let ray = through(face, self.place(x, y));
                let weights = edges.map(|edge| edge.dot(ray));
                if weights.iter().any(|weight| *weight < 0.0) {
                    continue;
                }
                let along = weights.iter().sum::<f64>();
                let distance = volume / along * ray.length();
                let nearest = &mut seen[y * self.fine() + x];
                if distance < nearest.distance {
                    let tilt = ray.length() / along * normal;
                    let [first, second, third] = weights.map(|weight| weight / along);
                    let shares = if turned { [second, first, third] } else { [first, second, third] };
                    let radiance = shows(&Hit { shares, depth: volume / along }).unwrap_or(triangle.radiance);
                    *nearest = Seen { distance, radiance, tilt };
                }
            }
        }
    }

    /// Columns and rows that hold the triangle: its bounding rectangle where it lies before the face's eye, the whole
    /// face where it reaches behind; none where it lies behind.
    fn rectangle(&self, face: Face, corners: [DVec3; 3]) -> Option<[[usize; 2]; 2]> {
        let [right, down, normal] = face.axes();
        let depths = corners.map(|corner| corner.dot(normal));
        if depths.iter().all(|depth| *depth <= 0.0) {
            return None;
        }
        if depths.iter().any(|depth| *depth <= 0.0) {
            return Some([[0, self.fine()]; 2]);
        }
        let range = |axis: DVec3| {
            let at = |i: usize| corners[i].dot(axis) / depths[i];
            let (low, high) = (at(0).min(at(1)).min(at(2)), at(0).max(at(1)).max(at(2)));
            // One ray more on each side makes up for rounding.
            let place = |x: f64| (0.5 * (x + 1.0) * self.fine() as f64).clamp(-1.0, self.fine() as f64 + 1.0);
            let first = (place(low).floor() as isize - 1).max(0) as usize;
            let end = (place(high).ceil() as isize + 1).max(0) as usize;
            [first.min(self.fine()), end.min(self.fine())]
        };
        Some([range(right), range(down)])
    }

    fn project(
        &self,
        face: Face,
        seen: &[Seen],
        extinction: DVec3,
        incident: &mut Incident,
    ) -> Result<(), RadianceError> {
        for (texel, solid_angle) in self.solid_angles.iter().enumerate() {
            let [x, y] = [texel % self.size, texel / self.size].map(|place| place * self.rays);
            let share = solid_angle / (self.rays * self.rays) as f64;
            let (mut middle, mut count) = ([0.0, 0.0], 0);
            let (mut power, mut slope, mut tilt) = (DVec3::ZERO, DVec3::ZERO, DMat3::ZERO);
            for ray in 0..self.rays * self.rays {
                let [x, y] = [x + ray % self.rays, y + ray / self.rays];
                let Seen { distance, radiance, tilt: normal } = seen[y * self.fine() + x];
                if radiance == DVec3::ZERO {
                    continue;
                }
                let at = self.place(x, y);
                (middle, count) = ([middle[0] + at[0], middle[1] + at[1]], count + 1);
                let near = share / distance * radiance;
                (power, slope) = (power + share * radiance, slope + near);
                tilt += DMat3::from_cols(normal.x * near, normal.y * near, normal.z * near);
                incident.solid_angle += share;
                incident.nearness += share / distance;
            }
            if count == 0 {
                continue;
            }
            incident.slope += slope;
            let ray = through(face, middle.map(|sum| sum / count as f64)).normalize();
            let whole = count == self.rays * self.rays;
            let place = face as usize * self.solid_angles.len() + texel;
            // A medium dims less when the way is shorter: what a step along the ray adds.
            let along = 3.0 * slope + extinction * power;
            self.add(place, whole, ray, [power, slope, along], tilt, incident)?;
        }
        Ok(())
    }

    /// Adds a texel's part: of light its power, of gradients its slope and tilt. A patch of area dA at s from the point,
    /// normal n, sends `L Y(s/|s|) n.s / |s|^3 dA`; moving the point is moving s the other way (Annen et al. 2004,
    /// section 3). Where the `whole` texel emits, the basis at its ray is in the tables.
    fn add(
        &self,
        place: usize,
        whole: bool,
        ray: DVec3,
        [power, slope, along]: [DVec3; 3],
        tilt: DMat3,
        incident: &mut Incident,
    ) -> Result<(), RadianceError> {
        let count = incident.coefficients.len();
        let range = place * count..(place + 1) * count;
        let mut values = self.basis[range.clone()].to_vec();
        if !whole {
            evaluate(self.order, ray, &mut values)?;
        }
        incident.coefficients.iter_mut().zip(&values).for_each(|(l, y)| *l += *y * power);
        if self.slopes.is_empty() {
            return Ok(());
        }
        let change = DMat3::from_cols(ray.x * along, ray.y * along, ray.z * along) - tilt;
        let slopes = if whole { self.slopes[range].to_vec() } else { slopes(self.order, ray, &values) };
        for (gradient, (y, s)) in incident.gradients.iter_mut().zip(values.iter().zip(slopes)) {
            *gradient += change * *y - DMat3::from_cols(s.x * slope, s.y * slope, s.z * slope);
        }
        Ok(())
    }
}

/// The ray through a texel's centre, on the cube of half-side 1.
fn ray(face: Face, size: usize, x: usize, y: usize) -> DVec3 {
    through(face, [x, y].map(|i| (2 * i + 1) as f64 / size as f64 - 1.0))
}

/// The ray through a place on the cube of half-side 1.
fn through(face: Face, [x, y]: [f64; 2]) -> DVec3 {
    let [right, down, normal] = face.axes();
    normal + x * right + y * down
}
