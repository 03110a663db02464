//! GLSL to SPIR-V with the vendored glslang: Vulkan 1.1, SPIR-V 1.3, no debug info, no optimiser.

use std::path::{Component, Path};

use glslang::error::GlslangError;
use glslang::include::{IncludeHandler, IncludeResult, IncludeType};
use glslang::{
    Compiler, CompilerOptions, Shader, ShaderInput, ShaderMessage, ShaderSource, ShaderStage, SourceLanguage,
    SpirvVersion, Target, VulkanVersion,
};

use crate::error::Error;
use crate::manifest::Module;

/// Compiles one module of the manifest whose sources lie under `root`.
///
/// # Errors
/// A missing source, and GLSL that glslang refuses, with `file:line` of each message.
pub fn module(root: &Path, module: &Module) -> Result<Vec<u32>, Error> {
    let path = root.join(&module.file);
    let text = std::fs::read_to_string(&path).map_err(|source| Error::io(&path, source))?;
    source(root, &module.file, &text, module.stage, &module.defines)
        .map_err(|log| Error::Compile { module: module.output.display().to_string(), log })
}

/// Compiles source text; `file` is its path under `root` and only names it in messages.
///
/// # Errors
/// The compiler's log, one message a line, each with `file:line`.
pub fn source(
    root: &Path,
    file: &Path,
    text: &str,
    stage: ShaderStage,
    defines: &[(String, String)],
) -> Result<Vec<u32>, String> {
    if text.contains('\0') {
        return Err(format!("{}: the file holds a NUL byte, so it is not GLSL", file.display()));
    }
    let compiler = Compiler::acquire().ok_or("glslang could not be initialised")?;
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_1, spirv_version: SpirvVersion::SPIRV1_3 },
        version_profile: None,
        messages: ShaderMessage::DEFAULT,
    };
    let defines: Vec<(&str, Option<&str>)> =
        defines.iter().map(|(name, value)| (name.as_str(), Some(value.as_str()))).collect();
    let mut includes = Includes { root };
    let text = ShaderSource::from(text);
    let explain = |error: GlslangError| explain(file, &error);
    let input = ShaderInput::new(&text, stage, &options, Some(defines.as_slice()), Some(&mut includes))
        .map_err(explain)?;
    Shader::new(compiler, input).parse().and_then(|shader| shader.compile()).map_err(explain)
}

/// Resolves `#include "room/file.glsl"` against the one root, never against the including file.
struct Includes<'a> {
    root: &'a Path,
}

impl IncludeHandler for Includes<'_> {
    fn include(&mut self, _: IncludeType, header: &str, _: &str, _: usize) -> Option<IncludeResult> {
        let inside = Path::new(header).components().all(|part| matches!(part, Component::Normal(_)));
        let data = inside.then(|| std::fs::read_to_string(self.root.join(header)).ok())??;
        (!data.contains('\0')).then(|| IncludeResult { name: header.to_owned(), data })
    }
}

/// Rewrites glslang's `ERROR: 0:12: …`, where 0 is the unnamed main source, as `file:12: error: …`.
fn explain(file: &Path, error: &GlslangError) -> String {
    let log = match error {
        GlslangError::PreprocessError(log)
        | GlslangError::ParseError(log)
        | GlslangError::MapIoError(log)
        | GlslangError::LinkError(log) => &log.log,
        other => return format!("{}: {other}", file.display()),
    };
    let lines = log.lines().filter(|line| !line.trim().is_empty()).filter_map(|line| {
        let Some((kind, rest)) = ["ERROR", "WARNING"]
            .into_iter()
            .find_map(|kind| Some((kind, line.strip_prefix(kind)?.strip_prefix(": ")?)))
        else {
            return Some(line.to_owned());
        };
        if rest.ends_with("compilation errors.  No code generated.") {
            return None;
        }
        let rest =
            rest.strip_prefix("0:").map_or(rest.to_owned(), |rest| format!("{}:{rest}", file.display()));
        let position = rest.find(": ").unwrap_or(0);
        let (place, message) = rest.split_at(position);
        Some(format!("{place}: {}{message}", kind.to_lowercase()))
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compile(text: &str, defines: &[(String, String)]) -> Result<Vec<u32>, String> {
        source(&crate::shader_root(), Path::new("room/test.comp"), text, ShaderStage::Compute, defines)
    }

    #[test]
    fn the_module_is_spirv_1_3() {
        let words = compile("#version 460\nlayout(local_size_x = 64) in;\nvoid main() {}\n", &[]).unwrap();
        assert_eq!(words[0], 0x0723_0203, "magic number");
        assert_eq!(words[1], 0x0001_0300, "version");
    }

    #[test]
    fn an_error_names_file_and_line() {
        let text = "#version 460\nlayout(local_size_x = 64) in;\nvoid main() {\n    float x = nothing;\n}\n";
        let log = compile(text, &[]).unwrap_err();
        assert!(log.starts_with("room/test.comp:4: error: "), "{log}");
    }

    #[test]
    fn an_include_outside_the_root_is_refused() {
        let include =
            "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"../x.glsl\"\n";
        let log = compile(include, &[]).unwrap_err();
        assert!(log.contains("room/test.comp:3") && log.contains("../x.glsl"), "{log}");
    }
}
