//! Lobes in few bits, as textures hold them.
//!
//! What rounding spoils is the length of the mean, on whose distance from 1 the concentration depends. So the weight is
//! rounded first, and of the 27 vectors around the rounded moment the one is taken that keeps that distance: a
//! mean is then turned by up to a step, but no wider.

use airglow_gpu::ash::vk::Format;
use glam::DVec3;
use half::f16;

use crate::mixture::WeightedLobe;
use crate::octahedral;

/// How a texture holds its lobes. Both formats are sampled with filters on every device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Storage {
    /// Four halves, 8 bytes a lobe.
    #[default]
    F16,
    /// Four signed bytes, 4 bytes a lobe, sampled as they are. Weights below 1/254 are lost.
    Snorm8,
    /// Axis, width and weight in four bytes ([`octahedral`]), 4 bytes a lobe: nearer than [`Storage::Snorm8`], and to be
    /// decoded by `normals_octahedral` of `lobe.glsl`. Weights below 1/510 are lost.
    Octahedral8,
}

impl Storage {
    /// Every storage, finest first.
    pub const ALL: [Self; 3] = [Self::F16, Self::Snorm8, Self::Octahedral8];

    /// Bytes of a lobe of one texel.
    #[must_use]
    pub fn lobe_bytes(self) -> u64 {
        match self {
            Self::F16 => 8,
            Self::Snorm8 | Self::Octahedral8 => 4,
        }
    }

    /// The texture's format.
    #[must_use]
    pub fn format(self) -> Format {
        match self {
            Self::F16 => Format::R16G16B16A16_SFLOAT,
            Self::Snorm8 => Format::R8G8B8A8_SNORM,
            Self::Octahedral8 => Format::R8G8B8A8_UNORM,
        }
    }

    /// A lobe as the texture holds it.
    #[must_use]
    pub fn round(self, lobe: WeightedLobe) -> WeightedLobe {
        if self == Self::Octahedral8 {
            return octahedral::decode(octahedral::encode(lobe).map(unsigned));
        }
        let weight = self.value(self.code(lobe.weight));
        if lobe.weight <= 0.0 || weight <= 0.0 {
            return WeightedLobe::default();
        }
        let scale = weight / lobe.weight;
        let missing = (lobe.weight - lobe.moment.length()).max(0.0) * scale;
        let start = (lobe.moment * scale).to_array().map(|component| self.code(component));
        let mut best = (f64::INFINITY, DVec3::ZERO);
        for i in 0..27 {
            // No step first, so that it is kept where nothing is nearer.
            let by = [i, i / 3, i / 9].map(|place| (place + 1) % 3 - 1);
            let component = |axis: usize| self.value(self.stepped(start[axis], by[axis]));
            let moment = DVec3::new(component(0), component(1), component(2));
            let error = (weight - moment.length() - missing).abs();
            if error < best.0 {
                best = (error, moment);
            }
        }
        WeightedLobe { weight, moment: best.1 }
    }

    /// Lobes from the bytes of a texture: moment and weight, as a shader has them.
    #[must_use]
    pub fn decode(self, bytes: &[u8]) -> Vec<[f32; 4]> {
        match self {
            Self::F16 => {
                let half = |pair: [u8; 2]| f16::from_le_bytes(pair).to_f32();
                bytes
                    .as_chunks::<8>()
                    .0
                    .iter()
                    .map(|b| std::array::from_fn(|i| half([b[2 * i], b[2 * i + 1]])))
                    .collect()
            }
            Self::Snorm8 => {
                let one = |byte: u8| (f32::from(byte.cast_signed()) / 127.0).max(-1.0);
                bytes.as_chunks::<4>().0.iter().map(|b| b.map(one)).collect()
            }
            Self::Octahedral8 => {
                let lobes = bytes.as_chunks::<4>().0.iter();
                lobes.map(|bytes| octahedral::decode(bytes.map(unsigned)).packed()).collect()
            }
        }
    }

    /// The bits of the number nearest to a component.
    fn code(self, component: f64) -> i32 {
        match self {
            Self::F16 => i32::from(f16::from_f64(component).to_bits()),
            Self::Snorm8 | Self::Octahedral8 => (component.clamp(-1.0, 1.0) * 127.0 + 0.5).floor() as i32,
        }
    }

    fn value(self, code: i32) -> f64 {
        match self {
            Self::F16 => f16::from_bits(code as u16).to_f64(),
            Self::Snorm8 | Self::Octahedral8 => f64::from(code) / 127.0,
        }
    }

    /// The next number in magnitude of halves, where zero stays, or in value of bytes.
    fn stepped(self, code: i32, by: i32) -> i32 {
        match self {
            Self::F16 if code & 0x7fff == 0 => code,
            Self::F16 => code + by,
            Self::Snorm8 | Self::Octahedral8 => (code + by).clamp(-127, 127),
        }
    }
}

/// A byte as a texture of unsigned bytes gives it.
fn unsigned(byte: u8) -> f64 {
    f64::from(byte) / 255.0
}
