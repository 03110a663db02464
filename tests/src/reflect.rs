//! What a SPIR-V module declares, as naga reads it: bindings, block layouts, push constants, workgroup size.
//!
//! A room's test compares the bindings it states in Rust with [`Module::signature`], and each host struct with the
//! block it fills:
//! ```no_run
//! use airglow_tests::{host_layout, reflect::Module};
//! #[repr(C)]
//! struct Chunk { vertex_count: u32, stride: u32 }
//!
//! let module = Module::load("relight/dot.ORDER4.spv").unwrap();
//! module.push_constants.as_ref().unwrap().assert_matches(&host_layout!(Chunk { vertex_count, stride }));
//! ```

use std::path::{Path, PathBuf};

use airglow_gpu::BindingDesc;
use ash::vk;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, ArraySize, Handle, ImageClass, ShaderStage, Type, TypeInner};

/// What shipped shaders may ask of naga beyond the portable core: push constants, and halves in 32-bit words.
const CAPABILITIES: Capabilities = Capabilities::IMMEDIATES
    .union(Capabilities::SHADER_FLOAT16_IN_FLOAT32)
    .union(Capabilities::CLIP_DISTANCES);

/// Why a module could not be reflected.
#[derive(Debug, thiserror::Error)]
pub enum ReflectError {
    /// The file could not be read.
    #[error("{path}: {source}; `cargo run -p xtask -- shaders` makes the SPIR-V")]
    Io {
        /// The file.
        path: PathBuf,
        /// The operating system's answer.
        source: std::io::Error,
    },
    /// naga panicked, as it does on some valid modules.
    #[error("naga panicked; look for a construct that the shader rules of ARCHITECTURE.md exclude")]
    Panicked,
    /// naga does not read the module.
    #[error("naga does not parse the module: {0}")]
    Parse(String),
    /// naga reads the module and finds it invalid, or outside the portable set.
    #[error("naga does not validate the module: {0}")]
    Invalid(String),
    /// The module holds something no shipped shader may hold.
    #[error("{0}")]
    Unsupported(String),
}

/// One entry point and everything it declares.
#[derive(Debug, Clone)]
pub struct Module {
    /// Pipeline stage.
    pub stage: vk::ShaderStageFlags,
    /// Local size of a compute shader; zeros for other stages.
    pub workgroup: [u32; 3],
    /// Bytes of shared memory.
    pub shared_bytes: u32,
    /// Resources, sorted by set and binding.
    pub bindings: Vec<Binding>,
    /// The push-constant block.
    pub push_constants: Option<Block>,
}

/// One descriptor.
#[derive(Debug, Clone)]
pub struct Binding {
    /// Descriptor set.
    pub set: u32,
    /// Number in the set.
    pub binding: u32,
    /// Name in the shader; may be empty.
    pub name: String,
    /// Descriptor type; dynamic buffers appear as plain ones.
    pub kind: vk::DescriptorType,
    /// Layout of a buffer's block.
    pub block: Option<Block>,
}

/// A struct in memory.
#[derive(Debug, Clone)]
pub struct Block {
    /// Type name in the shader.
    pub name: String,
    /// Bytes; a runtime array at the end counts one element.
    pub size: u32,
    /// Members in order.
    pub members: Vec<Member>,
}

/// One member of a [`Block`].
#[derive(Debug, Clone)]
pub struct Member {
    /// Name in the shader.
    pub name: String,
    /// Bytes from the block's start.
    pub offset: u32,
    /// Layout of the member's struct, or of the struct its array is made of.
    pub block: Option<Block>,
}

/// A host struct as the compiler laid it out; [`host_layout!`](crate::host_layout) makes one.
#[derive(Debug, Clone)]
pub struct HostLayout {
    /// Type name in Rust.
    pub name: &'static str,
    /// Bytes.
    pub size: usize,
    /// Name and offset of each member.
    pub members: Vec<(&'static str, usize)>,
}

/// The [`HostLayout`](crate::reflect::HostLayout) of a struct's listed members; padding is left out of the list.
#[macro_export]
macro_rules! host_layout {
    ($host:ty { $($member:ident),+ $(,)? }) => {
        $crate::reflect::HostLayout {
            name: stringify!($host),
            size: ::std::mem::size_of::<$host>(),
            members: vec![$((stringify!($member), ::std::mem::offset_of!($host, $member))),+],
        }
    };
}

/// The folder of the committed modules.
pub fn spirv_root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shaders/spirv")
}

impl Module {
    /// Reads a committed module by its path below `shaders/spirv`.
    ///
    /// # Errors
    /// As [`Module::read`], and an unreadable file.
    pub fn load(relative: &str) -> Result<Self, ReflectError> {
        let path = spirv_root().join(relative);
        let bytes = std::fs::read(&path).map_err(|source| ReflectError::Io { path, source })?;
        Self::read(&bytes)
    }

    /// Parses and validates SPIR-V with naga, then lists what it declares.
    ///
    /// # Errors
    /// naga panics, refuses the module or finds it invalid; the module has not exactly one entry point.
    pub fn read(spirv: &[u8]) -> Result<Self, ReflectError> {
        let module = std::panic::catch_unwind(|| validated(spirv)).map_err(|_| ReflectError::Panicked)??;
        let [entry] = module.entry_points.as_slice() else {
            let count = module.entry_points.len();
            return Err(ReflectError::Unsupported(format!(
                "the module has {count} entry points instead of one"
            )));
        };
        let stage = match entry.stage {
            ShaderStage::Vertex => vk::ShaderStageFlags::VERTEX,
            ShaderStage::Fragment => vk::ShaderStageFlags::FRAGMENT,
            ShaderStage::Compute => vk::ShaderStageFlags::COMPUTE,
            other => return Err(ReflectError::Unsupported(format!("{other:?} shaders are not shipped"))),
        };
        let mut reflected = Self {
            stage,
            workgroup: entry.workgroup_size,
            shared_bytes: 0,
            bindings: Vec::new(),
            push_constants: None,
        };
        for (_, variable) in module.global_variables.iter() {
            match variable.space {
                AddressSpace::WorkGroup => reflected.shared_bytes += size(&module, variable.ty),
                AddressSpace::Immediate => reflected.push_constants = block(&module, variable.ty),
                _ => {}
            }
            if let Some(place) = &variable.binding {
                reflected.bindings.push(Binding {
                    set: place.group,
                    binding: place.binding,
                    name: variable.name.clone().unwrap_or_default(),
                    kind: descriptor_type(variable.space, &module.types[variable.ty].inner)?,
                    block: block(&module, variable.ty),
                });
            }
        }
        reflected.bindings.sort_by_key(|binding| (binding.set, binding.binding));
        Ok(reflected)
    }

    /// Set, binding and descriptor type of every resource, sorted.
    pub fn signature(&self) -> Vec<(u32, u32, vk::DescriptorType)> {
        self.bindings.iter().map(|binding| (binding.set, binding.binding, binding.kind)).collect()
    }

    /// Panics unless the bindings that a pipeline states in Rust are those of this module: all of them for a compute
    /// shader, at least those this stage has for the others, which share the statement.
    #[track_caller]
    pub fn assert_bindings(&self, stated: &[BindingDesc]) {
        let mut stated: Vec<_> =
            stated.iter().map(|desc| (0, desc.binding, desc.kind.descriptor_type())).collect();
        stated.sort_unstable();
        let found = self.signature();
        if self.stage != vk::ShaderStageFlags::COMPUTE {
            stated.retain(|binding| found.contains(binding));
        }
        assert_eq!(stated, found, "bindings stated in Rust against those of the shader (set, binding, type)");
    }

    /// The block of the buffer at a binding.
    pub fn block(&self, set: u32, binding: u32) -> Option<&Block> {
        self.bindings.iter().find(|found| (found.set, found.binding) == (set, binding))?.block.as_ref()
    }
}

impl Block {
    /// The struct of a member, or of the elements of a member that is an array.
    pub fn member(&self, name: &str) -> Option<&Block> {
        self.members.iter().find(|member| member.name == name)?.block.as_ref()
    }

    /// Everything in which a host struct differs: members without a partner, other offsets, another size. The host
    /// may be padded to a multiple of 16 bytes.
    pub fn differences(&self, host: &HostLayout) -> Vec<String> {
        let mut differences = Vec::new();
        for member in &self.members {
            match host.members.iter().find(|(name, _)| *name == member.name) {
                None => differences
                    .push(format!("`{}` at {} is not in the host struct", member.name, member.offset)),
                Some((name, offset)) if *offset != member.offset as usize => differences.push(format!(
                    "`{name}` is at {offset} in the host and at {} in the shader",
                    member.offset
                )),
                Some(_) => {}
            }
        }
        for (name, offset) in &host.members {
            if !self.members.iter().any(|member| member.name == *name) {
                differences.push(format!("`{name}` at {offset} is not in the shader's block"));
            }
        }
        let size = self.size as usize;
        if host.size != size && host.size != size.next_multiple_of(16) {
            differences.push(format!("the host has {} bytes, the shader {size}", host.size));
        }
        differences
    }

    /// Panics with every difference between a host struct and this block.
    #[track_caller]
    pub fn assert_matches(&self, host: &HostLayout) {
        let differences = self.differences(host);
        assert!(differences.is_empty(), "{} against {}:\n{}", host.name, self.name, differences.join("\n"));
    }
}

fn validated(spirv: &[u8]) -> Result<naga::Module, ReflectError> {
    let options = naga::front::spv::Options { adjust_coordinate_space: false, ..Default::default() };
    let module = naga::front::spv::parse_u8_slice(spirv, &options)
        .map_err(|error| ReflectError::Parse(error.to_string()))?;
    Validator::new(ValidationFlags::all(), CAPABILITIES)
        .validate(&module)
        .map_err(|error| ReflectError::Invalid(format!("{:?}", error.into_inner())))?;
    Ok(module)
}

fn descriptor_type(space: AddressSpace, inner: &TypeInner) -> Result<vk::DescriptorType, ReflectError> {
    Ok(match (space, inner) {
        (AddressSpace::Uniform, _) => vk::DescriptorType::UNIFORM_BUFFER,
        (AddressSpace::Storage { .. }, _) => vk::DescriptorType::STORAGE_BUFFER,
        (_, TypeInner::Image { class: ImageClass::Storage { .. }, .. }) => vk::DescriptorType::STORAGE_IMAGE,
        (_, TypeInner::Image { .. }) => vk::DescriptorType::SAMPLED_IMAGE,
        (_, TypeInner::Sampler { .. }) => vk::DescriptorType::SAMPLER,
        _ => return Err(ReflectError::Unsupported(format!("a binding of type {inner:?} is not shipped"))),
    })
}

fn size(module: &naga::Module, ty: Handle<Type>) -> u32 {
    module.types[ty].inner.size(module.to_ctx())
}

/// The layout of a struct, or of the struct that an array is made of.
fn block(module: &naga::Module, ty: Handle<Type>) -> Option<Block> {
    let ty = &module.types[ty];
    match &ty.inner {
        TypeInner::Array { base, size: ArraySize::Constant(_) | ArraySize::Dynamic, .. } => {
            block(module, *base)
        }
        TypeInner::Struct { members, span } => Some(Block {
            name: ty.name.clone().unwrap_or_default(),
            size: *span,
            members: members
                .iter()
                .map(|member| Member {
                    name: member.name.clone().unwrap_or_default(),
                    offset: member.offset,
                    block: block(module, member.ty),
                })
                .collect(),
        }),
        _ => None,
    }
}
