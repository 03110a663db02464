//! A map on its way to a texture of lobes.

use std::ffi::c_char;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{Context, Imports, Readback, Record, Recorder};
use airglow_graph::{Access, Graph};
use airglow_normals::cache::{self, PackedChain};
use airglow_normals::{Build, HEALTH, LobeTexture, NormalMap, Settings};

use super::info::AirglowNormalMapInfo;
use super::{AirglowNormals, PASS};
use crate::health::AirglowHealth;
use crate::input::{shared, store, string, take, versioned};
use crate::pass::give;
use crate::plan::write_plan;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::AirglowText;

/// A normal map and its texture of lobes. Any thread may use it.
pub struct AirglowNormalMap {
    pub(super) context: Arc<Context>,
    map: NormalMap,
    settings: Settings,
    cached: bool,
    state: Mutex<State>,
}

/// What changes.
pub(super) struct State {
    /// None when it was finished.
    pub build: Option<Build>,
    texture: Option<LobeTexture>,
    copies: Vec<Readback>,
}

impl AirglowNormalMap {
    pub(super) fn state(&self) -> MutexGuard<'_, State> {
        // A poisoned lock means a panic that was reported as a defect; the data is whole.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// How far the build of a map is.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowNormalMapProgress {
    /// Texels of the steps that were prepared.
    pub done: u64,
    /// Texels of all steps.
    pub total: u64,
    /// Texels of the map that had no direction.
    pub repaired: u64,
    /// 1: the texture comes from the file that was named.
    pub cached: u32,
    /// Not used.
    pub reserved: u32,
}

/// The texture of a map: array layer j holds lobe j of every texel, `(weight * mean normal, weight)`; mip m is level m + 1
/// of the map. To be sampled with linear filters, after its last step, in `VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowLobeTexture {
    /// The `VkImage`, which lives as long as the map; 0 for a map of one texel, whose normal is all that there is.
    pub image: u64,
    /// Bytes of its texels.
    pub bytes: u64,
    /// Its `VkFormat`.
    pub format: u32,
    /// Its `VkImageUsageFlags`.
    pub usage: u32,
    /// Texels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Mips.
    pub mips: u32,
    /// Array layers: lobes.
    pub layers: u32,
}

/// Makes a map: the memory of its build and its texture; nothing is recorded.
///
/// # Safety
/// `info` points at as many bytes as it says, its texels are as many bytes as it says, its path is null or ends in a nul;
/// `map` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_new(
    normals: *const AirglowNormals,
    info: *const AirglowNormalMapInfo,
    map: *mut *mut AirglowNormalMap,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(map, "map", || {
                let AirglowNormals { context, normals } = shared(normals, "normals")?;
                let info = versioned(info, "info")?;
                let (map, settings) = (info.read()?, *normals.settings());
                let path =
                    (!info.cache.is_null()).then(|| string(info.cache, "info.cache", "")).transpose()?;
                let kept = path.and_then(|path| cache::load(Path::new(path), &map, &settings).ok());
                let build = match &kept {
                    Some(chain) => normals.upload(context, &map, chain)?,
                    None => normals.build(context, &map)?,
                };
                let texture = build.texture().cloned();
                let state = Mutex::new(State { build: Some(build), texture, copies: Vec::new() });
                let context = Arc::clone(context);
                Ok(AirglowNormalMap { context, map, settings, cached: kept.is_some(), state })
            })
        })
    }
}

/// Makes counters for `airglow_normal_map_count`: lobes that are not finite; lobes that hold no normal, so that fewer would
/// do.
///
/// # Safety
/// `health` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normals_health_new(
    normals: *const AirglowNormals,
    health: *mut *mut AirglowHealth,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(health, "health", || {
                AirglowHealth::tallied(&shared(normals, "normals")?.context, PASS, &HEALTH)
            })
        })
    }
}

/// Has the lobes of all levels counted in a step of the build of their own, before its last: to be called before any step
/// is prepared. A map that comes from a file has nothing to count.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_count(
    map: *const AirglowNormalMap,
    health: *const AirglowHealth,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let (map, tally) = (shared(map, "map")?, shared(health, "health")?.tally(PASS)?);
            let mut state = map.state();
            match state.build.as_mut().filter(|build| build.progress().done == 0) {
                Some(build) => build.count(&tally),
                None => return Err(Failure::argument("map", "steps of it were prepared: count before")),
            }
            Ok(())
        })
    }
}

/// Writes the plan that the library's graph makes of the next steps of a map's build, at most `most`; they do not count as
/// taken. The format is an `AirglowPlanFormat`.
///
/// # Safety
/// `text` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_plan(
    map: *const AirglowNormalMap,
    most: usize,
    format: u32,
    text: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let map = shared(map, "map")?;
            let (mut graph, mut imports) = (Graph::<Record>::new(), Imports::new());
            // A copy of the build takes the steps, and shares its buffers.
            if let Some(mut build) = map.state().build.clone() {
                build.add(&mut graph, &mut imports, most);
            }
            write_plan(&map.context, graph, format, text)
        })
    }
}

/// Says how far the build of a map is.
///
/// # Safety
/// `progress` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_progress(
    map: *const AirglowNormalMap,
    progress: *mut AirglowNormalMapProgress,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(progress, "progress", || {
                let map = shared(map, "map")?;
                let made = map.state().build.as_ref().map(Build::progress);
                Ok(AirglowNormalMapProgress {
                    done: made.map_or(0, |made| made.done),
                    total: made.map_or(0, |made| made.total),
                    repaired: map.map.repaired() as u64,
                    cached: u32::from(map.cached),
                    reserved: 0,
                })
            })
        })
    }
}

/// Says what the texture of a map is; its contents are there when the last step is done.
///
/// # Safety
/// `texture` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_texture(
    map: *const AirglowNormalMap,
    texture: *mut AirglowLobeTexture,
    error: *mut AirglowError,
) -> AirglowStatus {
    let none = AirglowLobeTexture {
        image: 0,
        bytes: 0,
        format: 0,
        usage: 0,
        width: 0,
        height: 0,
        mips: 0,
        layers: 0,
    };
    let row = |texture: &LobeTexture| {
        let desc = texture.image.desc();
        AirglowLobeTexture {
            image: texture.image.raw().as_raw(),
            bytes: texture.bytes,
            format: desc.format.as_raw() as u32,
            usage: desc.usage.as_raw(),
            width: desc.extent[0],
            height: desc.extent[1],
            mips: desc.mips,
            layers: desc.layers,
        }
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(texture, "texture", || Ok(shared(map, "map")?.state().texture.as_ref().map_or(none, row)))
        })
    }
}

/// Records copies of a texture's bytes for `airglow_normal_map_store`, after its last step.
///
/// # Safety
/// As `airglow_prepared_record`; all steps were recorded before, in this command buffer or in one submitted earlier.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_read_back(
    map: *const AirglowNormalMap,
    command_buffer: u64,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the handles.
    unsafe {
        edge(error, || {
            let map = shared(map, "map")?;
            let state = &mut *map.state();
            if command_buffer == 0 {
                return Err(Failure::argument("command_buffer", "it is null"));
            }
            let build = state.build.as_ref().filter(|build| {
                let progress = build.progress();
                progress.done == progress.total
            });
            let Some(build) = build else {
                return Err(Failure::argument(
                    "map",
                    "it has steps left, or it was finished: read it in between",
                ));
            };
            let mut recorder = Recorder::new(&map.context, vk::CommandBuffer::from_raw(command_buffer));
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            state.copies = build.read_back(&mut recorder)?;
            Ok(())
        })
    }
}

/// Writes the texture of a map to a file, whole or not at all, for the `cache` of `AirglowNormalMapInfo`.
///
/// # Safety
/// `path` ends in a nul; the device has finished what `airglow_normal_map_read_back` recorded.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_store(
    map: *const AirglowNormalMap,
    path: *const c_char,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let map = shared(map, "map")?;
            shared(path, "path")?;
            let path = string(path, "path", "")?;
            let state = map.state();
            if state.copies.is_empty() {
                return Err(Failure::argument("map", "it was not read back: airglow_normal_map_read_back"));
            }
            let levels = state.copies.iter().map(Readback::read).collect::<Result<_, _>>()?;
            let stored = cache::store(Path::new(path), &map.map, &map.settings, &PackedChain { levels });
            stored.map_err(|error| Failure::argument("path", &error.to_string()))
        })
    }
}

/// Frees what only the build of a map needs, at once or frames later, as the device is done with it; the texture stays.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_finish(
    map: *const AirglowNormalMap,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let mut state = shared(map, "map")?.state();
            state.build = None;
            state.copies = Vec::new();
            Ok(())
        })
    }
}

/// Drops a map and its texture. Null is nothing.
///
/// # Safety
/// The pointer is not used again; the host has no view of the texture any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_drop(map: *mut AirglowNormalMap) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(map)) };
}
