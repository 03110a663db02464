//! Sets of spheres with a hierarchy: from afar a node stands for the spheres that it holds.

use airglow_shadow::MAX_SPHERES;
use airglow_shadow::spheres::{Hierarchy, Node};

use super::AirglowShadow;
use super::prepared::{AirglowSphere, ShadowFrame, matrix, read};
use crate::input::{array, shared, take};
use crate::pass::give;
use crate::prepared::AirglowPrepared;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// The tree of a set of spheres, with the ratios its nodes count by; it stays while the set moves. Any thread may use it.
pub struct AirglowSphereHierarchy {
    hierarchy: Hierarchy,
}

/// A set of spheres in a pose. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowSphereSet {
    /// Its hierarchy; null for one without.
    pub hierarchy: *const AirglowSphereHierarchy,
    /// Its spheres, in the order in which the hierarchy was made of them.
    pub spheres: *const AirglowSphere,
    /// How many.
    pub sphere_count: usize,
}

/// Makes the hierarchy of a set of spheres as it rests, for the order of the pass. Ratios are sought over points all around:
/// once for a set, not in a frame.
///
/// # Safety
/// `spheres` has `sphere_count` elements; `hierarchy` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_sphere_hierarchy_new(
    shadow: *const AirglowShadow,
    spheres: *const AirglowSphere,
    sphere_count: usize,
    hierarchy: *mut *mut AirglowSphereHierarchy,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(hierarchy, "hierarchy", || {
                let order = shared(shadow, "shadow")?.shadow.settings().order;
                let spheres = read(array(spheres, sphere_count, "spheres")?)?;
                Ok(AirglowSphereHierarchy { hierarchy: Hierarchy::new(&spheres, order)? })
            })
        })
    }
}

/// Drops a hierarchy; frames that it was set in keep what it said. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_sphere_hierarchy_drop(hierarchy: *mut AirglowSphereHierarchy) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(hierarchy)) };
}

/// Sets sets of spheres, with hierarchies and without, in a prepared frame; all else as `airglow_shadow_set` says.
///
/// # Safety
/// `sets` has `set_count` elements, whose spheres are as many as each says; else as `airglow_shadow_set`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_set_sets(
    prepared: *const AirglowPrepared,
    sets: *const AirglowSphereSet,
    set_count: usize,
    receiver_from_world: *const f64,
    blocks: *mut u32,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &ShadowFrame = shared(prepared, "prepared")?.of()?;
            let mut nodes = Vec::new();
            for set in array(sets, set_count, "sets")? {
                nodes.extend(posed(set)?);
                if nodes.len() > MAX_SPHERES {
                    let problem = format!("they hold more than {MAX_SPHERES} spheres and nodes");
                    return Err(Failure::argument("sets", &problem));
                }
            }
            frame.blockers().set_nodes(&nodes, matrix(receiver_from_world)?)?;
            frame.say_blocks(blocks)
        })
    }
}

/// # Safety
/// The set's spheres are as many as it says.
unsafe fn posed(set: &AirglowSphereSet) -> Result<Vec<Node>, Failure> {
    // SAFETY: the caller's promise is ours.
    let spheres = read(unsafe { array(set.spheres, set.sphere_count, "sets.spheres")? })?;
    if set.hierarchy.is_null() {
        return Ok(spheres.into_iter().map(Node::alone).collect());
    }
    // SAFETY: as above.
    Ok(unsafe { shared(set.hierarchy, "sets.hierarchy")? }.hierarchy.posed(&spheres)?)
}
