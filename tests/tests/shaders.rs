//! The gate of the committed shaders, without a GPU: naga reads and validates every module, a second reader agrees
//! on the bindings, and each stays inside the baseline limits.

#![expect(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail the test they are called from")]

use std::path::{Path, PathBuf};

use airglow_tests::host_layout;
use airglow_tests::reflect::{Module, spirv_root};
use ash::vk;
use spirq::prelude::{DescriptorType, ReflectConfig, Variable};

/// Modules that naga cannot read, by path below `shaders/spirv`, each with the reason; spirq alone reads them.
const BEYOND_NAGA: &[(&str, &str)] = &[];

/// Vulkan's smallest maximum of push-constant bytes.
const PUSH_CONSTANT_BYTES: u32 = 128;
/// Shared memory that every device we name offers.
const SHARED_BYTES: u32 = 32 << 10;
/// Workgroup invocations that every device we name offers.
const WORKGROUP_INVOCATIONS: u32 = 256;

fn modules() -> Vec<(PathBuf, Vec<u8>)> {
    let mut modules = Vec::new();
    let mut folders = vec![spirv_root()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "spv") {
                let bytes = std::fs::read(&path).unwrap();
                modules.push((path.strip_prefix(spirv_root()).unwrap().to_owned(), bytes));
            }
        }
    }
    modules.sort();
    assert!(!modules.is_empty(), "no module in shaders/spirv; run `cargo run -p xtask -- shaders`");
    modules
}

fn is_beyond_naga(path: &Path) -> bool {
    BEYOND_NAGA.iter().any(|(name, _)| path == Path::new(name))
}

/// Set, binding and type of each resource, as spirq reads them.
fn signature_by_spirq(bytes: &[u8]) -> Vec<(u32, u32, vk::DescriptorType)> {
    let entries = ReflectConfig::new().spv(bytes).ref_all_rscs(true).reflect().unwrap();
    assert_eq!(entries.len(), 1, "entry points");
    let mut signature: Vec<_> = entries[0]
        .vars
        .iter()
        .filter_map(|variable| match variable {
            Variable::Descriptor { desc_bind, desc_ty, .. } => {
                let kind = match desc_ty {
                    DescriptorType::Sampler() => vk::DescriptorType::SAMPLER,
                    DescriptorType::SampledImage() => vk::DescriptorType::SAMPLED_IMAGE,
                    DescriptorType::StorageImage(_) => vk::DescriptorType::STORAGE_IMAGE,
                    DescriptorType::UniformBuffer() => vk::DescriptorType::UNIFORM_BUFFER,
                    DescriptorType::StorageBuffer(_) => vk::DescriptorType::STORAGE_BUFFER,
                    other => panic!("{other:?} is outside the shader rules"),
                };
                Some((desc_bind.set(), desc_bind.bind(), kind))
            }
            _ => None,
        })
        .collect();
    signature.sort();
    signature
}

#[test]
fn naga_reads_every_module_and_spirq_agrees() {
    let modules = modules();
    let mut failures = Vec::new();
    for (path, bytes) in &modules {
        let by_spirq = signature_by_spirq(bytes);
        match Module::read(bytes) {
            Ok(_) if is_beyond_naga(path) => failures.push(format!("{}: naga reads it now", path.display())),
            Ok(module) if module.signature() != by_spirq => {
                let by_naga = module.signature();
                failures.push(format!("{}: naga {by_naga:?}, spirq {by_spirq:?}", path.display()));
            }
            Err(error) if !is_beyond_naga(path) => failures.push(format!("{}: {error}", path.display())),
            _ => {}
        }
    }
    println!("{} modules, {} of them beyond naga", modules.len(), BEYOND_NAGA.len());
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn every_module_is_within_the_baseline_limits() {
    for (path, bytes) in modules() {
        let Ok(module) = Module::read(&bytes) else { continue }; // the test above reports it
        let path = path.display();
        let push = module.push_constants.as_ref().map_or(0, |block| block.size);
        assert!(push <= PUSH_CONSTANT_BYTES, "{path}: {push} bytes of push constants");
        assert!(module.shared_bytes <= SHARED_BYTES, "{path}: {} bytes shared", module.shared_bytes);
        if module.stage == vk::ShaderStageFlags::COMPUTE {
            let invocations: u32 = module.workgroup.iter().product();
            assert!((1..=WORKGROUP_INVOCATIONS).contains(&invocations), "{path}: {:?}", module.workgroup);
        }
    }
}

#[test]
fn the_shipped_set_is_spirv_1_3_without_debug_info() {
    const STRING: u32 = 7; // OpString, which OpSource and OpLine need to name a file
    const LINE: u32 = 8;
    for (path, bytes) in modules() {
        let words: Vec<u32> =
            bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
        assert_eq!(words[..2], [0x0723_0203, 0x0001_0300], "{}: magic number and version", path.display());
        let mut at = 5;
        while at < words.len() {
            let (opcode, length) = (words[at] & 0xffff, (words[at] >> 16) as usize);
            assert!(length > 0, "{}: word {at} is no instruction", path.display());
            assert!(![STRING, LINE].contains(&opcode), "{}: debug info at word {at}", path.display());
            at += length;
        }
    }
}

#[test]
fn a_host_struct_that_drifted_is_named() {
    use airglow_tests::reflect::{Block, Member};
    #[repr(C)]
    struct Host {
        origin: [f32; 4],
        count: u32,
        extra: u32,
    }
    let member = |name: &str, offset| Member { name: name.to_owned(), offset, block: None };
    let block = |members: Vec<Member>, size| Block { name: "Shader".to_owned(), size, members };
    let host = host_layout!(Host { origin, count, extra });
    let same = block(vec![member("origin", 0), member("count", 16), member("extra", 20)], 24);
    assert_eq!(same.differences(&host), Vec::<String>::new());
    let other = block(vec![member("origin", 0), member("count", 12), member("stride", 20)], 80);
    let differences = other.differences(&host).join("; ");
    for part in
        ["`count` is at 16", "at 12 in the shader", "`stride` at 20", "`extra` at 20", "24 bytes", "80"]
    {
        assert!(differences.contains(part), "{part} is missing from: {differences}");
    }
}

#[test]
fn garbage_is_an_error_and_not_a_panic() {
    assert!(Module::read(&[]).is_err());
    assert!(Module::read(&[3, 2, 35, 7, 0, 3, 1, 0]).is_err());
    assert!(Module::load("no/such.spv").unwrap_err().to_string().contains("no/such.spv"));
}
