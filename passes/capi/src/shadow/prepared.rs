//! The visibility of one instance's vertices as a frame, and the spheres that block it.

use std::any::Any;

use airglow_gpu::{Record, Recorder};
use airglow_graph::{Access, BufferDesc, Graph, State};
use airglow_shadow::{ACCESSES, Bindings, Blockers, Counts, HEALTH, Receivers, Shadow, Sphere};
use glam::{DMat4, DVec3};

use super::{AirglowShadow, AirglowShadowReceivers};
use crate::access::{AirglowOrigin, Number, Resource, Step, Uses, What};
use crate::binding::Bound;
use crate::health::{AirglowHealth, look};
use crate::input::{array, shared, store};
use crate::pass::{Frame, give};
use crate::plan::write_plan;
use crate::prepared::AirglowPrepared;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::AirglowText;

/// What the pass uses; all are buffers of the host's.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowShadowResource {
    /// Positions of the vertices in object space, three floats each, tightly packed.
    Positions = 0,
    /// Their normals, three floats each, of any length but 0; with `normals` in the settings.
    Normals = 1,
    /// Written: `order^2` floats a vertex, as relighting takes dynamic visibility
    /// (`AIRGLOW_RELIGHT_RESOURCE_VISIBILITY`).
    Visibility = 2,
    /// Written: two integers a cluster, for `airglow_shadow_counts`.
    Records = 3,
}

/// A blocker. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowSphere {
    /// Its centre, in the host's world.
    pub center: [f64; 3],
    /// Its radius; a sphere of radius 0 blocks nothing.
    pub radius: f64,
}

/// What the pass did in a frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowShadowCounts {
    /// Clusters of up to 64 vertices.
    pub clusters: u64,
    /// Clusters out of reach of every sphere.
    pub open: u64,
    /// Spheres, summed over clusters.
    pub spheres: u64,
    /// Vertices whose result was none that a visibility can have.
    pub clamped: u64,
}

/// The visibility of an instance.
pub(super) struct ShadowFrame {
    shadow: Shadow,
    receivers: Receivers,
    blockers: Blockers,
}

/// The number of a resource, by its place in [`ACCESSES`].
fn number(place: usize) -> Number {
    (place as u32, 0)
}

impl Frame for ShadowFrame {
    const PASS: &'static str = "shadow";
    type Bindings = Bindings;

    fn bind(&self, bound: &Bound<'_>) -> Result<Bindings, Failure> {
        let buffer = |resource: AirglowShadowResource| bound.buffer((resource as u32, 0));
        let normals = self.shadow.settings().normals.then(|| buffer(AirglowShadowResource::Normals));
        Ok(Bindings {
            positions: buffer(AirglowShadowResource::Positions)?,
            normals: normals.transpose()?,
            visibility: buffer(AirglowShadowResource::Visibility)?,
            records: buffer(AirglowShadowResource::Records)?,
        })
    }

    fn record(&self, recorder: &mut Recorder<'_>, bindings: &mut Bindings) -> Result<(), Failure> {
        Ok(self.shadow.record(recorder, &self.receivers, &self.blockers, bindings)?)
    }

    fn count(
        &self,
        recorder: &mut Recorder<'_>,
        counters: &mut dyn Any,
        bindings: &mut Bindings,
    ) -> Result<(), Failure> {
        let Bindings { positions, normals, visibility, records } = &*bindings;
        let looks = self.receivers.looks(
            self.shadow.settings().order,
            positions.clone(),
            normals.clone(),
            visibility.clone(),
            records.clone(),
        );
        look(recorder, counters, &looks)
    }
}

impl ShadowFrame {
    /// Writes whether a sphere has a radius, where the caller asks.
    ///
    /// # Safety
    /// `blocks` is null or may be written.
    pub(super) unsafe fn say_blocks(&self, blocks: *mut u32) -> Result<(), Failure> {
        if blocks.is_null() {
            return Ok(());
        }
        // SAFETY: the caller's promise is ours.
        unsafe { store(blocks, "blocks", || Ok(u32::from(!self.blockers.is_empty()))) }
    }

    pub(super) fn blockers(&self) -> &Blockers {
        &self.blockers
    }

    /// Bytes of each resource, in the order of [`ACCESSES`]; none of what it does not use.
    fn bytes(&self) -> [Option<u64>; ACCESSES.len()] {
        let (settings, vectors) = (self.shadow.settings(), 12 * u64::from(self.receivers.count()));
        let visibility = self.receivers.visibility_bytes(settings.order);
        let normals = settings.normals.then_some(vectors);
        [Some(vectors), normals, Some(visibility), Some(self.receivers.record_bytes())]
    }

    fn uses(&self) -> Uses {
        let (mut resources, mut uses) = (Vec::new(), Vec::new());
        for (place, ((name, access), bytes)) in ACCESSES.into_iter().zip(self.bytes()).enumerate() {
            let Some(bytes) = bytes else { continue };
            let what = What::Buffer(AirglowOrigin::Host, bytes);
            resources.push(Resource { number: number(place), name: format!("shadow {name}"), what });
            uses.push((number(place), access));
        }
        Uses::new(resources, &[Step { name: "shadow visibility", uses }])
    }

    /// What our graph makes of it.
    fn graph(&self) -> Graph<Record> {
        let mut graph = Graph::new();
        let [positions, normals, ..] = self.bytes();
        let mut import = |name, bytes| {
            let access = Access::ComputeStorageRead;
            let desc = BufferDesc { size: bytes, usage: access.buffer_usage() };
            graph.import_buffer(name, desc, access, access)
        };
        let positions = import("positions of the host", positions.unwrap_or(1));
        let normals = normals.map(|bytes| import("normals of the host", bytes));
        let shadowed = self.shadow.add(&mut graph, &self.receivers, &self.blockers, positions, normals);
        let read = State::of(Access::ComputeStorageRead);
        for made in [shadowed.visibility, shadowed.records].into_iter().flatten() {
            graph.export(made, read);
        }
        graph
    }
}

/// Prepares the visibility of the vertices of one instance; before spheres are set (`airglow_shadow_set`) nothing blocks.
///
/// # Safety
/// `prepared` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_prepare(
    shadow: *const AirglowShadow,
    receivers: *const AirglowShadowReceivers,
    prepared: *mut *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(prepared, "prepared", || {
                let AirglowShadow { context, shadow } = shared(shadow, "shadow")?;
                let receivers = shared(receivers, "receivers")?.receivers.clone();
                let (shadow, blockers) = (shadow.clone(), Blockers::default());
                let frame = ShadowFrame { shadow, receivers, blockers };
                Ok(AirglowPrepared::new(context, frame.uses(), frame))
            })
        })
    }
}

/// Sets the spheres of a prepared frame, which count from the next recording on. `receiver_from_world`, column-major, takes
/// them to the object space of the vertices: a rotation or mirroring, a uniform scale, a translation; null is the identity.
/// `*blocks`, which may be null, gets 1 if one has a radius, else 0: then the recording may be left out together with the
/// visibility of the instance (`airglow_relight_show`). On an error the old ones stay.
///
/// # Safety
/// `spheres` has `sphere_count` elements; `receiver_from_world` is null or has 16 values; `blocks` is null or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_set(
    prepared: *const AirglowPrepared,
    spheres: *const AirglowSphere,
    sphere_count: usize,
    receiver_from_world: *const f64,
    blocks: *mut u32,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &ShadowFrame = shared(prepared, "prepared")?.of()?;
            let spheres = read(array(spheres, sphere_count, "spheres")?)?;
            frame.blockers.set(&spheres, matrix(receiver_from_world)?)?;
            frame.say_blocks(blocks)
        })
    }
}

/// The spheres of the caller; more than a frame takes are refused before they are copied.
pub(super) fn read(given: &[AirglowSphere]) -> Result<Vec<Sphere>, Failure> {
    if given.len() > airglow_shadow::MAX_SPHERES {
        let problem = format!("{} are more than {}", given.len(), airglow_shadow::MAX_SPHERES);
        return Err(Failure::argument("spheres", &problem));
    }
    let sphere =
        |given: &AirglowSphere| Sphere { center: DVec3::from_array(given.center), radius: given.radius };
    Ok(given.iter().map(sphere).collect())
}

/// A column-major matrix of the caller; null is the identity.
///
/// # Safety
/// `given` is null or has 16 values.
pub(super) unsafe fn matrix(given: *const f64) -> Result<DMat4, Failure> {
    if given.is_null() {
        return Ok(DMat4::IDENTITY);
    }
    // SAFETY: the caller's promise is ours.
    Ok(DMat4::from_cols_array(unsafe { shared(given.cast(), "receiver_from_world")? }))
}

/// Makes counters for `airglow_prepared_count`, of frames of this pass: receivers whose position, and those whose normal, is
/// not finite; receivers whose visibility is not; those whose result was none that a visibility can have and was clamped.
///
/// # Safety
/// `health` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_health_new(
    shadow: *const AirglowShadow,
    health: *mut *mut AirglowHealth,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(health, "health", || {
                AirglowHealth::tallied(&shared(shadow, "shadow")?.context, ShadowFrame::PASS, &HEALTH)
            })
        })
    }
}

/// Sums the records of a frame as the host read them back.
///
/// # Safety
/// `records` has two values for each of `cluster_count` clusters; `counts` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_counts(
    records: *const u32,
    cluster_count: usize,
    counts: *mut AirglowShadowCounts,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(counts, "counts", || {
                let Counts { clusters, open, spheres, clamped } =
                    Counts::of(array(records.cast(), cluster_count, "records")?);
                Ok(AirglowShadowCounts { clusters, open, spheres, clamped })
            })
        })
    }
}

/// Writes the plan that the library's graph makes of a prepared frame, with the spheres that are set now. The format is an
/// `AirglowPlanFormat`.
///
/// # Safety
/// `text` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_plan(
    prepared: *const AirglowPrepared,
    format: u32,
    text: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let prepared = shared(prepared, "prepared")?;
            write_plan(prepared.context(), prepared.of::<ShadowFrame>()?.graph(), format, text)
        })
    }
}
