//! What every pass does the same way: asking for a device's properties, being made, being prepared and recorded.
#![allow(dead_code, unused_imports, unused_macros, reason = "helpers of passes, of which there may be none")]

use std::any::Any;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_gpu::{Context, Recorder, Requirements};

use crate::binding::{AirglowBinding, Bound, Kept};
use crate::context::AirglowContext;
use crate::input::{Versioned, exclusive, shared, store, versioned};
use crate::requirements::AirglowRequirements;
use crate::status::Failure;

/// What a pass is prepared for, as the header has it.
pub(crate) trait Settings: Versioned {
    /// The same as the pass has it.
    type Read;

    /// The settings, checked.
    fn read(&self) -> Result<Self::Read, Failure>;
}

/// Adds what a pass asks of a device with these settings.
///
/// # Safety
/// As [`exclusive`] and [`versioned`].
pub(crate) unsafe fn require<S: Settings>(
    requirements: *mut AirglowRequirements,
    settings: *const S,
    asked: impl FnOnce(&S::Read) -> Requirements,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise is ours.
    let (requirements, settings) =
        unsafe { (exclusive(requirements, "requirements")?, versioned(settings, "settings")?) };
    requirements.add(&asked(&settings.read()?));
    Ok(())
}

/// Hands a new object to the caller, who drops it.
///
/// # Safety
/// As [`store`].
pub(crate) unsafe fn give<T>(
    target: *mut *mut T,
    name: &str,
    make: impl FnOnce() -> Result<T, Failure>,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise is ours.
    unsafe { give_if(target, name, || make().map(Some)) }
}

/// The same, or null where there is nothing to hand over.
///
/// # Safety
/// As [`store`].
pub(crate) unsafe fn give_if<T>(
    target: *mut *mut T,
    name: &str,
    make: impl FnOnce() -> Result<Option<T>, Failure>,
) -> Result<(), Failure> {
    let boxed = || Ok(make()?.map_or(std::ptr::null_mut(), |made| Box::into_raw(Box::new(made))));
    // SAFETY: the caller's promise is ours.
    unsafe { store(target, name, boxed) }
}

/// Makes a pass, called `name`, for a context and settings.
///
/// # Safety
/// As [`shared`], [`versioned`] and [`store`].
pub(crate) unsafe fn make<S: Settings, T>(
    context: *const AirglowContext,
    settings: *const S,
    (target, name): (*mut *mut T, &str),
    pass: impl FnOnce(Arc<Context>, S::Read) -> Result<T, Failure>,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise is ours.
    unsafe {
        give(target, name, || {
            let context = Arc::clone(&shared(context, "context")?.context);
            pass(context, versioned(settings, "settings")?.read()?)
        })
    }
}

/// What a pass refuses is an argument's fault, unless the device refused.
macro_rules! refusals {
    ($error:ident) => {
        impl From<$error> for $crate::status::Failure {
            fn from(error: $error) -> Self {
                let message = error.to_string();
                match error {
                    $error::Gpu(error) => Self { message, ..Self::from(error) },
                    _ => Self::new($crate::status::AirglowStatus::InvalidArgument, message),
                }
            }
        }
    };
}
pub(crate) use refusals;

/// A frame of a pass, ready to be recorded.
pub(crate) trait Frame: Any {
    /// The pass.
    const PASS: &'static str;
    /// What it is recorded with.
    type Bindings;

    /// What is bound, as the pass takes it.
    fn bind(&self, bound: &Bound<'_>) -> Result<Self::Bindings, Failure>;

    /// Records the commands.
    fn record(&self, recorder: &mut Recorder<'_>, bindings: &mut Self::Bindings) -> Result<(), Failure>;

    /// Records the commands that count what is wrong, into counters of this pass.
    fn count(
        &self,
        _recorder: &mut Recorder<'_>,
        _counters: &mut dyn Any,
        _bindings: &mut Self::Bindings,
    ) -> Result<(), Failure> {
        let problem = format!("a frame of {} counts nothing after it was recorded", Self::PASS);
        Err(Failure::argument("prepared", &problem))
    }
}

/// A frame with what it was recorded with.
pub(crate) struct Recorded<F: Frame> {
    frame: F,
    kept: Mutex<Kept<F::Bindings>>,
}

impl<F: Frame> Recorded<F> {
    pub(crate) fn new(frame: F) -> Self {
        Self { frame, kept: Mutex::default() }
    }

    fn kept(&self) -> MutexGuard<'_, Kept<F::Bindings>> {
        // A poisoned lock means a panic that was reported as a defect; the data is whole.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A [`Recorded`] of whichever pass.
pub(crate) trait AnyFrame {
    /// The pass.
    fn pass(&self) -> &'static str;

    /// The [`Frame`].
    fn frame(&self) -> &dyn Any;

    /// Records with `given`, imported by `import` unless it was before.
    fn record<'a>(
        &self,
        recorder: &mut Recorder<'_>,
        given: &[AirglowBinding],
        import: &dyn Fn() -> Result<Bound<'a>, Failure>,
    ) -> Result<(), Failure>;

    /// Counts with `given`, imported by `import` unless it was before.
    fn count<'a>(
        &self,
        recorder: &mut Recorder<'_>,
        counters: &mut dyn Any,
        given: &[AirglowBinding],
        import: &dyn Fn() -> Result<Bound<'a>, Failure>,
    ) -> Result<(), Failure>;

    /// Forgets what it was recorded with.
    fn forget(&self);
}

impl<F: Frame> AnyFrame for Recorded<F> {
    fn pass(&self) -> &'static str {
        F::PASS
    }

    fn frame(&self) -> &dyn Any {
        &self.frame
    }

    fn record<'a>(
        &self,
        recorder: &mut Recorder<'_>,
        given: &[AirglowBinding],
        import: &dyn Fn() -> Result<Bound<'a>, Failure>,
    ) -> Result<(), Failure> {
        let mut kept = self.kept();
        let bindings = kept.set(given, || self.frame.bind(&import()?))?;
        self.frame.record(recorder, bindings)
    }

    fn count<'a>(
        &self,
        recorder: &mut Recorder<'_>,
        counters: &mut dyn Any,
        given: &[AirglowBinding],
        import: &dyn Fn() -> Result<Bound<'a>, Failure>,
    ) -> Result<(), Failure> {
        let mut kept = self.kept();
        let bindings = kept.set(given, || self.frame.bind(&import()?))?;
        self.frame.count(recorder, counters, bindings)
    }

    fn forget(&self) {
        self.kept().forget();
    }
}
