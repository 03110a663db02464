//! Settings of each pass as a wish turns them, and passes made anew with them.

use airglow_scene::Scene;

use super::stage::Stage;
use super::wish::{self, KNOBS, Wish};
use crate::failure::Outcome;

/// The values that all knobs have in a scene, those that a wish does not turn as the preset says; `None` for passes that
/// are not built in.
#[cfg_attr(
    not(any(feature = "fog", feature = "radiance", feature = "shadow")),
    expect(unused_variables, reason = "no pass that has knobs of its own is built in")
)]
pub fn values(scene: &Scene, wish: &Wish) -> [Option<f64>; KNOBS.len()] {
    let mut values = [None; KNOBS.len()];
    values[wish::ORDER] = Some(f64::from(scene.quality.order));
    #[cfg(feature = "fog")]
    {
        values[wish::FOG_BOUND] = Some(fog(scene, wish).bound);
    }
    #[cfg(feature = "radiance")]
    {
        values[wish::RADIANCE_BOUND] = Some(radiance(scene, wish).refinement.bound);
    }
    #[cfg(feature = "shadow")]
    {
        let settings = shadow(scene, wish);
        values[wish::REACH] = Some(settings.reach);
        values[wish::CUT] = Some(settings.cut);
        values[wish::WINDOW] = Some(settings.window);
    }
    values
}

#[cfg(feature = "shadow")]
fn shadow(scene: &Scene, wish: &Wish) -> airglow::shadow::Settings {
    let asked = crate::host::shadow::settings(scene);
    airglow::shadow::Settings {
        reach: wish.values[wish::REACH].unwrap_or(asked.reach),
        cut: wish.values[wish::CUT].unwrap_or(asked.cut),
        window: wish.values[wish::WINDOW].unwrap_or(asked.window),
        ..asked
    }
}

#[cfg(feature = "radiance")]
fn radiance(scene: &Scene, wish: &Wish) -> airglow::radiance::PassSettings {
    let mut asked = crate::host::near::settings(scene);
    asked.refinement.bound = wish.values[wish::RADIANCE_BOUND].unwrap_or(asked.refinement.bound);
    asked
}

#[cfg(feature = "fog")]
fn fog(scene: &Scene, wish: &Wish) -> airglow::fog::Settings {
    let asked = crate::host::fog::settings(scene, airglow::fog::Settings::default().format);
    airglow::fog::Settings { bound: wish.values[wish::FOG_BOUND].unwrap_or(asked.bound), ..asked }
}

#[cfg_attr(
    not(all(feature = "shadow", feature = "radiance", feature = "fog")),
    expect(unused_variables, reason = "a pass that is not built in is not made")
)]
impl Stage<'_> {
    /// The shadow pass with the settings wished.
    pub(super) fn remake_shadow(&mut self, scene: &Scene, wish: &Wish) -> Outcome {
        #[cfg(feature = "shadow")]
        self.renderer.remake_shadow(scene, &self.source, shadow(scene, wish))?;
        Ok(())
    }

    /// The radiance pass.
    pub(super) fn remake_radiance(&mut self, scene: &Scene, wish: &Wish) -> Outcome {
        #[cfg(feature = "radiance")]
        self.renderer.remake_near(scene, &self.source, radiance(scene, wish))?;
        Ok(())
    }

    /// The fog pass.
    pub(super) fn remake_fog(&mut self, scene: &Scene, wish: &Wish) -> Outcome {
        #[cfg(feature = "fog")]
        self.renderer.remake_fog(scene, fog(scene, wish))?;
        Ok(())
    }
}
