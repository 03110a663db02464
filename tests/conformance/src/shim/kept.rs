//! Pipelines kept from one attempt of a room to the next: each makes the same ones in the same order, and what a driver
//! takes to compile them tells nothing new of how a failing call unwinds.

use super::watch;
use airglow_gpu::ash::vk::{self, Handle};
use std::collections::BTreeMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

/// What a pipeline is made of: the function that makes it, and its modules by [`code`].
type Recipe = (&'static str, Vec<Option<u64>>);

/// Modules by their handles, and the pipelines of an attempt in the order in which they are made.
#[derive(Default)]
pub(super) struct Kept {
    code: BTreeMap<u64, u64>,
    /// Whether pipelines are kept at all.
    keeps: bool,
    /// How many this attempt has made.
    made: usize,
    pipelines: Vec<(Recipe, vk::Pipeline)>,
}

impl Kept {
    /// Keeps the pipelines that are made from here on.
    pub(super) fn keep(&mut self) {
        self.keeps = true;
    }

    /// The next attempt begins.
    pub(super) fn again(&mut self) {
        self.made = 0;
    }

    /// All that is kept, which is then no longer.
    pub(super) fn take(&mut self) -> impl Iterator<Item = vk::Pipeline> {
        self.keeps = false;
        std::mem::take(&mut self.pipelines).into_iter().map(|(_, pipeline)| pipeline)
    }
}

/// Notes the words of a module.
pub(super) fn note_module(info: &vk::ShaderModuleCreateInfo<'_>, module: vk::ShaderModule) {
    // SAFETY: the library passes a complete description: `code_size` bytes of words.
    let words = unsafe { std::slice::from_raw_parts(info.p_code, info.code_size / 4) };
    let mut hasher = DefaultHasher::new();
    words.hash(&mut hasher);
    watch(|watch| watch.kept.code.insert(module.as_raw(), hasher.finish()));
}

/// The pipeline of the same recipe that an earlier attempt made in this place.
pub(super) fn find(
    function: &'static str,
    stages: &[vk::PipelineShaderStageCreateInfo<'_>],
) -> Option<vk::Pipeline> {
    watch(|watch| {
        let kept = &mut watch.kept;
        let found =
            kept.pipelines.get(kept.made).filter(|(recipe, _)| *recipe == kept.recipe(function, stages))?;
        kept.made += 1;
        Some(found.1)
    })
}

/// Keeps a pipeline, where pipelines are kept and it is the next of the longest attempt.
pub(super) fn note(
    function: &'static str,
    stages: &[vk::PipelineShaderStageCreateInfo<'_>],
    pipeline: vk::Pipeline,
) {
    watch(|watch| {
        let kept = &mut watch.kept;
        if kept.keeps && kept.made == kept.pipelines.len() {
            let recipe = kept.recipe(function, stages);
            kept.pipelines.push((recipe, pipeline));
        }
        kept.made += 1;
    });
}

/// Whether a pipeline is kept: then it is not destroyed yet.
pub(super) fn holds(pipeline: vk::Pipeline) -> bool {
    watch(|watch| watch.kept.pipelines.iter().any(|(_, kept)| *kept == pipeline))
}

impl Kept {
    fn recipe(&self, function: &'static str, stages: &[vk::PipelineShaderStageCreateInfo<'_>]) -> Recipe {
        (function, stages.iter().map(|stage| self.code.get(&stage.module.as_raw()).copied()).collect())
    }
}
