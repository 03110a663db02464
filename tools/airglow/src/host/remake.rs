//! One part of a renderer made anew, or moved, while all others stay.

#[cfg(any(feature = "fog", feature = "radiance"))]
use std::sync::Arc;

use airglow_scene::Scene;
#[cfg(feature = "radiance")]
use glam::Mat4;
use glam::Vec3;

#[cfg(any(feature = "radiance", feature = "shadow"))]
use super::lighting::Lighting;
use super::lights::LightsConstants;
use super::renderer::Renderer;
#[cfg(any(feature = "radiance", feature = "shadow"))]
use super::source::Source;
use crate::failure::Outcome;

impl Renderer<'_> {
    /// Makes the shadow pass anew with these settings, where there is the pass.
    #[cfg(feature = "shadow")]
    pub fn remake_shadow(
        &mut self,
        scene: &Scene,
        source: &Source,
        settings: airglow::shadow::Settings,
    ) -> Outcome {
        use super::shadow::SceneShadow;

        if let (Lighting::Relight(lit), Source::Relight(transfer)) = (&mut self.lighting, source)
            && lit.shadow.is_some()
        {
            lit.shadow = Some(SceneShadow::with_settings(self.device, scene, transfer, settings)?);
        }
        Ok(())
    }

    /// The same of the radiance pass.
    #[cfg(feature = "radiance")]
    pub fn remake_near(
        &mut self,
        scene: &Scene,
        source: &Source,
        settings: airglow::radiance::PassSettings,
    ) -> Outcome {
        use super::near::NearLight;

        if let (Lighting::Relight(lit), Source::Relight(transfer)) = (&mut self.lighting, source)
            && lit.near.is_some()
        {
            let context = self.device.context();
            lit.near = Some(NearLight::with_settings(context, scene, transfer, settings)?);
        }
        Ok(())
    }

    /// The same of the fog pass, with the medium that the scene has now.
    #[cfg(feature = "fog")]
    pub fn remake_fog(&mut self, scene: &Scene, settings: airglow::fog::Settings) -> Outcome {
        use super::fog::SceneFog;

        let Some(before) = &self.fog else { return Ok(()) };
        let settings = airglow::fog::Settings { format: before.pass.settings().format, ..settings };
        let fog = SceneFog::with_settings(self.device, scene, Some(&self.scene), settings)?;
        fog.iter().for_each(|fog| fog.name_tables(scene, Arc::make_mut(&mut self.scene)));
        self.fog = fog;
        self.lights = LightsConstants::of_scene(scene);
        Ok(())
    }

    /// Puts lights and emitters where they are in a scene that has moved them from where they were `loaded`, for frames
    /// declared from now on.
    #[cfg_attr(
        not(feature = "radiance"),
        expect(unused_variables, reason = "only near emitters are drawn where they are")
    )]
    pub fn place_lamps(&mut self, scene: &Scene, loaded: &Scene) {
        self.lights = LightsConstants::of_scene(scene);
        #[cfg(feature = "fog")]
        self.fog.iter_mut().for_each(|fog| fog.place_lights(scene));
        #[cfg(feature = "radiance")]
        if let Lighting::Relight(lit) = &mut self.lighting
            && let Some(near) = &mut lit.near
        {
            near.place_emitters(&scene.emitters);
            let draws = &mut Arc::make_mut(&mut self.scene).draws;
            let first = draws.len().saturating_sub(scene.emitters.len());
            for (draw, (now, then)) in
                draws[first..].iter_mut().zip(scene.emitters.iter().zip(&loaded.emitters))
            {
                let moved = Vec3::from(now.center) - Vec3::from(then.center);
                draw.material.place(Mat4::from_translation(moved));
            }
        }
    }

    /// Puts figures where they start in a scene that has moved them, from the next recording on; plans stay.
    pub fn place_figures(&mut self, scene: &Scene) {
        self.skins.iter_mut().for_each(|skins| skins.place(scene));
        #[cfg(feature = "shadow")]
        if let Lighting::Relight(lit) = &mut self.lighting {
            lit.shadow.iter_mut().for_each(|shadow| shadow.place_figures(scene));
        }
    }

    /// Centre and radius, metres, of the spheres that cast shadows `seconds` after the scene's time 0.
    #[cfg_attr(
        not(feature = "shadow"),
        expect(unused_variables, reason = "nothing moves that casts shadows")
    )]
    pub fn blockers(&self, seconds: f64) -> Vec<(Vec3, f32)> {
        #[cfg(feature = "shadow")]
        if let Lighting::Relight(lit) = &self.lighting
            && let Some(shadow) = &lit.shadow
        {
            let spheres = shadow.spheres(seconds as f32);
            return spheres.iter().map(|sphere| (sphere.center.as_vec3(), sphere.radius as f32)).collect();
        }
        Vec::new()
    }

    /// Where the radiance pass sampled in the last frame, once it is done; metres.
    pub fn sample_points(&self) -> Outcome<Vec<Vec3>> {
        #[cfg(feature = "radiance")]
        if let Lighting::Relight(lit) = &self.lighting
            && let Some(near) = &lit.near
        {
            return near.sample_points(self.device);
        }
        Ok(Vec::new())
    }
}
