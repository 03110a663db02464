//! Views as data, changed from frame to frame.

use std::any::Any;
use std::sync::{Mutex, PoisonError};

use airglow_fog::{ACCESSES, Bindings, Counts, InputHealth, Light, Pass, PhaseKind, Prepared};
use airglow_gpu::{Health, Recorder};
use airglow_graph::Access;

use super::AirglowFog;
use super::view::AirglowFogView;
use crate::access::{AirglowOrigin, Resource, Step, Uses, What};
use crate::binding::Bound;
use crate::health::{AirglowHealth, Counters};
use crate::input::{array, shared, store, versioned};
use crate::pass::{Frame, give, give_if};
use crate::prepared::AirglowPrepared;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// What the pass uses; all are images of the host's, the index is the view.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowFogResource {
    /// Scene-linear radiance of the surfaces without the medium, any float format.
    Surface = 0,
    /// Their depth, by the host's `AirglowWorld`; the farthest value shows no surface.
    Depth = 1,
    /// The picture through the medium, in the format of the settings; all of it is written.
    Target = 2,
}

/// Lights of a view, and pairs of a tile of the picture and a light.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowFogCounts {
    /// Lights whose airlight passes the bound somewhere in the picture.
    pub evaluated: u32,
    /// Lights left out: dark, too weak, or out of reach of every pixel.
    pub left_out: u32,
    /// Pairs of a tile, `AIRGLOW_FOG_TILE` pixels on a side, and a light that is evaluated in it.
    pub pairs: u32,
    /// Pairs left out: with those evaluated, as many as there are tiles times lights.
    pub pairs_left_out: u32,
}

/// Pixels along a side of a tile.
pub const AIRGLOW_FOG_TILE: u32 = 64;

const _: () = assert!(AIRGLOW_FOG_TILE == airglow_fog::TILE);

/// Views of the pass, of one size.
pub(super) struct FogFrame {
    views: Vec<ViewFrame>,
    phase: PhaseKind,
    size: [u32; 2],
}

/// A view that the pass has something to do in.
struct ViewFrame {
    /// Its place among all.
    index: u32,
    pass: Pass,
    /// Memory for the lights of the next frame.
    lights: Mutex<Vec<Light>>,
}

impl Frame for FogFrame {
    const PASS: &'static str = "fog";
    type Bindings = Vec<Bindings>;

    fn bind(&self, bound: &Bound<'_>) -> Result<Vec<Bindings>, Failure> {
        let bind = |view: &ViewFrame| {
            let image = |resource: AirglowFogResource| bound.image((resource as u32, view.index));
            Ok(Bindings {
                surface: image(AirglowFogResource::Surface)?,
                depth: image(AirglowFogResource::Depth)?,
                target: image(AirglowFogResource::Target)?,
            })
        };
        self.views.iter().map(bind).collect()
    }

    fn record(&self, recorder: &mut Recorder<'_>, bindings: &mut Vec<Bindings>) -> Result<(), Failure> {
        let mut views = self.views.iter().zip(bindings);
        views.try_for_each(|(view, bindings)| Ok(view.pass.record(recorder, bindings)?))
    }

    fn count(
        &self,
        recorder: &mut Recorder<'_>,
        counters: &mut dyn Any,
        bindings: &mut Vec<Bindings>,
    ) -> Result<(), Failure> {
        let Some(Inputs(health)) = counters.downcast_ref() else { return Ok(()) };
        // What the host made visible to fragment shaders.
        recorder.memory_barrier(Access::FragmentSampled, Access::ComputeSampled)?;
        for Bindings { surface, depth, .. } in bindings {
            let counts = Access::ComputeStorageReadWrite;
            recorder.memory_barrier(counts, counts)?;
            health.record(recorder, self.size, surface, depth)?;
        }
        Ok(())
    }
}

/// Counters of the host's images.
struct Inputs(InputHealth);

impl Counters for Inputs {
    fn health(&mut self) -> &mut Health {
        self.0.counters()
    }

    fn any(&mut self) -> &mut dyn Any {
        self
    }
}

/// Makes counters for `airglow_prepared_count`, of frames of this pass: pixels whose surface has a component that is not
/// finite; others with a negative one; pixels whose depth is not between 0 and 1.
///
/// # Safety
/// `health` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_health_new(
    fog: *const AirglowFog,
    health: *mut *mut AirglowHealth,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(health, "health", || {
                let AirglowFog { context, .. } = shared(fog, "fog")?;
                Ok(AirglowHealth::new(context, FogFrame::PASS, Inputs(InputHealth::new(context)?)))
            })
        })
    }
}

/// Three images of the host's for each view, in one step.
fn uses(views: &[ViewFrame]) -> Uses {
    let (mut resources, mut uses) = (Vec::new(), Vec::new());
    for ViewFrame { index, .. } in views {
        for (number, (name, access)) in (0..).zip(ACCESSES) {
            let (number, what) = ((number, *index), What::Image(AirglowOrigin::Host));
            let name =
                if *index == 0 { format!("fog {name}") } else { format!("fog {name} of view {index}") };
            resources.push(Resource { number, name, what });
            uses.push((number, access));
        }
    }
    Uses::new(resources, &[Step { name: "fog airlight", uses }])
}

/// Prepares a view of `width * height` pixels. `*prepared` gets null where the medium is clear: then there is nothing to
/// record, and the surface is the picture.
///
/// # Safety
/// `view` points at as many bytes as it says, and so does its world; its lights are as many as it says; `prepared` may be
/// written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_prepare(
    fog: *const AirglowFog,
    width: u32,
    height: u32,
    view: *const AirglowFogView,
    prepared: *mut *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give_if(prepared, "prepared", || {
                prepare(shared(fog, "fog")?, [width, height], &[versioned(view, "view")?])
            })
        })
    }
}

/// Prepares views of `width * height` pixels each as one frame: pipelines and the barriers around it are those of one.
/// Resources have the place of their view as index. `*prepared` gets null where every medium is clear; a view whose own is
/// clear lists nothing.
///
/// # Safety
/// `views` points at `view_count` pointers to views, each as with `airglow_fog_prepare`; `prepared` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_prepare_views(
    fog: *const AirglowFog,
    width: u32,
    height: u32,
    views: *const *const AirglowFogView,
    view_count: usize,
    prepared: *mut *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give_if(prepared, "prepared", || {
                let given = array(views, view_count, "views")?;
                if given.is_empty() || given.len() > MOST_VIEWS {
                    let problem = format!("{view_count} were given: give 1 to {MOST_VIEWS}");
                    return Err(Failure::argument("views", &problem));
                }
                let views = given.iter().map(|view| versioned(*view, "views"));
                prepare(shared(fog, "fog")?, [width, height], &views.collect::<Result<Vec<_>, _>>()?)
            })
        })
    }
}

/// Most views of a frame.
const MOST_VIEWS: usize = 64;

/// # Safety
/// As [`AirglowFogView::read`].
unsafe fn prepare(
    AirglowFog { context, fog }: &AirglowFog,
    size: [u32; 2],
    given: &[AirglowFogView],
) -> Result<Option<AirglowPrepared>, Failure> {
    let (phase, mut views) = (fog.settings().phase, Vec::new());
    for (index, view) in (0..).zip(given) {
        // SAFETY: the caller's promise is ours.
        let view = unsafe { view.read(phase, Vec::new())? };
        let frame = airglow_fog::Frame { size, surface: (), depth: (), target: Some(()), view };
        if let Prepared::Pass(pass) = fog.prepare(&frame)? {
            views.push(ViewFrame { index, pass, lights: Mutex::new(frame.view.lights) });
        }
    }
    let some = !views.is_empty();
    Ok(some.then(|| AirglowPrepared::new(context, uses(&views), FogFrame { views, phase, size })))
}

/// Sets camera, medium and lights of a prepared view, which count from the next recording on; lamps that come and go
/// allocate nothing once there were as many. A clear medium is refused: leave the pass out, or prepare anew. On an error
/// the view stays. `counts` may be null.
///
/// # Safety
/// As `airglow_fog_prepare`; `counts` is null or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_set(
    prepared: *const AirglowPrepared,
    view: *const AirglowFogView,
    counts: *mut AirglowFogCounts,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &FogFrame = shared(prepared, "prepared")?.of()?;
            frame.set(0, &versioned(view, "view")?, counts)
        })
    }
}

/// Sets one view of several as `airglow_fog_set` sets the first, by its place among those that were prepared.
///
/// # Safety
/// As `airglow_fog_set`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_set_view(
    prepared: *const AirglowPrepared,
    index: u32,
    view: *const AirglowFogView,
    counts: *mut AirglowFogCounts,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &FogFrame = shared(prepared, "prepared")?.of()?;
            frame.set(index, &versioned(view, "view")?, counts)
        })
    }
}

impl FogFrame {
    /// # Safety
    /// As `airglow_fog_set`.
    unsafe fn set(
        &self,
        index: u32,
        view: &AirglowFogView,
        counts: *mut AirglowFogCounts,
    ) -> Result<(), Failure> {
        let Some(own) = self.views.iter().find(|own| own.index == index) else {
            let problem = "there is no such view, or its medium was clear when it was prepared";
            return Err(Failure::argument("index", problem));
        };
        let mut lights = own.lights.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the caller's promise is ours.
        let view = unsafe { view.read(self.phase, std::mem::take(&mut *lights))? };
        let set = own.pass.control.set(&view);
        *lights = view.lights;
        let Counts { evaluated, left_out, pairs, pairs_left_out } = set?;
        if counts.is_null() {
            return Ok(());
        }
        let row = AirglowFogCounts { evaluated, left_out, pairs, pairs_left_out };
        // SAFETY: the caller's promise is ours.
        unsafe { store(counts, "counts", || Ok(row)) }
    }
}
