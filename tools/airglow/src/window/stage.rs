//! The scene in the window, and what is made anew of its passes when something is asked of them.

use std::path::{Path, PathBuf};
use std::time::Instant;

use airglow_scene::Scene;
use glam::Vec3;

use super::loading::{Load, Loading};
use super::wish::{Remade, Wish};
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::host::over::Over;
use crate::host::renderer::Renderer;
use crate::host::source::Source;
use crate::output::Output;

/// A scene on the device, and what is asked of it.
pub struct Stage<'d> {
    device: &'d Device<'d>,
    cache: PathBuf,
    output: Output,
    over: Option<Over>,
    size: [u32; 2],
    /// As its file says.
    loaded: Scene,
    /// As it is drawn.
    scene: Scene,
    pub(super) source: Source,
    /// What draws it.
    pub renderer: Renderer<'d>,
    made: Wish,
    /// What the next frame makes anew; one frame tells so before.
    announced: Option<Wish>,
    loading: Option<Loading>,
}

/// What a frame found to do.
#[derive(Default)]
pub struct Done {
    /// Whether plans before are void.
    pub anew: bool,
    /// Whether another scene is shown.
    pub other: bool,
    /// What to tell.
    pub status: Option<Result<String, String>>,
}

impl<'d> Stage<'d> {
    /// A scene that was loaded and baked, with a target of `size` pixels.
    pub fn new(
        device: &'d Device<'d>,
        scene: Scene,
        source: Source,
        size: [u32; 2],
        cache: PathBuf,
        output: Output,
    ) -> Outcome<Self> {
        let renderer = Renderer::new(device, &scene, &source, size)?;
        Ok(Self {
            device,
            cache,
            output,
            over: None,
            size,
            loaded: scene.clone(),
            scene,
            source,
            renderer,
            made: Wish::default(),
            announced: None,
            loading: None,
        })
    }

    /// What a camera goes around, metres.
    pub fn middle(&self) -> Vec3 {
        self.loaded.bounding_sphere().map_or(Vec3::ZERO, |sphere| sphere.center.into())
    }

    /// Passes that the scene has something for.
    pub fn present(&self) -> Vec<&'static str> {
        let scene = &self.loaded;
        let figures = scene.figures.iter().any(|figure| figure.spheres > 0);
        let present = [
            ("radiance", !scene.emitters.is_empty()),
            ("shadow", figures || !scene.blockers.is_empty()),
            ("relight", scene.environment.is_some() || !scene.emitters.is_empty()),
            ("normals", scene.materials.iter().any(|material| material.normal_texture.is_some())),
            ("fog", scene.medium.is_some()),
        ];
        present.into_iter().filter(|(_, is)| *is).map(|(room, _)| room).collect()
    }

    /// As it is drawn.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Has this drawn over the picture, whatever is made anew.
    pub fn draw_over(&mut self, over: Over) {
        self.renderer.draw_over(over.clone());
        self.over = Some(over);
    }

    /// Makes a target of another size.
    pub fn resize(&mut self, size: [u32; 2]) -> Outcome {
        self.size = size;
        self.renderer.resize(size)
    }

    /// Loads what a file holds that was dropped onto the window, a scene or an environment.
    ///
    /// # Errors
    /// It is neither, in words for the user.
    pub fn take_file(&mut self, file: &Path) -> Result<(), String> {
        self.load(Load::of_file(file)?);
        Ok(())
    }

    /// Loads another scene, or lights this one by another environment, beside the frames that go on.
    fn load(&mut self, load: Load) {
        self.loading = Some(Loading::start(load, self.loaded.clone(), self.cache.clone(), &self.output));
    }

    /// What is being done, in words and, where it is known, how far it is.
    pub fn busy(&self) -> Option<(String, Option<f32>)> {
        let remade = self.announced.as_ref().map(|wish| wish.remade(&self.made).words());
        let remade = remade.map(|words| (format!("making anew: {words}"), None));
        self.loading.as_ref().map(Loading::told).or(remade)
    }

    /// Does what `wish` asks for beyond what is made, what takes long beside the frames. What fails leaves all as it was.
    pub fn follow(&mut self, wish: &mut Wish) -> Done {
        if let Some(loading) = self.loading.take_if(|loading| loading.is_finished()) {
            let done = self.finish(loading, wish);
            self.announced = None;
            return done.unwrap_or_else(|failure| {
                *wish = self.made.clone();
                Done { status: Some(Err(failure.to_string())), ..Done::default() }
            });
        }
        let needed = wish.remade(&self.made);
        if needed.nothing() || self.loading.is_some() {
            self.announced = None;
            return Done::default();
        }
        if needed.transport {
            self.load(Load::Quality(Box::new(wish.clone())));
            return Done::default();
        }
        // One frame says what the next one waits for; while a slider moves, it waits.
        if self.announced.as_ref() != Some(wish) {
            self.announced = Some(wish.clone());
            return Done::default();
        }
        self.announced = None;
        let start = Instant::now();
        let status = match self.remake(wish, needed) {
            Ok(()) => {
                let seconds = start.elapsed().as_secs_f64();
                Ok(format!("{} made anew in {seconds:.2} s", needed.words()))
            }
            Err(failure) => {
                *wish = self.made.clone();
                Err(failure.to_string())
            }
        };
        Done { anew: true, other: false, status: Some(status) }
    }

    /// Every pass anew with shaders that have changed.
    pub fn reload(&mut self) -> Outcome {
        self.remake(&self.made.clone(), Remade { all: true, ..Remade::default() })
    }

    fn remake(&mut self, wish: &Wish, needed: Remade) -> Outcome {
        let mut scene = wish.apply(&self.loaded);
        keep_places(&self.scene, &mut scene);
        if needed.all || needed.transport {
            self.put(scene, None, wish)?;
            return Ok(());
        }
        if needed.shadow {
            self.remake_shadow(&scene, wish)?;
        }
        if needed.radiance {
            self.remake_radiance(&scene, wish)?;
        }
        if needed.fog {
            self.remake_fog(&scene, wish)?;
        }
        (self.scene, self.made) = (scene, wish.clone());
        Ok(())
    }

    /// Draws `scene` from now on, with `source` or the one there is.
    fn put(&mut self, scene: Scene, source: Option<Source>, wish: &Wish) -> Outcome {
        let new = source.as_ref().unwrap_or(&self.source);
        let mut renderer = Renderer::new(self.device, &scene, new, self.size)?;
        self.over.iter().for_each(|over| renderer.draw_over(over.clone()));
        std::mem::swap(&mut self.renderer, &mut renderer);
        let before = (std::mem::replace(&mut self.scene, scene), self.made.clone());
        let source = source.map(|source| std::mem::replace(&mut self.source, source));
        let knobs = self.turn_knobs(wish);
        match knobs {
            Ok(()) => self.made = wish.clone(),
            Err(_) => {
                std::mem::swap(&mut self.renderer, &mut renderer);
                (self.scene, self.made) = before;
                if let Some(source) = source {
                    self.source = source;
                }
            }
        }
        knobs
    }

    /// Of passes just made with what their presets say.
    fn turn_knobs(&mut self, wish: &Wish) -> Outcome {
        let scene = self.scene.clone();
        let turned = wish.remade(&Wish { values: [None; 6], ..wish.clone() });
        if turned.shadow {
            self.remake_shadow(&scene, wish)?;
        }
        if turned.radiance {
            self.remake_radiance(&scene, wish)?;
        }
        if turned.fog {
            self.remake_fog(&scene, wish)?;
        }
        self.renderer.place_lamps(&scene, &self.loaded);
        Ok(())
    }

    /// Draws what was loaded.
    fn finish(&mut self, loading: Loading, wish: &mut Wish) -> Outcome<Done> {
        let words = loading.done_words();
        let loaded = loading.finish()?;
        let other = loaded.scene.is_some();
        match loaded.scene {
            Some(scene) => {
                let before = std::mem::replace(&mut self.loaded, scene.clone());
                let put = self.put(scene, Some(loaded.source), &Wish::default());
                if let Err(failure) = put {
                    self.loaded = before;
                    return Err(failure);
                }
                *wish = Wish::default();
            }
            None => {
                let asked = loaded.wish.ok_or_else(|| Failure::work("nothing was asked for"))?;
                let mut scene = asked.apply(&self.loaded);
                keep_places(&self.scene, &mut scene);
                self.put(scene, Some(loaded.source), &asked)?;
            }
        }
        Ok(Done { anew: true, other, status: Some(Ok(words)) })
    }

    /// Moves what `change` moves in the scene: lamps, which need another plan, and figures, which do not.
    pub fn place(&mut self, change: impl FnOnce(&mut Scene)) {
        change(&mut self.scene);
        self.renderer.place_lamps(&self.scene, &self.loaded);
        self.renderer.place_figures(&self.scene);
    }

    /// Puts lamps and figures back to where they were loaded.
    pub fn home(&mut self) {
        let loaded = self.loaded.clone();
        self.place(|scene| keep_places(&loaded, scene));
    }
}

/// Puts lamps and figures of a scene where they are in another of the same parts.
fn keep_places(from: &Scene, to: &mut Scene) {
    for (to, from) in to.emitters.iter_mut().zip(&from.emitters) {
        to.center = from.center;
    }
    for (to, from) in to.lights.iter_mut().zip(&from.lights) {
        to.kind = from.kind;
    }
    to.nodes.clone_from(&from.nodes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::global::Global;
    use crate::host::{device, lighting};
    use crate::scene_options::SceneOptions;

    /// Follows until what was dropped is shown, or is refused.
    fn shown(stage: &mut Stage<'_>) -> Done {
        loop {
            let done = stage.follow(&mut Wish::default());
            if done.status.is_some() {
                return done;
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    }

    #[test]
    fn a_file_dropped_is_another_environment_or_another_scene() {
        let asset = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name);
        let global = Global { device: Some("cpu".to_owned()), validate: true, quiet: true, json: false };
        let (output, cache) = (Output::new(&global), tempfile::tempdir().unwrap());
        let mut options = SceneOptions::plain(&asset("mesh/ground.glb"), Some(&asset("env/sunrise_512.exr")));
        options.cache = cache.path().to_owned();
        let scene = options.load(&output).unwrap();
        let source = Source::of_scene(&scene, false, &options.cache, &output).unwrap();
        device::with(&global, &lighting::requirements(&source, &scene), |device| {
            let mut stage =
                Stage::new(device, scene, source, [32, 18], options.cache.clone(), output.clone())?;
            stage.take_file(&asset("env/courtyard_512.exr")).unwrap();
            let done = shown(&mut stage);
            assert!(done.anew && done.other && done.status.is_some_and(|status| status.is_ok()));
            let environment = stage.scene().environment.as_ref().unwrap();
            assert!(environment.file.ends_with("courtyard_512.exr"), "{:?}", environment.file);
            assert!(matches!(stage.source, Source::Relight(_)));

            let ground = stage.scene().meshes[0].hash;
            stage.take_file(&asset("mesh/spot.glb")).unwrap();
            assert!(shown(&mut stage).status.is_some_and(|status| status.is_ok()));
            assert!(stage.scene().meshes[0].hash != ground && stage.scene().environment.is_none());

            let refused = stage.take_file(&asset("PROVENANCE.md")).unwrap_err();
            assert!(refused.contains(".gltf"), "{refused}");
            assert!(stage.busy().is_none(), "nothing is loaded");
            Ok(())
        })
        .unwrap();
    }
}
