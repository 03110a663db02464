//! The curve of the bake's rays: the time is the bake's, on the CPU, and the error is the noise that the eye sees.

use airglow::relight::Settings;

use super::choice;
use super::curves::Measurement;
use super::errors;
use super::truth::Truth;
use super::vectors::FULL_ORDER;
use crate::failure::{Failure, Outcome};
use crate::host::machine;
use crate::report::interleave;
use crate::report::model::{Counts, Curve, Errors, Point};

impl Measurement<'_> {
    /// Rays of the bake, at the default order.
    ///
    /// The truth is a bake of the same order with at least four times as many rays as any compared, drawn
    /// independently of them in two halves. Against a truth without a basis the error of the truncated order, which no
    /// number of rays lowers, would hide the noise from vertex to vertex that shows as mottling.
    pub fn rays(&self) -> Outcome<Curve> {
        let settings = Settings::default();
        let [first, second] = &self.workload.halves;
        let truth = Truth::of_halves(&self.colours(settings, first)?, &self.colours(settings, second)?)?;
        let points = self.ray_points(settings, &truth)?;
        let chosen = choice::climb(&points)?;
        let chosen = chosen.map(|choice| Self::measured_on(choice, &processor()));
        let comparisons = match &chosen {
            Some(choice) => interleave::compare(&points, &choice.setting).map_err(Failure::work)?,
            None => Vec::new(),
        };
        let order = settings.order;
        Ok(Curve {
            knob: "rays".to_owned(),
            question: format!(
                "How many rays for each vertex? They cost bake time only; the frame does not change. Invocations are \
                 rays. {}",
                choice::rule()
            ),
            norm: self.norm_of_rays(&truth, &points, order),
            timed: format!(
                "a bake of order {order} of {} vertices on the CPU, all threads, in turn; memory held is the cache file \
                 of {} vertices, invocations are rays, and a frame reads and writes nothing more for more of them",
                self.workload.timed_vertices, self.workload.vertex_count
            ),
            points,
            chosen,
            comparisons,
        })
    }

    fn ray_points(&self, settings: Settings, truth: &Truth) -> Outcome<Vec<Point>> {
        let one = |bake: &super::baker::Bake| {
            let colours = self.colours(settings, &bake.vectors)?;
            let rays = u64::from(bake.rays) * self.workload.timed_vertices as u64;
            Ok(Point {
                setting: format!("{} rays", bake.rays),
                milliseconds: bake.milliseconds.clone(),
                memory: bake.file_bytes,
                counts: Counts { invocations: rays, ..Counts::default() },
                error: Errors {
                    arithmetic: Some(errors::arithmetic(
                        &colours,
                        settings.order,
                        &bake.vectors,
                        self.workload,
                    )),
                    setting: None,
                    model: Some(truth.error(&colours)?),
                    model_p95: Some(truth.error_p95(&colours)?),
                },
                distribution: None,
            })
        };
        self.workload.bakes.iter().map(one).collect()
    }

    fn norm_of_rays(&self, truth: &Truth, points: &[Point], order: usize) -> String {
        let p95 = |point: &Point| {
            point.error.model_p95.map(|p95| format!("{} {:.1} %", point.setting, 100.0 * p95))
        };
        let p95: Vec<String> = points.iter().filter_map(p95).collect();
        format!(
            "model: root mean square error of the vertices over root mean square colour, against a bake of order \
             {order} with {} rays a vertex drawn independently, so that the basis' own error does not hide the noise; \
             the truth's own noise, {:.1e}, is estimated from its two halves and subtracted in quadrature. 95th \
             percentile over vertices, at order {order} (vectors truncated from order {FULL_ORDER}): {}",
            self.effort.truth_rays,
            truth.noise(),
            p95.join(", ")
        )
    }
}

fn processor() -> String {
    machine::processor().unwrap_or_else(|| "this machine's processors".to_owned())
}
