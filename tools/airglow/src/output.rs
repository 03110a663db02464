//! Where results, remarks and progress go: results to standard output, everything else to standard error.

use std::io::{ErrorKind, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

use crate::failure::{Failure, Outcome};
use crate::global::Global;

/// Prints a result. A reader that has seen enough and closed the pipe (`| head`) is no failure.
pub fn print(text: &str) -> Outcome {
    match writeln!(std::io::stdout(), "{}", text.trim_end()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::work(format!("standard output: {error}; free the disk or redirect elsewhere")))
        }
        _ => Ok(()),
    }
}

/// Prints a line for whoever watches. Where nobody does any more (`2>&1 | head`), work goes on.
fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// How the user wants to be told things.
#[derive(Clone, Debug)]
pub struct Output {
    quiet: bool,
    json: bool,
    /// The bar of progress made last, where somebody watches it.
    watched: Option<Arc<Mutex<Option<ProgressBar>>>>,
}

impl Output {
    /// Reads `--quiet` and `--json`.
    pub fn new(global: &Global) -> Self {
        Self { quiet: global.quiet, json: global.json, watched: None }
    }

    /// Whether results are to be printed as JSON.
    pub fn json(&self) -> bool {
        self.json
    }

    /// A remark on standard error; silent with `--quiet`.
    pub fn say(&self, remark: impl AsRef<str>) {
        if !self.quiet {
            tell(remark.as_ref());
        }
    }

    /// A warning on standard error, printed even with `--quiet`.
    pub fn warn(&self, warning: impl AsRef<str>) {
        tell(&format!("warning: {}", warning.as_ref()));
    }

    /// The result: `value` as JSON with `--json`, else what `text` makes of it.
    pub fn result<T: Serialize>(&self, value: &T, text: impl FnOnce(&T) -> String) -> Outcome {
        if self.json {
            let json = serde_json::to_string_pretty(value)
                .map_err(|error| Failure::work(format!("could not write the result as JSON: {error}")))?;
            print(&json)
        } else {
            print(&text(value))
        }
    }

    /// The failure that ends the command.
    pub fn failure(&self, failure: &Failure) {
        if self.json {
            let value = serde_json::json!({ "error": failure.to_string(), "kind": failure.kind_name() });
            // What could not be printed is told below all the same.
            let _ = print(&value.to_string());
        }
        tell(&format!("error: {failure}"));
    }

    /// The same with bars that are not printed but told by [`Output::watch`]; and no remarks.
    #[cfg(feature = "view")]
    #[must_use]
    pub fn watched(&self) -> Self {
        Self { quiet: true, json: self.json, watched: Some(Arc::default()) }
    }

    /// How far the bar made last is, 0 to 1.
    #[cfg(feature = "view")]
    pub fn watch(&self) -> Option<f32> {
        let bar = self.watched.as_ref()?.lock().unwrap_or_else(PoisonError::into_inner).clone()?;
        let length = bar.length().filter(|length| *length > 0)?;
        Some((bar.position() as f32 / length as f32).min(1.0))
    }

    /// A progress bar over `length` steps of `unit`; hidden with `--quiet` and when standard error is no
    /// terminal.
    pub fn progress(&self, what: &str, length: u64, unit: &str) -> ProgressBar {
        if let Some(watched) = &self.watched {
            let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
            *watched.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.clone());
            return bar;
        }
        if self.quiet {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::new(length);
        let template =
            format!("{{msg:24}} {{bar:32}} {{human_pos}}/{{human_len}} {unit} {{per_sec}} {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        bar.set_message(what.to_owned());
        bar.enable_steady_tick(Duration::from_millis(200));
        bar
    }
}
