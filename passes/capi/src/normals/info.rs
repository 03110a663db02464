//! A normal map as a host says it.

use std::ffi::{c_char, c_void};

use airglow_math::World;
use airglow_math::world::NormalMapGreen;
use airglow_normals::NormalMap;

use crate::input::{Versioned, array, one_of};
use crate::status::Failure;

/// What a texel of a normal map holds.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowNormalFormat {
    /// Three floats: a vector of any length.
    Float3 = 0,
    /// Two floats, as BC5 has them: z is what is left of 1.
    Float2 = 1,
    /// Four bytes: 0 is -1, 255 is 1; the fourth is not read.
    Rgba8 = 2,
    /// Four numbers of 16 bits: 0 is -1, 65535 is 1; the fourth is not read.
    Rgba16 = 3,
}

/// A normal map in tangent space, z away from the surface.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowNormalMapInfo {
    /// `sizeof(AirglowNormalMapInfo)`.
    pub struct_size: u32,
    /// An `AirglowNormalFormat`.
    pub format: u32,
    /// Texels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Its texels, row by row, tightly packed. A texel without direction becomes +Z and is counted.
    pub texels: *const c_void,
    /// Bytes of them.
    pub texel_bytes: usize,
    /// Path of a file that `airglow_normal_map_store` wrote, UTF-8: if it holds the texture of this very map with these
    /// settings, that is copied in one step; whatever else is there is left alone. Null for none.
    pub cache: *const c_char,
    /// 1: green points down; 0: up.
    pub green_down: u32,
    /// Not used; 0.
    pub reserved: u32,
}

// SAFETY: `#[repr(C)]`, its size first, integers and pointers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowNormalMapInfo {
    const OLDEST: usize = std::mem::offset_of!(Self, green_down);
}

impl AirglowNormalMapInfo {
    /// # Safety
    /// `texels` has as many bytes as it says.
    pub(super) unsafe fn read(&self) -> Result<NormalMap, Failure> {
        const FLOAT2: u32 = AirglowNormalFormat::Float2 as u32;
        const RGBA8: u32 = AirglowNormalFormat::Rgba8 as u32;
        const RGBA16: u32 = AirglowNormalFormat::Rgba16 as u32;
        let (width, height) = (self.width as usize, self.height as usize);
        // SAFETY: the caller's promise is ours.
        let map = unsafe {
            match self.format {
                0 => NormalMap::from_vectors(width, height, self.texels()?),
                FLOAT2 => NormalMap::from_two_channels(width, height, self.texels()?),
                RGBA8 => {
                    let texels = self.texels::<[u8; 4]>()?;
                    let wide: Vec<_> =
                        texels.iter().map(|[x, y, z, _]| [*x, *y, *z].map(u16::from)).collect();
                    NormalMap::from_unsigned(width, height, &wide, 255)
                }
                RGBA16 => {
                    let texels = self.texels::<[u16; 4]>()?;
                    let narrow: Vec<_> = texels.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
                    NormalMap::from_unsigned(width, height, &narrow, u16::MAX)
                }
                _ => return Err(Failure::argument("info.format", "give an AirglowNormalFormat")),
            }
        };
        let normal_map_green =
            one_of("info.green_down", self.green_down, &[NormalMapGreen::Up, NormalMapGreen::Down])?;
        Ok(map?.of_host(&World { normal_map_green, ..World::default() }))
    }

    /// The texels, whose bytes must be those of width and height.
    ///
    /// # Safety
    /// As [`Self::read`].
    unsafe fn texels<'a, T>(&self) -> Result<&'a [T], Failure> {
        let count = u64::from(self.width) * u64::from(self.height);
        let bytes = count.checked_mul(size_of::<T>() as u64);
        match usize::try_from(count) {
            // SAFETY: the caller's promise is ours.
            Ok(count) if count > 0 && bytes == Some(self.texel_bytes as u64) => unsafe {
                array(self.texels.cast(), count, "info.texels")
            },
            _ => {
                let (width, height, size) = (self.width, self.height, size_of::<T>());
                let problem = format!("give {width} x {height} texels of {size} bytes, one at least");
                Err(Failure::argument("info.texel_bytes", &problem))
            }
        }
    }
}
