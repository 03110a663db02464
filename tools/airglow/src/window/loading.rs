//! What takes long, done beside the frames: reading files and baking light transport.

use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::Instant;

use airglow_scene::{Environment, Scene};

use super::wish::Wish;
use crate::failure::{Failure, Outcome};
use crate::host::source::Source;
use crate::output::Output;
use crate::scene_options::SceneOptions;

/// What is loaded.
#[derive(Clone, Debug)]
pub enum Load {
    /// Another scene, from a scene file or a glTF file.
    Scene(PathBuf),
    /// Another environment for the scene there is, from a picture.
    Environment(PathBuf),
    /// The same scene with light transport of another quality.
    Quality(Box<Wish>),
}

/// What was loaded.
pub struct Loaded {
    /// Another scene; `None` for the same.
    pub scene: Option<Scene>,
    /// What lights it.
    pub source: Source,
    /// What was asked of the same scene.
    pub wish: Option<Wish>,
}

/// A thread that loads.
pub struct Loading {
    words: String,
    start: Instant,
    output: Output,
    thread: JoinHandle<Outcome<Loaded>>,
}

impl Load {
    /// What a file that was dropped onto the window is.
    pub fn of_file(path: &Path) -> Result<Self, String> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("toml" | "gltf" | "glb") => Ok(Self::Scene(path.to_owned())),
            Some("hdr" | "exr") => Ok(Self::Environment(path.to_owned())),
            _ => Err(format!(
                "{}: drop a scene (.toml, .gltf, .glb) or an environment (.hdr, .exr)",
                path.display()
            )),
        }
    }

    fn words(&self) -> String {
        match self {
            Self::Scene(path) | Self::Environment(path) => format!("loading {}", path.display()),
            Self::Quality(_) => "baking light transport".to_owned(),
        }
    }

    fn run(self, scene: Scene, cache: &Path, output: &Output) -> Outcome<Loaded> {
        let baked = |scene: &Scene| Source::of_scene(scene, false, cache, output);
        match self {
            Self::Scene(path) => {
                let scene = SceneOptions::plain(&path, None).load(output)?;
                Ok(Loaded { source: baked(&scene)?, scene: Some(scene), wish: None })
            }
            Self::Environment(path) => {
                let environment = airglow_scene::image_io::read_environment(&path).map_err(Failure::input)?;
                let distance = scene.environment.as_ref().and_then(|stated| stated.distance);
                let environment = Some(Environment { distance, ..environment });
                let scene = Scene { environment, ..scene };
                Ok(Loaded { source: baked(&scene)?, scene: Some(scene), wish: None })
            }
            Self::Quality(wish) => {
                let source = baked(&wish.apply(&scene))?;
                Ok(Loaded { source, scene: None, wish: Some(*wish) })
            }
        }
    }
}

impl Loading {
    /// Starts to load; `scene` is the one there is.
    pub fn start(load: Load, scene: Scene, cache: PathBuf, output: &Output) -> Self {
        let (words, output) = (load.words(), output.watched());
        let told = output.clone();
        let thread = std::thread::spawn(move || load.run(scene, &cache, &told));
        Self { words, start: Instant::now(), output, thread }
    }

    /// Whether it is done.
    pub fn is_finished(&self) -> bool {
        self.thread.is_finished()
    }

    /// What is done, and how far it is where that is known.
    pub fn told(&self) -> (String, Option<f32>) {
        (format!("{}, {:.0} s", self.words, self.start.elapsed().as_secs_f64()), self.output.watch())
    }

    /// What was done, in words.
    pub fn done_words(&self) -> String {
        format!("{}: done in {:.1} s", self.words, self.start.elapsed().as_secs_f64())
    }

    /// What was loaded.
    pub fn finish(self) -> Outcome<Loaded> {
        self.thread.join().unwrap_or_else(|_| Err(Failure::work(format!("{}: it broke off", self.words))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_apart_by_their_names() {
        let of = |name: &str| Load::of_file(Path::new(name));
        assert!(matches!(of("a/b.GLB"), Ok(Load::Scene(_))));
        assert!(matches!(of("c.hdr"), Ok(Load::Environment(_))));
        let refused = of("d.png").unwrap_err();
        assert!(refused.contains("d.png") && refused.contains(".gltf"), "{refused}");
    }
}
