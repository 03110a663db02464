//! What relighting holds and makes.

use airglow_scene::luminance;

use super::{Shown, View};
use crate::compare::legend::Values;
use crate::failure::{Failure, Outcome};
use crate::host::source::Source;

/// The views.
pub const VIEWS: [View; 3] = [
    View { name: "relight-light", title: "luminance of a white surface, w/sr/m2", high: None },
    View { name: "relight-transfer", title: "norm of the transfer vector", high: None },
    View { name: "relight-negative", title: "how far a colour is below black, w/sr/m2", high: None },
];

/// The values of one of them.
pub fn values(shown: &Shown<'_>, name: &str) -> Outcome<Values> {
    if name == "relight-transfer" {
        return transfer(shown);
    }
    let colours = shown.probe(&mut shown.renderer()?)?.colours;
    let value = |[r, g, b, _]: &[f32; 4]| match name {
        "relight-negative" => (-r.min(*g).min(*b)).max(0.0),
        _ => luminance([*r, *g, *b]).max(0.0),
    };
    let values: Vec<Vec<f32>> = colours.iter().map(|colours| colours.iter().map(value).collect()).collect();
    shown.vertices(&values)
}

fn transfer(shown: &Shown<'_>) -> Outcome<Values> {
    let Source::Relight(scene) = shown.source else {
        return Err(Failure::input(
            "nothing is relit in this scene: it needs an environment or an [[emitter]]",
        ));
    };
    let norms = |transfer: usize| {
        let baked = &scene.transfers[transfer];
        let rows = baked.coefficients.chunks_exact(baked.coefficient_count());
        rows.map(|row| row.iter().map(|t| t * t).sum::<f32>().sqrt()).collect()
    };
    let values: Vec<Vec<f32>> = scene.instances.iter().map(|instance| norms(instance.transfer)).collect();
    shown.vertices(&values)
}
