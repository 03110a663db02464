//! What the shadow pass leaves open, and what its clusters looked at.

use std::f32::consts::PI;

use airglow::shadow::{CLUSTER, slots};
use glam::Mat4;

use super::{Shown, View};
use crate::compare::legend::Values;
use crate::failure::{Failure, Outcome};
use crate::host::lighting::Lighting;
use crate::host::shadow::still_receivers;

/// The views.
pub const VIEWS: [View; 3] = [
    View {
        name: "shadow-visibility",
        title: "share of all directions that what moves leaves open",
        high: Some(1.0),
    },
    View {
        name: "shadow-blockers",
        title: "spheres and nodes that a cluster of 64 vertices looked at",
        high: None,
    },
    View { name: "shadow-clamps", title: "vertices of a cluster whose result was clamped", high: None },
];

/// The values of one of them.
pub fn values(shown: &Shown<'_>, name: &str) -> Outcome<Values> {
    let mut renderer = shown.renderer()?;
    let probed = shown.probe(&mut renderer)?;
    let Lighting::Relight(lit) = &renderer.lighting else { return Err(nothing()) };
    if lit.shadow.is_none() {
        return Err(nothing());
    }
    let coefficients = (shown.scene.quality.order as usize).pow(2);
    let mut all = Vec::with_capacity(probed.visibility.len());
    for (instance, (visibility, records)) in probed.visibility.iter().zip(&probed.records).enumerate() {
        // What has no shadow sees everything; the clusters of what moves are not told here.
        let own = if name == "shadow-visibility" { 1.0 } else { -1.0 };
        let mut values = shown.everywhere(instance, own);
        if name == "shadow-visibility" {
            let rows = values.iter_mut().zip(visibility.chunks_exact(coefficients));
            rows.for_each(|(value, row)| *value = (row[0] / (4.0 * PI).sqrt()).max(0.0));
        } else if !lit.instances[instance].moves {
            let transform = shown.scene.instances[instance].transform;
            let space = if lit.instances[instance].in_world { Mat4::IDENTITY } else { transform };
            let (positions, _) = still_receivers(shown.scene, instance, space);
            let column = usize::from(name == "shadow-clamps");
            for (cluster, record) in slots(&positions).chunks(CLUSTER).zip(records) {
                for &slot in cluster {
                    values
                        .get_mut(slot as usize)
                        .into_iter()
                        .for_each(|value| *value = record[column] as f32);
                }
            }
        }
        all.push(values);
    }
    shown.vertices(&all)
}

fn nothing() -> Failure {
    Failure::input(
        "the shadow pass has nothing to do in this scene: it needs a [[figure]] or a [[blocker]], and light",
    )
}
