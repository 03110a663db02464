//! `airglow spheres`: the spheres that stand for a mesh where it casts shadows.

use std::path::{Path, PathBuf};

use airglow::shadow::spheres::{FitSettings, SphereSet};
use airglow_scene::Mesh;
use clap::Args;
use serde::Serialize;

use crate::failure::{Failure, Outcome};
use crate::files;
use crate::host::sphere_mesh;
use crate::host::spheres::{SphereFile, fitted};
use crate::output::Output;

/// Spheres that a fit makes at most.
const MOST: usize = 1024;

/// Fit spheres to the meshes of a file: as few as an error needs, or so many.
///
/// Spheres hold all of the mesh; what of them lies outside is the error, as a share of the mesh's own volume. A .json file
/// has centre and radius of each, and the sphere of each vertex; a .obj or .glb file has them as triangles, to be looked at
/// beside the mesh.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow spheres assets/mesh/walker.glb -o walker.json
  airglow spheres assets/mesh/walker.glb --count 120 -o walker.json -o walker-spheres.glb
  airglow spheres assets/mesh/spot.glb --error 0.5 -o spot.obj")]
pub struct Arguments {
    /// A glTF file (.glb, .gltf).
    mesh: PathBuf,
    /// Where the spheres go: .json, .obj or .glb. May be given several times.
    #[arg(long, short = 'o', value_name = "FILE", required = true)]
    output: Vec<PathBuf>,
    /// Spheres of each mesh of the file.
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=MOST as i64))]
    count: u32,
    /// As few spheres as leave no more than this share of the mesh's volume outside, what several share counted for each.
    #[arg(long, value_name = "SHARE", conflicts_with = "count")]
    error: Option<f64>,
    /// Cells along the longest side of the grid that volumes are counted on.
    #[arg(long, default_value_t = 48, value_parser = clap::value_parser!(u32).range(8..=128))]
    resolution: u32,
}

/// What was fitted.
#[derive(Serialize)]
struct Fitted {
    mesh: String,
    triangles: usize,
    spheres: usize,
    /// Cubic metres.
    volume: f64,
    /// Cubic metres of the spheres outside, what several share counted for each.
    outside: f64,
    seconds: f64,
}

/// Runs the command.
pub fn run(arguments: &Arguments, output: &Output) -> Outcome {
    arguments.output.iter().try_for_each(|path| kind(path).map(|_| ()))?;
    let scene = airglow_scene::load(&arguments.mesh).map_err(Failure::input)?;
    if scene.meshes.is_empty() {
        return Err(Failure::input(format!("{}: it has no mesh", arguments.mesh.display())));
    }
    let (mut fits, mut written) = (Vec::new(), Vec::new());
    for mesh in &scene.meshes {
        let begin = std::time::Instant::now();
        let (settings, set) = arguments.fit(mesh, output)?;
        fits.push(Fitted {
            mesh: mesh.name.clone(),
            triangles: mesh.triangle_count(),
            spheres: set.spheres.len(),
            volume: set.volume,
            outside: set.outside,
            seconds: begin.elapsed().as_secs_f64(),
        });
        written.push(SphereFile::new(mesh, &settings, &set));
    }
    for path in &arguments.output {
        let spheres = || written.iter().flat_map(|file| file.spheres.iter().copied()).collect::<Vec<_>>();
        let bytes = match kind(path)? {
            Kind::Json => serde_json::to_vec_pretty(&written).map_err(Failure::work)?,
            Kind::Obj => sphere_mesh::obj(&spheres()).into_bytes(),
            Kind::Glb => sphere_mesh::glb(&spheres())?,
        };
        files::write(path, &bytes)?;
        output.say(format!("wrote {}", path.display()));
    }
    output.result(&fits, |fits| fits.iter().map(Fitted::line).collect())
}

#[derive(Clone, Copy)]
enum Kind {
    Json,
    Obj,
    Glb,
}

fn kind(path: &Path) -> Outcome<Kind> {
    match path.extension().and_then(|kind| kind.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("json") => Ok(Kind::Json),
        Some("obj") => Ok(Kind::Obj),
        Some("glb") => Ok(Kind::Glb),
        _ => Err(Failure::usage(format!("{}: name a .json, .obj or .glb file", path.display()))),
    }
}

impl Arguments {
    fn fit(&self, mesh: &Mesh, output: &Output) -> Outcome<(FitSettings, SphereSet)> {
        let of = |spheres: usize| {
            let settings =
                FitSettings { spheres, resolution: self.resolution as usize, ..FitSettings::default() };
            fitted(mesh, &settings, output).map(|set| (settings, set))
        };
        match self.error {
            None => of(self.count as usize),
            Some(error) if error > 0.0 && error.is_finite() => fewest(&mesh.name, error, of),
            Some(error) => {
                Err(Failure::usage(format!("--error is {error}; expected a positive share, such as 0.5")))
            }
        }
    }
}

/// Doubles the number until the error is met, then halves the interval to the fewest that met it.
fn fewest(
    name: &str,
    error: f64,
    fit: impl Fn(usize) -> Outcome<(FitSettings, SphereSet)>,
) -> Outcome<(FitSettings, SphereSet)> {
    let (mut below, mut count) = (0, 1);
    let mut best = loop {
        let found = fit(count)?;
        let share = found.1.outside / found.1.volume;
        if found.1.volume <= 0.0 {
            let mend = "close its holes, or give --count";
            return Err(Failure::input(format!("{name}: it has no inside to measure an error by; {mend}")));
        }
        if share <= error {
            break found;
        }
        if count == MOST {
            let problem = format!("{MOST} spheres leave {share:.2} of its volume outside");
            return Err(Failure::input(format!("{name}: {problem}; allow a larger --error")));
        }
        (below, count) = (count, (2 * count).min(MOST));
    };
    while count - below > 1 {
        let middle = below.midpoint(count);
        let found = fit(middle)?;
        if found.1.outside <= error * found.1.volume {
            (count, best) = (middle, found);
        } else {
            below = middle;
        }
    }
    Ok(best)
}

impl Fitted {
    fn line(&self) -> String {
        let Self { mesh, triangles, spheres, volume, outside, seconds } = self;
        format!(
            "{mesh}: {triangles} triangles, {spheres} spheres, {outside:.4} m3 outside of {volume:.4} m3, {seconds:.1} s\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fewest_spheres_that_meet_an_error_are_found() {
        let fit = |spheres: usize| {
            let set = SphereSet {
                spheres: Vec::new(),
                assignment: Vec::new(),
                outside: 10.0 / spheres as f64,
                volume: 1.0,
            };
            Ok((FitSettings { spheres, ..FitSettings::default() }, set))
        };
        let found = |error| fewest("a mesh", error, fit).map(|(settings, _)| settings.spheres);
        assert_eq!((found(10.0).unwrap(), found(0.5).unwrap(), found(0.19).unwrap()), (1, 20, 53));
        assert!(found(1e-4).unwrap_err().to_string().contains("larger --error"));
    }
}
