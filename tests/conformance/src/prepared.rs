//! Rooms whose pipelines were all made before, on another thread: making them, declaring and recording makes no other.

use super::host::Host;
use super::{HostDevice, Refusal, Road, Room};
use airglow_gpu::{Context, Execution, Options, Requirements};
use std::error::Error;
use std::thread;

/// How a room is made of pipelines that are ready.
pub type MakePrepared<'a, P, R> = &'a dyn Fn(&Context, &P) -> Result<R, Refusal>;

/// Has `prepare` make pipelines on a thread of its own, then makes and records each room by both roads, without submitting;
/// `count` says how many pipelines `prepare` is to make. Returns how many it made.
///
/// # Safety
/// As [`conform_on`](crate::conform_on).
///
/// # Errors
/// What the room or the device refuses; another number of pipelines; a room that made one.
pub unsafe fn prepare_on<P: Send, E: Error + Send + 'static, R: Room>(
    host: &HostDevice<'_>,
    requirements: &Requirements,
    prepare: impl Fn(&Context) -> Result<P, E> + Sync,
    count: usize,
    makes: &[MakePrepared<'_, P, R>],
) -> Result<u64, Refusal> {
    let requirements = Requirements::engine().and(requirements);
    // SAFETY: the caller's promise is ours.
    let host = unsafe { Host::new(host)? };
    let shim = host.watch();
    let mut held = Vec::new();
    let context = host.adopt(&shim, &requirements, &Options::default(), 1)?;
    let pipelines = thread::scope(|scope| scope.spawn(|| prepare(&context)).join());
    let pipelines = pipelines.map_err(|_| "the thread that made pipelines has panicked")??;
    let made = context.pipelines_made();
    if made != count as u64 {
        return Err(format!("{made} pipelines were made, {count} were said").into());
    }
    for (place, make) in makes.iter().enumerate() {
        for road in [Road::Graph, Road::Record] {
            // SAFETY: nothing is submitted.
            unsafe { context.begin_frame(context.frame() + 1) }?;
            let room = make(&context, &pipelines)?;
            host.frame_in(&context, &shim, room, (road, Execution::prepare, false), &mut held)?;
            let more = context.pipelines_made() - made;
            if more > 0 {
                return Err(format!("room {place} made {more} pipelines, {road:?}").into());
            }
        }
    }
    drop(context);
    Ok(made)
}
