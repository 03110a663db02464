//! Command lines that run one extreme input again.

use std::path::Path;

use airglow::relight::stability::Reproduce;
use airglow_scene::FloatImage;
use airglow_scene::image_io::write_exr;

use crate::failure::{Failure, Outcome};

/// How command lines that run an input again are made.
pub(super) struct Again<'a> {
    /// Where environments are written.
    pub folder: &'a Path,
    /// `--device`, if it was given.
    pub device: &'a Option<String>,
}

impl Again<'_> {
    /// The command lines for `case`; an environment is written to a file named after `file`.
    pub fn command(&self, case: &str, file: &str, reproduce: &Reproduce) -> Outcome<String> {
        let device =
            self.device.as_ref().map_or_else(String::new, |name| format!(" --device {}", quoted(name)));
        let eval = |name: &str, lines: &str, more: &str| {
            let lines = lines.replace('\n', "\\n");
            let files = "--in rows.csv --out results.csv --reference";
            format!("printf '{lines}\\n' > rows.csv\nairglow eval {name} {files}{more}{device}")
        };
        Ok(match reproduce {
            Reproduce::Row { evaluator, lines } => eval(evaluator, lines, ""),
            Reproduce::Environment { order, map } => {
                let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
                let path = self.folder.join(format!("{}.exr", file.chars().map(letter).collect::<String>()));
                std::fs::create_dir_all(self.folder.join("."))
                    .map_err(|error| Failure::file(self.folder, "making the folder", error))?;
                let (width, height) = (map.width as usize, map.height as usize);
                let image = FloatImage { width, height, pixels: map.rgb.clone() };
                write_exr(&path, &image).map_err(Failure::work)?;
                let image = format!(" --set {}", quoted(&format!("image={}", path.display())));
                eval("environment-sh", &format!("order\n{order}"), &image)
            }
            Reproduce::Case => format!("airglow stability relight --case {}{device}", quoted(case)),
        })
    }
}

/// One word for a shell.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}
