//! One SPIR-V module through naga to WGSL, HLSL and MSL; what stands in the way is a sentence, and so is a panic.

use std::panic::{AssertUnwindSafe, catch_unwind};

use naga::back::{hlsl, msl, wgsl};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, Module};

/// What shipped shaders may ask of naga beyond the portable core: push constants, and halves in 32-bit words.
const CAPABILITIES: Capabilities = Capabilities::IMMEDIATES
    .union(Capabilities::SHADER_FLOAT16_IN_FLOAT32)
    .union(Capabilities::CLIP_DISTANCES);

/// The languages, in the order of [`translate`]'s answers. Their versions are those of [`to_hlsl`] and [`to_msl`].
pub const LANGUAGES: [&str; 3] = ["WGSL", "HLSL 6.0", "MSL 2.4"];

type Writer = fn(&Module, &ModuleInfo) -> Result<(), String>;

/// For each language `yes`, with what it needs beyond the language's core, or why not.
pub fn translate(spirv: &[u8]) -> [String; 3] {
    match caught(|| read(spirv)) {
        Ok((module, info)) => {
            let writers: [Writer; 3] = [to_wgsl, to_hlsl, to_msl];
            let answers = writers.map(|write| caught(|| write(&module, &info)));
            let [wgsl, hlsl, msl] = answers.map(|answer| answer.map_or_else(no, |()| "yes".to_owned()));
            // WGSL has push constants as an extension of implementations that are not browsers.
            let pushes =
                module.global_variables.iter().any(|(_, global)| global.space == AddressSpace::Immediate);
            [if pushes && wgsl == "yes" { "yes, with `var<immediate>`".to_owned() } else { wgsl }, hlsl, msl]
        }
        Err(why) => [(); 3].map(|()| no(why.clone())),
    }
}

fn no(why: String) -> String {
    format!("no: {why}")
}

/// A panic of naga's is an answer like any other.
fn caught<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Err(format!("naga panics: {text}"))
    })
}

fn read(spirv: &[u8]) -> Result<(Module, ModuleInfo), String> {
    let options = naga::front::spv::Options { adjust_coordinate_space: false, ..Default::default() };
    let module = naga::front::spv::parse_u8_slice(spirv, &options).map_err(|error| error.to_string())?;
    let info = Validator::new(ValidationFlags::all(), CAPABILITIES)
        .validate(&module)
        .map_err(|error| error.into_inner().to_string())?;
    Ok((module, info))
}

fn to_wgsl(module: &Module, info: &ModuleInfo) -> Result<(), String> {
    let text = wgsl::write_string(module, info, wgsl::WriterFlags::empty());
    text.map(|_| ()).map_err(|error| error.to_string())
}

fn to_hlsl(module: &Module, info: &ModuleInfo) -> Result<(), String> {
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V6_0,
        // Push constants become root constants; naga panics when they have no register.
        immediates_target: Some(hlsl::BindTarget { space: 1, ..Default::default() }),
        ..Default::default()
    };
    let pipeline = hlsl::PipelineOptions::default();
    let mut text = String::new();
    let written = hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None);
    entries(written.map_err(|error| error.to_string())?.entry_point_names)
}

fn to_msl(module: &Module, info: &ModuleInfo) -> Result<(), String> {
    let options = msl::Options { lang_version: (2, 4), ..Default::default() };
    let written = msl::write_string(module, info, &options, &msl::PipelineOptions::default());
    entries(written.map_err(|error| error.to_string())?.1.entry_point_names)
}

/// The first entry point that could not be written.
fn entries<E: std::fmt::Display>(names: Vec<Result<String, E>>) -> Result<(), String> {
    names.into_iter().try_for_each(|name| name.map(|_| ()).map_err(|error| error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glslang::ShaderStage;
    use std::path::Path;

    fn answers(body: &str) -> [String; 3] {
        let text = format!("#version 460\nlayout(local_size_x = 64) in;\n{body}");
        let words = crate::compile::source(
            &crate::shader_root(),
            Path::new("x.comp"),
            &text,
            ShaderStage::Compute,
            &[],
        );
        translate(&words.unwrap().iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>())
    }

    #[test]
    fn a_plain_shader_translates_to_all_three() {
        assert_eq!(
            answers("shared float x[64];\nvoid main() { x[gl_LocalInvocationIndex] = 1.0; }"),
            ["yes"; 3]
        );
    }

    #[test]
    fn push_constants_are_named_as_what_wgsl_needs() {
        let body = "layout(push_constant) uniform P { float x; } p;\n\
                    layout(std430, binding = 0) buffer B { float y[]; };\nvoid main() { y[0] = p.x; }";
        assert_eq!(answers(body), ["yes, with `var<immediate>`", "yes", "yes"]);
    }

    #[test]
    fn what_naga_cannot_read_is_no_everywhere_with_the_reason() {
        let body = "layout(binding = 0) uniform sampler2D both;\n\
                    layout(std430, binding = 1) buffer B { vec4 x[]; };\n\
                    void main() { x[0] = textureLod(both, vec2(0.5), 0.0); }";
        for answer in answers(body).into_iter().chain(translate(&[1, 2, 3])) {
            assert!(answer.starts_with("no: ") && answer.len() > 8, "{answer}");
        }
        assert_eq!(caught::<()>(|| panic!("here")), Err("naga panics: here".to_owned()));
    }
}
