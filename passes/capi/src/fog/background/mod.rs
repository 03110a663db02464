//! An environment as it is seen through fog, for hosts in C and C++.

#[cfg(any(test, feature = "conformance"))]
pub(crate) mod conformance;

use std::sync::{Arc, Mutex, PoisonError};

use airglow_fog::{Background, Distant, Seen};
use airglow_gpu::ash::vk;
use airglow_gpu::{Context, ImageView, Recorder};
use airglow_graph::Access;

use crate::access::{AirglowOrigin, Number, Resource, Step, Uses, What};
use crate::binding::Bound;
use crate::context::AirglowContext;
use crate::input::{Versioned, one_of, shared, take, versioned};
use crate::pass::{self, Frame, give, make, require};
use crate::prepared::AirglowPrepared;
use crate::requirements::AirglowRequirements;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// Convolves environments of one size with what a medium does to a point of light, for the eye. Any thread may use it.
pub struct AirglowFogBackground {
    context: Arc<Context>,
    background: Background,
}

/// What a background is made for.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowFogBackgroundSettings {
    /// `sizeof(AirglowFogBackgroundSettings)`.
    pub struct_size: u32,
    /// `VkFormat` of the picture that is written; 0 is `VK_FORMAT_R32G32B32A32_SFLOAT`.
    pub format: u32,
    /// Texels of a row of the environment.
    pub width: u32,
    /// Rows of the environment.
    pub height: u32,
}

// SAFETY: `#[repr(C)]`, its size first, integers of 4 bytes.
unsafe impl Versioned for AirglowFogBackgroundSettings {
    const OLDEST: usize = size_of::<Self>();
}

impl pass::Settings for AirglowFogBackgroundSettings {
    type Read = (vk::Format, [u32; 2]);

    fn read(&self) -> Result<Self::Read, Failure> {
        let default = airglow_fog::Settings::default().format;
        let format = if self.format == 0 { default } else { vk::Format::from_raw(self.format as i32) };
        Ok((format, [self.width, self.height]))
    }
}

/// What a picture of an environment holds.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowFogSeen {
    /// All that is seen: what arrives straight, and the glow.
    Whole = 0,
    /// The glow alone, smooth but for its peaks: for a host that has a smaller picture of it, and adds exp(-optical
    /// distance) of the environment itself.
    Glow = 1,
}

/// The medium before an environment, and what the picture holds.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowFogBackgroundView {
    /// `sizeof(AirglowFogBackgroundView)`.
    pub struct_size: u32,
    /// An `AirglowFogSeen`.
    pub seen: u32,
    /// Extinction times the metres to the environment, of red, green and blue.
    pub optical_distance: [f64; 3],
    /// What of the extinction is scattering, 0 to 1 each.
    pub albedo: [f64; 3],
}

// SAFETY: `#[repr(C)]`, its size first, numbers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowFogBackgroundView {
    const OLDEST: usize = size_of::<Self>();
}

impl AirglowFogBackgroundView {
    fn read(&self) -> Result<(Distant, Seen), Failure> {
        let seen = one_of("seen", self.seen, &[Seen::Whole, Seen::Glow])?;
        let distant = Distant { optical_distance: self.optical_distance, albedo: self.albedo };
        distant.check()?;
        Ok((distant, seen))
    }
}

/// What a background uses.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowFogBackgroundResource {
    /// The environment of the host's, equirectangular, linear radiance; its first mip.
    Environment = 0,
    /// The picture of the host's, equirectangular, of any size, in the format of the settings; all of it is written.
    Target = 1,
    /// Sums over parts of the environment.
    Parts = 2,
}

const ENVIRONMENT: Number = (AirglowFogBackgroundResource::Environment as u32, 0);
const TARGET: Number = (AirglowFogBackgroundResource::Target as u32, 0);
const PARTS: Number = (AirglowFogBackgroundResource::Parts as u32, 0);

/// Adds what a background asks of a device with these settings.
///
/// # Safety
/// `settings` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_background_require(
    requirements: *mut AirglowRequirements,
    settings: *const AirglowFogBackgroundSettings,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || require(requirements, settings, |(format, _)| Background::requirements(*format)))
    }
}

/// Makes a background: its kernels, and memory for 11 bytes a texel of the environment.
///
/// # Safety
/// `settings` points at as many bytes as it says; `background` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_background_new(
    context: *const AirglowContext,
    settings: *const AirglowFogBackgroundSettings,
    background: *mut *mut AirglowFogBackground,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            make(context, settings, (background, "background"), |context, (format, size)| {
                let background = Background::new(&context, size, format)?;
                Ok(AirglowFogBackground { context, background })
            })
        })
    }
}

/// Drops a background; what was prepared stays usable. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_background_drop(background: *mut AirglowFogBackground) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(background)) };
}

/// A picture to be made.
struct BackgroundFrame {
    background: Background,
    view: Mutex<(Distant, Seen)>,
}

impl Frame for BackgroundFrame {
    const PASS: &'static str = "fog background";
    /// The environment and the picture.
    type Bindings = [ImageView; 2];

    fn bind(&self, bound: &Bound<'_>) -> Result<Self::Bindings, Failure> {
        Ok([bound.image(ENVIRONMENT)?, bound.image(TARGET)?])
    }

    fn record(&self, recorder: &mut Recorder<'_>, bindings: &mut Self::Bindings) -> Result<(), Failure> {
        let ([environment, target], view) = (bindings, self.view.lock());
        let (distant, seen) = *view.unwrap_or_else(PoisonError::into_inner);
        Ok(self.background.record(recorder, environment, target, &distant, seen)?)
    }
}

fn uses(background: &Background) -> Uses {
    use AirglowOrigin::{Host, Library};
    let resource = |number, name: &str, what| Resource { number, name: name.to_owned(), what };
    let resources = vec![
        resource(ENVIRONMENT, "fog environment", What::Image(Host)),
        resource(TARGET, "fog background", What::Image(Host)),
        resource(PARTS, "fog background parts", What::Buffer(Library, background.bytes())),
    ];
    let step = |name, uses: &[_]| Step { name, uses: uses.to_vec() };
    Uses::new(
        resources,
        &[
            step(
                "fog background parts",
                &[(ENVIRONMENT, Access::ComputeSampled), (PARTS, Access::ComputeStorageWrite)],
            ),
            step(
                "fog background",
                &[
                    (ENVIRONMENT, Access::FragmentSampled),
                    (PARTS, Access::FragmentStorageRead),
                    (TARGET, Access::ColorAttachmentWrite),
                ],
            ),
        ],
    )
}

/// Prepares the picture of an environment in a medium. It is no work for every frame: record it when the environment or
/// the medium before it has changed.
///
/// # Safety
/// `view` points at as many bytes as it says; `prepared` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_background_prepare(
    background: *const AirglowFogBackground,
    view: *const AirglowFogBackgroundView,
    prepared: *mut *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(prepared, "prepared", || {
                let AirglowFogBackground { context, background } = shared(background, "background")?;
                let view = Mutex::new(versioned(view, "view")?.read()?);
                let frame = BackgroundFrame { background: background.clone(), view };
                Ok(AirglowPrepared::new(context, uses(background), frame))
            })
        })
    }
}

/// Sets the medium of a prepared picture, which counts from the next recording on. On an error the old one stays.
///
/// # Safety
/// `view` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_background_set(
    prepared: *const AirglowPrepared,
    view: *const AirglowFogBackgroundView,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &BackgroundFrame = shared(prepared, "prepared")?.of()?;
            let view = versioned(view, "view")?.read()?;
            *frame.view.lock().unwrap_or_else(PoisonError::into_inner) = view;
            Ok(())
        })
    }
}
