//! Every pipeline that a host may come to need of a room, made ahead of the frames on a thread of the host's choice.

use super::compute::ComputePipeline;
use super::graphics::GraphicsPipeline;
use super::kernel::{Kernel, Key, Pipeline};
use crate::context::Context;
use crate::error::GpuError;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What a host may come to need of a room, as the room's envelope states it.
pub trait Permutations {
    /// What the room refuses with.
    type Error: From<GpuError>;

    /// Every kernel that anything within can need; some may be there more than once.
    ///
    /// # Errors
    /// Settings without kernels, or none at all.
    fn kernels(&self) -> Result<Vec<Kernel>, Self::Error>;

    /// How many pipelines it takes.
    ///
    /// # Errors
    /// As [`Permutations::kernels`].
    fn pipeline_count(&self) -> Result<usize, Self::Error> {
        Ok(self.kernels()?.iter().map(Kernel::key).collect::<BTreeSet<_>>().len())
    }
}

/// Every pipeline of an envelope: what a room makes with them makes no other, nor does any frame. Clones refer to the same.
#[derive(Clone)]
pub struct Pipelines<E> {
    shared: Arc<(E, BTreeMap<Key, Pipeline>)>,
}

impl<E: Permutations> Pipelines<E> {
    /// Makes every pipeline of the envelope, on the thread that calls it, with the host's pipeline cache. Frames may be
    /// recorded on other threads meanwhile.
    ///
    /// # Errors
    /// As [`Permutations::kernels`], and the device's.
    pub fn prepare(context: &Context, envelope: E) -> Result<Self, E::Error> {
        let mut pipelines = BTreeMap::new();
        for kernel in envelope.kernels()? {
            if let Entry::Vacant(place) = pipelines.entry(kernel.key()) {
                place.insert(kernel.make(context)?);
            }
        }
        Ok(Self { shared: Arc::new((envelope, pipelines)) })
    }
}

impl<E> Pipelines<E> {
    /// What they were prepared for.
    #[must_use]
    pub fn envelope(&self) -> &E {
        &self.shared.0
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.shared.1.len()
    }

    /// That of a compute kernel.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for one that the envelope did not name.
    pub fn compute(&self, kernel: &Kernel) -> Result<ComputePipeline, GpuError> {
        match self.shared.1.get(&kernel.key()) {
            Some(Pipeline::Compute(pipeline)) => Ok(pipeline.clone()),
            _ => Err(unprepared(kernel)),
        }
    }

    /// That of a kernel of vertices and fragments.
    ///
    /// # Errors
    /// As [`Pipelines::compute`].
    pub fn graphics(&self, kernel: &Kernel) -> Result<GraphicsPipeline, GpuError> {
        match self.shared.1.get(&kernel.key()) {
            Some(Pipeline::Graphics(pipeline)) => Ok(pipeline.clone()),
            _ => Err(unprepared(kernel)),
        }
    }
}

fn unprepared(kernel: &Kernel) -> GpuError {
    GpuError::misuse(kernel.name, "no pipeline was prepared for it: name it in the envelope")
}

/// A setting that no pipeline was prepared for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{setting} is outside the envelope that was prepared: add it to Envelope::{field} and prepare")]
pub struct Outside {
    /// The setting.
    pub setting: String,
    /// The field of the room's envelope that lacks it.
    pub field: &'static str,
}

impl Outside {
    /// Refuses the first of `fields` that is not inside: whether it is, the field's name, the setting in words.
    ///
    /// # Errors
    /// Itself.
    pub fn check<const N: usize>(fields: [(bool, &'static str, String); N]) -> Result<(), Self> {
        match fields.into_iter().find(|(inside, ..)| !inside) {
            Some((_, field, setting)) => Err(Self { setting, field }),
            None => Ok(()),
        }
    }
}
