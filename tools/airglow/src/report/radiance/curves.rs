//! The knobs of the pass, one curve each.

use airglow::radiance::{Oracle, PassSettings, Settings, Triangle};

use super::Measurement;
use super::race::Setting;
use super::workload::{CONVERGED, FINE, FULL_ORDER};
use crate::failure::{Failure, Outcome};
use crate::host::near::BOUND;
use crate::report::interleave;
use crate::report::model::{Choice, Curve, Point};
use crate::report::relight::choice;

/// Bounds of the curve: two decades and a half.
const BOUNDS: [f64; 6] = [0.3, 0.1, 0.03, 0.01, 0.003, 0.001];

/// What is varied, knob by knob.
pub fn default_settings() -> PassSettings {
    PassSettings::default()
}

fn refined(change: impl FnOnce(&mut Settings)) -> PassSettings {
    let mut pass = default_settings();
    change(&mut pass.refinement);
    pass
}

impl Measurement<'_> {
    /// The bound on the oracle's estimate.
    pub fn bound(&self) -> Outcome<Curve> {
        let settings = BOUNDS.map(|bound| {
            let pass = PassSettings { face: FINE.0, rays: FINE.1, ..refined(|r| r.bound = bound) };
            Setting::new(bound.to_string(), pass).of_same_rays()
        });
        let question = format!(
            "Which bound on the error of a node's vertices, in units of colour? The error falls with it. Faces of {} \
             texels with {} x {} rays, so that rays do not decide. The host of this command asks for {BOUND}.",
            FINE.0, FINE.1, FINE.1
        );
        self.knob("bound", &question, settings.into(), &default_settings().refinement.bound.to_string())
    }

    /// The most samples.
    pub fn limit(&self) -> Outcome<Curve> {
        let limits = [16, 64, 256, 1024, 4096];
        let setting = |limit: usize| {
            Setting::new(
                limit.to_string(),
                PassSettings {
                    face: FINE.0,
                    rays: FINE.1,
                    ..refined(|r| (r.bound, r.limit) = (BOUNDS[5], limit))
                },
            )
            .of_same_rays()
        };
        let question = "What is left of the error where a limit on samples stops the bound, here of 0.001?";
        let default = default_settings().refinement.limit.to_string();
        self.knob("limit", question, limits.map(setting).into(), &default)
    }

    /// Texels and rays.
    pub fn face(&self) -> Outcome<Curve> {
        let sizes =
            [(8, 1), (8, 2), (8, 4), (16, 1), (16, 2), (16, 4), (32, 1), (32, 2), (32, 4), (64, 1), (64, 2)];
        let name = |face: u32, rays: u32| format!("{face} texels, {rays} x {rays} rays");
        let setting =
            |(face, rays)| Setting::new(name(face, rays), PassSettings { face, rays, ..default_settings() });
        let default = default_settings();
        let question =
            "Texels along a side of a face, and rays of a texel: rays decide the error, texels the time.";
        self.knob("face and rays", question, sizes.map(setting).into(), &name(default.face, default.rays))
    }

    /// Bands.
    pub fn order(&self) -> Outcome<Curve> {
        let settings = (3..=FULL_ORDER)
            .map(|order| Setting::new(order.to_string(), PassSettings { order, ..default_settings() }));
        let question = "How many bands?";
        self.knob("order", question, settings.collect(), &default_settings().order.to_string())
    }

    /// Gradients of samples.
    pub fn gradients(&self) -> Outcome<Curve> {
        let mut settings = Vec::new();
        for bound in [0.1, 0.03, 0.01, 0.003] {
            for gradients in [false, true] {
                let pass = PassSettings { gradients, ..refined(|r| r.bound = bound) };
                settings.push(Setting::new(gradients_name(gradients, bound), pass));
            }
        }
        let question = "Are gradients worth their time, or are more samples? Each at several bounds.";
        let default = gradients_name(true, default_settings().refinement.bound);
        self.knob("gradients", question, settings, &default)
    }

    /// Levels that a split goes down.
    pub fn stride(&self) -> Outcome<Curve> {
        let setting = |stride: usize| Setting::new(stride.to_string(), refined(|r| r.stride = stride));
        let question = "How many levels may a split go down at once? With 1 half of the samples are of nodes split in \
                        turn.";
        let default = default_settings().refinement.stride.to_string();
        self.knob("stride", question, [1, 2, 3, 4, 6, 8].map(setting).into(), &default)
    }

    /// Ways to guess the error of a node, at about as many samples.
    pub fn oracle(&self) -> Outcome<Curve> {
        let mut settings = Vec::new();
        for oracle in [Oracle::Printed, Oracle::Argued, Oracle::Transfer] {
            for bound in self.bounds_for(oracle, [64, 192])? {
                let setting = Setting::new(
                    format!("{oracle:?}, {bound:.1e}"),
                    refined(|r| (r.oracle, r.bound) = (oracle, bound)),
                );
                settings.push(setting);
            }
        }
        let default = settings.last().map_or_else(String::new, |setting| setting.name.clone());
        let question = "Eq. 3.3 of Sun 2005 as printed and as argued, or with the transfer of the node? At bounds that \
                        take about 64 and 192 samples.";
        self.knob("oracle", question, settings, &default)
    }

    /// Triangles of the emitters: the same shapes, more finely cut.
    pub fn triangles(&self) -> Outcome<Curve> {
        let mut emitters = self.workload.emitters.clone();
        let mut settings = Vec::new();
        for _ in 0..4 {
            let name = format!("{} triangles", emitters.len());
            let finer = emitters.iter().flat_map(quarters).collect();
            settings.push(Setting { emitters: Some(emitters), ..Setting::new(name, default_settings()) });
            emitters = finer;
        }
        let question = "How does time grow with the triangles of the emitters, whose shapes stay?";
        let curve = self.knob("emitter triangles", question, settings, "")?;
        Ok(Curve { chosen: None, comparisons: Vec::new(), ..curve })
    }

    /// Bounds at which an oracle takes about so many samples, by bisection.
    fn bounds_for(&self, oracle: Oracle, counts: [usize; 2]) -> Outcome<[f64; 2]> {
        let mut found = [0.0; 2];
        for (found, count) in found.iter_mut().zip(counts) {
            let (mut low, mut high) = (1e-4_f64, 1e2_f64);
            for _ in 0..10 {
                let bound = (low * high).sqrt();
                let pass = refined(|r| (r.oracle, r.bound, r.limit) = (oracle, bound, 2 * count));
                if self.samples(&pass)? > count { low = bound } else { high = bound }
            }
            *found = high;
        }
        Ok(found)
    }

    /// How errors are measured.
    pub fn norm(&self) -> String {
        format!(
            "root mean square over root mean square colour, all vertices and channels. arithmetic: the device against \
             f64, the same samples and rays. setting: against a sample at each vertex of the same order, faces of {} \
             texels with {} x {} rays; of bound and limit, whose way leads to a sample at each vertex of their own faces, \
             against those. model: against emitters ray-traced from each vertex, beyond the truth's own noise \
             of {:.1e}; what a vertex does not see is hidden from it to infinity, as in its transfer",
            CONVERGED.0,
            CONVERGED.1,
            CONVERGED.1,
            self.workload.truth.noise()
        )
    }

    /// A curve with the choice of its rule, and how the default stands to it.
    fn knob(&self, knob: &str, question: &str, settings: Vec<Setting>, default: &str) -> Outcome<Curve> {
        let points = self.settings(knob, settings)?;
        let is_default = |point: &&Point| point.setting.split(" (").next() == Some(default);
        let default = points.iter().find(is_default).map(|point| point.setting.clone());
        let by_rule = choice::climb(&points)?;
        let chosen = match (default, by_rule) {
            (Some(setting), Some(rule)) if rule.setting == setting => {
                Some(Choice { reason: format!("The rule takes the default: {}.", rule.reason), setting })
            }
            (Some(setting), Some(rule)) => {
                let reason = format!(
                    "The default; the rule would take {} on this device: {}.",
                    rule.setting, rule.reason
                );
                Some(Choice { reason, setting })
            }
            (_, rule) => rule,
        };
        let comparisons = match &chosen {
            Some(choice) => interleave::compare(&points, &choice.setting).map_err(Failure::work)?,
            None => Vec::new(),
        };
        Ok(Curve {
            knob: knob.to_owned(),
            question: format!("{question} {}", choice::rule()),
            norm: self.norm(),
            timed: "sampling anew and light of all vertices, device time of a frame; memory held is the receiver's, \
                    with room for as many samples as the limit, and that of the light"
                .to_owned(),
            points,
            chosen,
            comparisons,
        })
    }
}

fn gradients_name(gradients: bool, bound: f64) -> String {
    format!("{}, bound {bound}", if gradients { "gradients" } else { "none" })
}

/// A triangle in four.
pub fn quarters(triangle: &Triangle) -> [Triangle; 4] {
    let [a, b, c] = triangle.corners;
    let middle = |x: glam::DVec3, y: glam::DVec3| x.midpoint(y).as_vec3().as_dvec3();
    let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].map(|corners| Triangle { corners, ..*triangle })
}
