//! The sweeps of sizes of each pass, whatever the scene.

use airglow::relight::{Relight, Settings};

use crate::failure::Outcome;
use crate::host::device;
use crate::report::bench::Bench;
use crate::report::interleave::Rounds;
use crate::report::model::scaling::Scaling;
use crate::report::relight::scaling;

/// Rounds of frames that are short.
const ROUNDS: Rounds = Rounds { warm_up: 2, measured: 7 };

/// What `--full` does.
#[cfg(feature = "radiance")]
const FULL: &str = "1000, with --full";

impl Bench<'_> {
    /// All of them; the longest only with `full`.
    #[cfg_attr(
        not(feature = "radiance"),
        expect(unused_variables, reason = "only near emitters take minutes")
    )]
    pub fn sweeps(&self, full: bool) -> Outcome<Vec<Scaling>> {
        #[cfg_attr(
            not(any(feature = "fog", feature = "radiance", feature = "shadow")),
            expect(unused_mut, reason = "other rooms add to it")
        )]
        let mut sweeps = vec![self.vertices()?];
        #[cfg(feature = "fog")]
        sweeps.push(self.lights()?);
        #[cfg(feature = "shadow")]
        sweeps.push(self.blockers()?);
        #[cfg(feature = "radiance")]
        sweeps.push(self.emitters(full)?);
        Ok(sweeps)
    }

    fn vertices(&self) -> Outcome<Scaling> {
        let counts = [1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000];
        let points = device::with(self.global, &Relight::requirements(&Settings::default()), |device| {
            scaling::vertices(device, &counts, ROUNDS, self.output)
        })?;
        let timed =
            "relighting at order 4: rotation of the light and the kernel over the vertices, device time";
        Ok(Scaling::new("vertices", timed.to_owned(), "", points))
    }

    #[cfg(feature = "fog")]
    fn lights(&self) -> Outcome<Scaling> {
        use crate::report::fog::{Effort, Measurement};
        use crate::report::pass::Pass;
        use crate::scene_options::SceneOptions;
        let scene = SceneOptions::plain(Pass::Fog.scene().as_ref(), None).load(self.output)?;
        let requirements = airglow::fog::Fog::requirements(&airglow::fog::Settings::default());
        let points = device::with(self.global, &requirements, |device| {
            Measurement { device, effort: Effort::new(self.quick), output: self.output }.lights_of(&scene)
        })?;
        let timed = "the fog pass over 512 x 512 pixels, all of which every lamp reaches, device time";
        Ok(Scaling::new("lights", timed.to_owned(), "", points))
    }

    #[cfg(feature = "shadow")]
    fn blockers(&self) -> Outcome<Scaling> {
        use crate::report::shadow::{Effort, Measurement};
        let points = device::with(self.global, &airglow::shadow::Shadow::requirements(), |device| {
            let measurement = Measurement { device, effort: Effort::new(self.quick), output: self.output };
            measurement.blockers(&[1, 3, 10, 30, 100, 300, 1000])
        })?;
        let timed = "the shadow pass at order 4 over a square of ground, no sphere left out, a submission and its wait";
        Ok(Scaling::new("blockers", timed.to_owned(), "", points))
    }

    #[cfg(feature = "radiance")]
    fn emitters(&self, full: bool) -> Outcome<Scaling> {
        use crate::report::radiance::scaling;
        let counts = [1, 3, 10, 30, 100, 300, 1000];
        let (counts, cut) = if full { (&counts[..], "") } else { (&counts[..6], FULL) };
        let points = device::with(self.global, &crate::host::near::measured_requirements(), |device| {
            scaling::emitters(device, counts, ROUNDS, self.output)
        })?;
        let timed = format!(
            "the radiance pass: {} samples taken anew of emitters of two triangles each, and light of {} vertices, device \
             time",
            scaling::SAMPLES,
            scaling::VERTICES
        );
        Ok(Scaling::new("emitters", timed, cut, points))
    }
}
