//! Every kernel's bindings, push constants and workgroup as stated in Rust, against reflection of its module.

use airglow_gpu::ash::vk::ShaderStageFlags;
use airglow_gpu::requirements::Limit;
use airglow_gpu::{Missing, Offer};
use airglow_relight::rivals::Task;
use airglow_relight::{LightKind, Output, Relight, Settings, kernels, rivals};
use airglow_tests::reflect::Module;

#[test]
fn every_module_declares_what_is_stated() {
    let kernels = kernels::all();
    assert_eq!(kernels.len(), 6 * (6 + 4 * 6 + 2 * 6), "kernels in the room");
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

/// A device that has room for so many storage buffers in a stage, and else all there is.
#[test]
fn a_device_with_too_few_descriptors_is_told_so() {
    let lacking = |room: u64, settings: &Settings| {
        let limits = Limit::ALL.iter().map(|&limit| match limit {
            Limit::PerStageStorageBuffers => (limit, room),
            _ => (limit, 1 << 30),
        });
        let offer = Offer { limits: limits.collect(), ..Offer::default() };
        let missing = Relight::requirements(settings).check(&offer);
        let needed = missing.into_iter().filter_map(|missing| match missing {
            Missing::Limit { need, .. } => Some((need.limit, need.at_least)),
            _ => None,
        });
        needed.collect::<Vec<_>>()
    };
    let settings = Settings::default();
    assert_eq!(lacking(3, &settings), []);
    assert_eq!(lacking(2, &settings), [(Limit::PerStageStorageBuffers, 3)]);
    // Light of each vertex and the tensor beside vectors and results; visibility is one more.
    let vertex = Settings { light: LightKind::Vertex, visibility: true, ..settings };
    let incident = Settings { output: Output::Incident, visibility: false, ..vertex };
    for (settings, needed) in [(vertex, 5), (incident, 4)] {
        assert_eq!(lacking(needed - 1, &settings), [(Limit::PerStageStorageBuffers, needed)]);
        assert_eq!(lacking(needed, &settings), []);
    }
    // What has no kernel asks for none.
    assert_eq!(lacking(0, &Settings { order: 0, ..settings }), []);
}
