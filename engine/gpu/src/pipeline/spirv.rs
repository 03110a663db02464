//! The checks on SPIR-V that cost nothing: is it a whole module with the entry point asked for?

use crate::error::GpuError;
use crate::shared::Shared;
use ash::vk;

const MAGIC: u32 = 0x0723_0203;
const HEADER_WORDS: usize = 5;
const OP_ENTRY_POINT: u32 = 15;
const OP_EXECUTION_MODE: u32 = 16;
/// The execution mode that states the size of a workgroup.
const LOCAL_SIZE: u32 = 17;
/// SPIR-V 1.6, the newest that Vulkan 1.3 takes.
const NEWEST: u32 = 0x0001_0600;
/// The entry point's name, as glslang writes it and as literal words: "main" and a terminating zero.
const MAIN: [u32; 2] = [u32::from_le_bytes(*b"main"), 0];

/// Execution model of a stage in an `OpEntryPoint`.
fn execution_model(stage: vk::ShaderStageFlags) -> u32 {
    match stage {
        vk::ShaderStageFlags::VERTEX => 0,
        vk::ShaderStageFlags::FRAGMENT => 4,
        _ => 5,
    }
}

/// Checks the header, walks the instructions and looks for `main` of `stage`.
pub(crate) fn check(name: &str, words: &[u32], stage: vk::ShaderStageFlags) -> Result<(), GpuError> {
    let broken = |problem: &str| Err(GpuError::misuse(name, format!("{problem}; recompile the shader")));
    match words {
        [MAGIC, version, ..] if words.len() > HEADER_WORDS && *version <= NEWEST => {}
        [MAGIC, ..] => return broken("the SPIR-V is cut short or newer than 1.6"),
        _ => return broken("these words are not SPIR-V"),
    }
    let mut found = false;
    let mut rest = &words[HEADER_WORDS..];
    while let Some(&first) = rest.first() {
        let (length, opcode) = ((first >> 16) as usize, first & 0xffff);
        if length == 0 || length > rest.len() {
            return broken("the SPIR-V ends within an instruction");
        }
        if opcode == OP_ENTRY_POINT && length >= 5 {
            found |= rest[1] == execution_model(stage) && rest[3..5] == MAIN;
        }
        rest = &rest[length..];
    }
    if found { Ok(()) } else { broken(&format!("the SPIR-V has no entry point `main` for {stage:?}")) }
}

/// Invocations of a workgroup, as `local_size` states it; 0 where the module states none in plain numbers.
pub(crate) fn workgroup_invocations(words: &[u32]) -> u64 {
    let mut rest = words.get(HEADER_WORDS..).unwrap_or(&[]);
    while let Some(&first) = rest.first() {
        let (length, opcode) = ((first >> 16) as usize, first & 0xffff);
        match rest.get(..length) {
            Some([_, _, LOCAL_SIZE, x, y, z]) if opcode == OP_EXECUTION_MODE => {
                return u64::from(*x) * u64::from(*y) * u64::from(*z);
            }
            Some(instruction) if !instruction.is_empty() => rest = &rest[length..],
            _ => break,
        }
    }
    0
}

/// A shader module that lives for the making of one pipeline.
pub(crate) struct Module<'a> {
    shared: &'a Shared,
    raw: vk::ShaderModule,
    stage: vk::ShaderStageFlags,
}

impl<'a> Module<'a> {
    pub(crate) fn new(
        shared: &'a Shared,
        name: &str,
        words: &[u32],
        stage: vk::ShaderStageFlags,
    ) -> Result<Self, GpuError> {
        check(name, words, stage)?;
        let info = vk::ShaderModuleCreateInfo::default().code(words);
        // SAFETY: a live device and words with a SPIR-V header and whole instructions.
        let raw = unsafe { shared.device().create_shader_module(&info, None) }
            .map_err(GpuError::vulkan("vkCreateShaderModule"))?;
        Ok(Self { shared, raw, stage })
    }

    /// The stage, with entry point `main`.
    pub(crate) fn stage(&self) -> vk::PipelineShaderStageCreateInfo<'_> {
        vk::PipelineShaderStageCreateInfo::default().stage(self.stage).module(self.raw).name(c"main")
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines do not need the module once they are made.
        unsafe { self.shared.device().destroy_shader_module(self.raw, None) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A header and one `OpEntryPoint GLCompute %1 "main"`.
    fn module() -> Vec<u32> {
        vec![MAGIC, 0x0001_0300, 0, 2, 0, 5 << 16 | OP_ENTRY_POINT, 5, 1, MAIN[0], 0]
    }

    #[test]
    fn the_size_of_a_workgroup_is_read() {
        let mut words = module();
        assert_eq!(workgroup_invocations(&words), 0);
        words.extend([6 << 16 | OP_EXECUTION_MODE, 1, LOCAL_SIZE, 8, 4, 2]);
        assert_eq!(workgroup_invocations(&words), 64);
        words.pop();
        assert_eq!(workgroup_invocations(&words), 0, "a module that is cut short is not read past its end");
    }

    #[test]
    fn whole_modules_pass_and_broken_ones_are_named() {
        let compute = vk::ShaderStageFlags::COMPUTE;
        assert!(check("x", &module(), compute).is_ok());
        assert!(check("x", &module(), vk::ShaderStageFlags::VERTEX).is_err());
        for length in 0..module().len() {
            let error = check("cut.comp", &module()[..length], compute).unwrap_err().to_string();
            assert!(error.starts_with("cut.comp: "), "{error}");
        }
        let mut endless = module();
        endless[HEADER_WORDS] = OP_ENTRY_POINT;
        assert!(check("x", &endless, compute).is_err());
    }
}
