//! A normal map and the texels of level 0 that a texel of a coarser level covers.

use airglow_math::World;
use glam::DVec3;

use crate::NormalsError;

/// Texels of the largest map: 16384 x 16384, what devices offer.
const MAX_TEXELS: usize = 1 << 28;

/// Vectors shorter than this have no direction left in any format of normal maps.
const SHORTEST: f64 = 1e-3;

/// Unit normals in tangent space, row by row, z away from the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalMap {
    width: usize,
    height: usize,
    normals: Vec<DVec3>,
    repaired: usize,
}

/// A direction in a footprint, with its share of the area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Share of the footprint; the shares of one footprint sum to 1.
    pub weight: f64,
    /// The mean of the normals the sample stands for: a unit normal, or the shorter mean of a lobe.
    pub mean: DVec3,
}

impl NormalMap {
    /// A map of vectors of any length, which are normalised. Components keep their signs: nothing is flipped.
    ///
    /// A vector without direction (not finite, or shorter than 1e-3) becomes the flat normal +Z and is counted in
    /// [`NormalMap::repaired`]. Normals below the horizon stay.
    ///
    /// # Errors
    /// [`NormalsError::Size`] unless there are `width * height` vectors, 1 to 2^28.
    pub fn from_vectors(width: usize, height: usize, vectors: &[[f32; 3]]) -> Result<Self, NormalsError> {
        let texels = vectors.len();
        let refuse = |mend| Err(NormalsError::Size { width, height, texels, mend });
        match width.checked_mul(height) {
            Some(0) | None => return refuse("give at least one texel, and sizes whose product is a number"),
            Some(expected) if expected != texels => return refuse("give width times height texels"),
            Some(expected) if expected > MAX_TEXELS => return refuse("scale it down to 16384 x 16384"),
            Some(_) => {}
        }
        let mut repaired = 0;
        let normals = vectors.iter().map(|&[x, y, z]| {
            let vector = DVec3::new(x.into(), y.into(), z.into());
            let length = vector.length();
            if length.is_finite() && length >= SHORTEST {
                vector / length
            } else {
                repaired += 1;
                DVec3::Z
            }
        });
        let normals = normals.collect();
        Ok(Self { width, height, normals, repaired })
    }

    /// A map of unsigned components, as PNG files hold them: 0 is -1 and `largest` (255 or 65535) is +1.
    ///
    /// # Errors
    /// As [`NormalMap::from_vectors`].
    pub fn from_unsigned(
        width: usize,
        height: usize,
        texels: &[[u16; 3]],
        largest: u16,
    ) -> Result<Self, NormalsError> {
        let scale = 2.0 / f32::from(largest.max(1));
        let vectors: Vec<_> = texels.iter().map(|texel| texel.map(|c| f32::from(c) * scale - 1.0)).collect();
        Self::from_vectors(width, height, &vectors)
    }

    /// A map of two channels, as BC5 holds them: `z = sqrt(1 - x^2 - y^2)`, 0 where that has no root.
    ///
    /// # Errors
    /// As [`NormalMap::from_vectors`].
    pub fn from_two_channels(width: usize, height: usize, texels: &[[f32; 2]]) -> Result<Self, NormalsError> {
        let z = |x: f32, y: f32| (1.0 - x * x - y * y).max(0.0).sqrt();
        let vectors: Vec<_> = texels.iter().map(|&[x, y]| [x, y, z(x, y)]).collect();
        Self::from_vectors(width, height, &vectors)
    }

    /// The map of a host whose green points as its world says, with green that points up.
    #[must_use]
    pub fn of_host(mut self, world: &World) -> Self {
        let sign = world.green_sign();
        self.normals.iter_mut().for_each(|normal| normal.y *= sign);
        self
    }

    /// Texels that had no direction.
    #[must_use]
    pub fn repaired(&self) -> usize {
        self.repaired
    }

    /// The unit normals of level 0, row by row.
    #[must_use]
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// Levels down to the one of a single texel.
    #[must_use]
    pub fn levels(&self) -> usize {
        self.width.max(self.height).ilog2() as usize + 1
    }

    /// Width and height of a level, halved and rounded down as Vulkan does, never below 1.
    #[must_use]
    pub fn size(&self, level: usize) -> [usize; 2] {
        [self.width, self.height].map(|size| size.checked_shr(level as u32).unwrap_or(0).max(1))
    }

    /// The normals of level 0 under a texel, each with its share of the area. Sizes that are no powers of two share
    /// texels between footprints, so that the footprints of a level tile the map at any size.
    ///
    /// # Errors
    /// [`NormalsError::Texel`].
    pub fn footprint(&self, level: usize, x: usize, y: usize) -> Result<Vec<Sample>, NormalsError> {
        let [width, height] = self.size(level);
        if level >= self.levels() || x >= width || y >= height {
            return Err(NormalsError::Texel { level, x, y, width, height });
        }
        let columns = shares(self.width, width, x);
        let mut samples = Vec::new();
        for (row, of_row) in shares(self.height, height, y) {
            for &(column, of_column) in &columns {
                let mean = self.normals[row * self.width + column];
                samples.push(Sample { weight: of_row * of_column, mean });
            }
        }
        Ok(samples)
    }
}

/// Which of `fine` texels lie under texel `place` of `coarse`, and what share of it each covers.
fn shares(fine: usize, coarse: usize, place: usize) -> Vec<(usize, f64)> {
    // In units of 1 / coarse of a fine texel all borders are whole numbers.
    let (begin, end) = (place * fine, (place + 1) * fine);
    let share = |texel: usize| {
        let covered = end.min((texel + 1) * coarse) - begin.max(texel * coarse);
        (texel, covered as f64 / fine as f64)
    };
    (begin / coarse..end.div_ceil(coarse)).map(share).collect()
}
