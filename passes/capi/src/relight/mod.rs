//! Relighting by precomputed radiance transfer, for hosts in C and C++: meshes and an environment in; per frame the
//! uses of resources as data, then commands in the host's own command buffer.

#[cfg(any(test, feature = "conformance"))]
mod checked;
#[cfg(any(test, feature = "conformance"))]
pub(crate) mod conformance;
pub mod frame;
pub mod health;
#[cfg(all(any(test, feature = "conformance"), feature = "radiance", feature = "shadow"))]
mod joined;
pub mod plan;
pub mod prepared;
pub mod resources;
pub mod settings;
mod sky;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::ffi::c_char;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_gpu::{Context, GpuError};
use airglow_relight::{MeshId, Relight, RelightError};

use crate::context::AirglowContext;
use crate::input::{array, shared, store, string, take, versioned};
use crate::pass::{make, refusals, require};
use crate::requirements::AirglowRequirements;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::world::AirglowWorld;
use settings::AirglowRelightSettings;
use sky::Sky;

/// The relight pass: kernels, tables and meshes for one context and one choice of settings. Any thread may use it.
pub struct AirglowRelight {
    context: Arc<Context>,
    state: Mutex<State>,
}

/// What changes.
struct State {
    relight: Relight,
    meshes: BTreeMap<u64, MeshId>,
    /// The number of the next mesh.
    next: u64,
    sky: Option<Arc<Sky>>,
}

impl AirglowRelight {
    fn state(&self) -> MutexGuard<'_, State> {
        // A poisoned lock means a panic that was reported as a defect; the data is whole.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn mesh(&self, mesh: u64) -> Result<MeshId, Failure> {
        let problem = "it is not here: use the number that airglow_relight_add_mesh gave";
        self.meshes.get(&mesh).copied().ok_or_else(|| Failure::argument("mesh", problem))
    }
}

refusals!(RelightError);

/// Adds what the pass asks of a device with these settings.
///
/// # Safety
/// `settings` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_require(
    requirements: *mut AirglowRequirements,
    settings: *const AirglowRelightSettings,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || require(requirements, settings, Relight::requirements)) }
}

/// Makes the pass: its kernels and tables.
///
/// # Safety
/// `settings` points at as many bytes as it says; `relight` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_new(
    context: *const AirglowContext,
    settings: *const AirglowRelightSettings,
    relight: *mut *mut AirglowRelight,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            make(context, settings, (relight, "relight"), |context, settings| {
                let relight = Relight::new(&context, settings)?;
                let state = State { relight, meshes: BTreeMap::new(), next: 1, sky: None };
                Ok(AirglowRelight { context, state: Mutex::new(state) })
            })
        })
    }
}

/// States the host's world: in its axes rotations of light and instances, and light as SH RGB, come in with frames
/// prepared from now on, and results are multiplied with its pre-exposure. Before, it is airglow's own. Object space, and
/// so the bake, is in any axes. On an error the world stays.
///
/// # Safety
/// `world` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_set_world(
    relight: *const AirglowRelight,
    world: *const AirglowWorld,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let world = versioned(world, "world")?.read()?;
            Ok(shared(relight, "relight")?.state().relight.set_world(world)?)
        })
    }
}

/// Drops the pass; frames that were prepared stay usable. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_drop(relight: *mut AirglowRelight) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(relight)) };
}

/// Adds a mesh of `vertex_count` vertices, in the host's order. `vectors` are vertex-major, `order^2` values a vertex:
/// transfer vectors (`airglow_bake`) for colours, static visibility vectors for incident radiance; null for a mesh that
/// nothing static shadows, whose instances bring their normals. `*mesh` gets its number, never 0. They are copied, and
/// go to the device with the next frame that uses the mesh.
///
/// # Safety
/// `vectors` is null or has `vector_count` values; `name` is null or ends in a nul; `mesh` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_add_mesh(
    relight: *const AirglowRelight,
    name: *const c_char,
    vertex_count: u32,
    vectors: *const f32,
    vector_count: usize,
    mesh: *mut u64,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(mesh, "mesh", || {
                let relight = shared(relight, "relight")?;
                let name = string(name, "name", "mesh")?;
                let vectors = match vectors.is_null() && vector_count == 0 {
                    true => None,
                    false => Some(array(vectors, vector_count, "vectors")?),
                };
                let state = &mut *relight.state();
                let id = state.relight.add_mesh(&relight.context, name, vertex_count, vectors)?;
                let number = state.next;
                state.next += 1;
                state.meshes.insert(number, id);
                Ok(number)
            })
        })
    }
}

/// Drops a mesh; its memory goes back when no frame in flight, and no prepared frame, can use it.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_drop_mesh(
    relight: *const AirglowRelight,
    mesh: u64,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let mut state = shared(relight, "relight")?.state();
            let id = state.mesh(mesh)?;
            state.relight.drop_mesh(id)?;
            state.meshes.remove(&mesh);
            Ok(())
        })
    }
}

/// Gives the environment of frames whose light is `AIRGLOW_LIGHT_ENVIRONMENT`: `width * height` texels of three floats,
/// equirectangular, linear Rec. 709 radiance in W/sr/m2, the first row up, the centre looking down -Z and u growing to
/// +X. They are checked, copied, and uploaded by the next frame that is recorded with them. Frames prepared before keep
/// the environment they were prepared with.
///
/// # Safety
/// `texels` has `3 * width * height` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_set_environment(
    relight: *const AirglowRelight,
    width: u32,
    height: u32,
    texels: *const f32,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let relight = shared(relight, "relight")?;
            let most = relight.context.limits().max_image_dimension2_d;
            if !(1..=most).contains(&width) || !(1..=most).contains(&height) {
                let problem = format!("{width} x {height} texels: each side is 1 to {most}");
                return Err(Failure::argument("environment", &problem));
            }
            let count = u64::from(width) * u64::from(height);
            let count = usize::try_from(count).map_err(|_| Failure::argument("texels", "too many"))?;
            let texels = array(texels.cast::<[f32; 3]>(), count, "texels")?;
            let mut state = relight.state();
            let revision = state.sky.as_ref().map_or(0, |sky| sky.revision) + 1;
            state.sky = Some(Arc::new(Sky::new(&relight.context, width, height, texels, revision)?));
            Ok(())
        })
    }
}

/// A refusal of what the recorder would refuse, too.
fn misuse(what: impl Into<String>, problem: impl Into<String>) -> Failure {
    GpuError::misuse(what, problem).into()
}
