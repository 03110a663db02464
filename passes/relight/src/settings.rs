//! The knobs of relighting: range, default and its reason.

use crate::RelightError;
use crate::order::MAX_ORDER;

/// How the vectors of a mesh are stored on the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Storage {
    /// 32-bit floats; error of a colour below 1e-5 of |t||l|.
    #[default]
    F32,
    /// 16-bit floats, half the bytes; error of a colour below 1e-3 of |t||l|.
    F16,
}

/// What is written for each vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Output {
    /// The colour t_p . l, or <t_p, l, v> with a dynamic visibility: `[f32; 4]`, W/sr/m2 of a white diffuse
    /// surface, the fourth value 1.
    #[default]
    Colour,
    /// The incident radiance with shadow in it, SH RGB: `[[f32; 3]; order^2]`, for shaders that need direction.
    Incident,
}

/// How the vertex array is rendered to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// A compute pass writes the vertex buffer.
    #[default]
    Compute,
    /// A fragment pass over a packed rectangle, copied into the vertex buffer. Colours only; the same bits.
    Fragment,
}

/// What kind of light arrives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightKind {
    /// One SH RGB vector for a mesh, rotated into the frame of each instance.
    #[default]
    Uniform,
    /// One SH RGB vector for each vertex, already in the frame of the instance.
    Vertex,
}

/// What a [`Relight`](crate::Relight) is prepared for. Everything here decides which kernels exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Settings {
    /// Bands of every vector, 1 to [`MAX_ORDER`]; order^2 coefficients. Default 4: the light of a diffuse
    /// surface is nearly all in three bands (Sun 2008, eq. 2.25), shadows want one more.
    pub order: usize,
    /// Storage of the baked vectors. Default f32; f16 halves bytes and time where bandwidth is the limit.
    pub storage: Storage,
    /// What is written. Default colour.
    pub output: Output,
    /// How it is written. Default compute: no copy and no image.
    pub method: Method,
    /// Kind of light. Default uniform.
    pub light: LightKind,
    /// Whether instances may bring a dynamic visibility vector for each vertex. Default no: then neither the
    /// product matrix nor its kernels exist.
    pub visibility: bool,
    /// Whether instances of meshes without vectors may bring the normals of their vertices, for colours. Default no:
    /// then their kernels do not exist.
    pub normals: bool,
    /// Whether the texels of environments that are not finite, and those that are negative, are counted. Default no: then
    /// neither the counters nor the kernel that adds to them exist. The colours are the same bits.
    pub health: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            order: 4,
            storage: Storage::default(),
            output: Output::default(),
            method: Method::default(),
            light: LightKind::default(),
            visibility: false,
            normals: false,
            health: false,
        }
    }
}

impl Settings {
    /// Coefficients of a vector: order^2.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        self.order * self.order
    }

    /// Bytes written for each vertex: 16 for a colour, 12 order^2 for incident radiance.
    #[must_use]
    pub fn output_bytes(&self) -> u64 {
        match self.output {
            Output::Colour => 16,
            Output::Incident => 12 * self.coefficients() as u64,
        }
    }

    /// Whether light meets visibility, in some kernel that the settings can need.
    pub(crate) fn shadows(&self) -> bool {
        self.visibility || self.output == Output::Incident
    }

    /// Refuses what has no kernel.
    ///
    /// # Errors
    /// [`RelightError::Order`], [`RelightError::Settings`].
    pub fn check(&self) -> Result<(), RelightError> {
        if !(1..=MAX_ORDER).contains(&self.order) {
            return Err(RelightError::Order { order: self.order });
        }
        if self.method == Method::Fragment && self.output == Output::Incident {
            return Err(RelightError::Settings {
                what: "a pixel cannot hold the incident radiance of a vertex",
                mend: "choose Method::Compute for Output::Incident",
            });
        }
        if self.normals && self.output == Output::Incident {
            return Err(RelightError::Settings {
                what: "the radiance that meets a vertex does not depend on its normal",
                mend: "leave Settings::normals off for Output::Incident",
            });
        }
        Ok(())
    }
}
