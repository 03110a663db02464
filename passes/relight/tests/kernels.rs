//! Every kernel's bindings, push constants and workgroup as stated in Rust, against reflection of its module.

use airglow_gpu::ash::vk::ShaderStageFlags;
use airglow_relight::rivals::Task;
use airglow_relight::{kernels, rivals};
use airglow_tests::reflect::Module;

#[test]
fn every_module_declares_what_is_stated() {
    let kernels = kernels::all();
    assert_eq!(kernels.len(), 6 * (5 + 4 * 6 + 2 * 6), "kernels in the room");
    for kernel in kernels {
        let module = Module::read(kernel.spirv).unwrap_or_else(|error| panic!("{}: {error}", kernel.name));
        module.assert_bindings(&kernel.binding_descs());
        let size = module.push_constants.as_ref().map_or(0, |block| block.size);
        assert_eq!(size, kernel.push_constant_size, "push constants of {}", kernel.name);
        for (i, member) in module.push_constants.iter().flat_map(|block| &block.members).enumerate() {
            assert_eq!(member.offset as usize, 4 * i, "{} of {}", member.name, kernel.name);
        }
        assert!(module.shared_bytes <= 32 << 10, "{} shares {} bytes", kernel.name, module.shared_bytes);
        if module.stage == ShaderStageFlags::COMPUTE && !kernel.name.starts_with("relight environment") {
            assert_eq!(module.workgroup, [kernels::WORKGROUP, 1, 1], "{}", kernel.name);
        }
    }
}

#[test]
fn every_rival_declares_what_is_stated() {
    for rival in rivals::all().iter().filter(|rival| rival.task != Task::Copy) {
        let module = Module::read(rival.spirv()).unwrap_or_else(|error| panic!("{}: {error}", rival.name()));
        module.assert_bindings(&rival.bindings());
        assert_eq!(module.workgroup, [rival.workgroup, 1, 1], "{}", rival.name());
    }
}
