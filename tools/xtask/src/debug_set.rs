//! `xtask shaders --debug-set`: modules with source and lines, for frame captures.
//!
//! The vendored compiler's safe interface writes no debug info, so this set, which is never shipped, is made by
//! the `glslangValidator` program (Debian: glslang-tools).

use std::path::Path;
use std::process::Command;

use crate::error::Error;
use crate::manifest::Module;

/// Writes every module with debug info below `folder`, under the names of the shipped set.
///
/// # Errors
/// `glslangValidator` is not installed, or refuses a module.
pub fn write(glsl: &Path, folder: &Path, modules: &[Module]) -> Result<(), Error> {
    for module in modules {
        let output = folder.join(&module.output);
        let parent = output.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(|source| Error::io(parent, source))?;
        let mut include = std::ffi::OsString::from("-I");
        include.push(glsl);
        let result = Command::new("glslangValidator")
            .args(["-g", "--quiet", "--target-env", "vulkan1.1"])
            .args(module.defines.iter().map(|(name, value)| format!("-D{name}={value}")))
            .arg(include)
            .arg("-o")
            .arg(&output)
            .arg(glsl.join(&module.file))
            .output()
            .map_err(|error| {
                Error::DebugSet(format!("glslangValidator (package glslang-tools) does not start: {error}"))
            })?;
        if !result.status.success() {
            let log = String::from_utf8_lossy(&result.stdout).into_owned();
            return Err(Error::Compile { module: module.output.display().to_string(), log });
        }
    }
    println!("{} modules with debug info in {}", modules.len(), folder.display());
    Ok(())
}
