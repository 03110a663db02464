//! Who wrote and who read each subresource, version by version: what hazards, order and cull look up.

use crate::declaration::Declaration;
use crate::handle::{ImageRange, ResourceId};

/// A write of one version.
#[derive(Clone, Copy, Debug)]
pub(super) struct Write {
    pub version: u32,
    pub pass: usize,
    pub range: ImageRange,
}

/// A use that needs the contents of one version.
#[derive(Clone, Copy, Debug)]
pub(super) struct Read {
    pub version: u32,
    pub pass: usize,
    pub range: ImageRange,
}

/// The writes and reads of one resource: writes by version, reads as declared.
#[derive(Clone, Debug, Default)]
pub(super) struct Life {
    pub writes: Vec<Write>,
    pub reads: Vec<Read>,
}

pub(super) struct Lives {
    lives: Vec<Life>,
}

impl Lives {
    /// Needs resolved ranges and existing resources, as validation leaves them.
    pub fn of(declaration: &Declaration) -> Self {
        let mut lives = vec![Life::default(); declaration.resources.len()];
        for (pass, declared) in declaration.passes.iter().enumerate() {
            for used in &declared.uses {
                let life = &mut lives[used.resource.index()];
                if used.keeps {
                    life.reads.push(Read { version: used.version, pass, range: used.range });
                }
                if let Some(version) = used.output {
                    life.writes.push(Write { version, pass, range: used.range });
                }
            }
        }
        for life in &mut lives {
            life.writes.sort_by_key(|write| write.version);
        }
        Self { lives }
    }

    pub fn life(&self, resource: ResourceId) -> &Life {
        &self.lives[resource.index()]
    }

    /// The write that made what `version` holds at one mip and layer; `None` if no pass did.
    pub fn writer(&self, resource: ResourceId, version: u32, at: (u32, u32)) -> Option<&Write> {
        let writes = &self.life(resource).writes;
        writes.iter().rev().find(|write| write.version <= version && contains(write.range, at))
    }

    /// The passes that wrote some of what `version` holds in `range`, each once, in order.
    pub fn writers(&self, resource: ResourceId, version: u32, range: ImageRange) -> Vec<usize> {
        let at = range.subresources();
        let mut passes: Vec<usize> =
            at.filter_map(|at| self.writer(resource, version, at)).map(|write| write.pass).collect();
        passes.sort_unstable();
        passes.dedup();
        passes
    }
}

pub(super) fn contains(range: ImageRange, (mip, layer): (u32, u32)) -> bool {
    range.overlaps(ImageRange { base_mip: mip, mips: 1, base_layer: layer, layers: 1 })
}
