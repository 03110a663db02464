//! Maps of the sphere: equirectangular and cube, with exact solid angles and exactly integrated bases.

pub mod cube;
pub mod equirect;

pub use equirect::{EquirectBasis, Projector};
