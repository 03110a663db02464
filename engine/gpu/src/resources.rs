//! What a plan's handles stand for: the host's imports and the plan's own transients.

use crate::context::Context;
use crate::error::GpuError;
use crate::memory::{Buffer, Image, ImageView, ViewDesc};
use crate::recorder::Recorder;
use airglow_graph as graph;
use airglow_graph::{Handle, Kind, Origin, Plan, ResourceDesc};
use ash::vk;

/// What a pass carries through the graph: the closure that records it.
pub type Record = Box<dyn Fn(&mut Recorder<'_>, &Resources<'_>) -> Result<(), GpuError> + Send>;

/// A resource of a plan made concrete.
#[derive(Clone)]
pub(crate) enum Concrete {
    Buffer(Buffer),
    Image(Image),
}

/// The host's resources for one recording, by the handles that imported them. Kept and changed from frame to frame.
#[derive(Clone, Default)]
pub struct Imports(Vec<Option<Concrete>>);

impl Imports {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Stands `buffer` in for what `handle` names.
    pub fn buffer(&mut self, handle: &Handle<graph::Buffer>, buffer: &Buffer) -> &mut Self {
        self.set(handle, Concrete::Buffer(buffer.clone()))
    }

    /// Stands `image` in for what `handle` names.
    pub fn image(&mut self, handle: &Handle<graph::Image>, image: &Image) -> &mut Self {
        self.set(handle, Concrete::Image(image.clone()))
    }

    fn set<T: Kind>(&mut self, handle: &Handle<T>, concrete: Concrete) -> &mut Self {
        self.set_index(handle.resource().index(), concrete);
        self
    }

    pub(crate) fn set_index(&mut self, index: usize, concrete: Concrete) {
        if self.0.len() <= index {
            self.0.resize(index + 1, None);
        }
        self.0[index] = Some(concrete);
    }
}

/// What handles name, for a pass that records.
pub struct Resources<'a> {
    pub(crate) plan: &'a Plan<Record>,
    pub(crate) transients: &'a [Option<Concrete>],
    pub(crate) imports: &'a Imports,
}

impl Resources<'_> {
    /// The buffer that `handle` names.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a handle of another graph.
    pub fn buffer(&self, handle: &Handle<graph::Buffer>) -> Result<&Buffer, GpuError> {
        match self.concrete(handle.resource().index()) {
            Some(Concrete::Buffer(buffer)) => Ok(buffer),
            _ => Err(self.unknown(handle)),
        }
    }

    /// The image that `handle` names, whole.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a handle of another graph.
    pub fn image(&self, handle: &Handle<graph::Image>) -> Result<&Image, GpuError> {
        match self.concrete(handle.resource().index()) {
            Some(Concrete::Image(image)) => Ok(image),
            _ => Err(self.unknown(handle)),
        }
    }

    /// A view of the mips and layers that `handle` names: 2D for one layer, 2D array for more, 3D for a 3D image.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a handle of another graph, or a range outside the image.
    pub fn view(&self, handle: &Handle<graph::Image>) -> Result<ImageView, GpuError> {
        self.view_of(handle, None)
    }

    /// A view of what `handle` names in a shape of the caller's choice, such as a cube.
    ///
    /// # Errors
    /// As [`Resources::view`], and if the shape does not fit.
    pub fn view_as(
        &self,
        handle: &Handle<graph::Image>,
        dimension: vk::ImageViewType,
    ) -> Result<ImageView, GpuError> {
        self.view_of(handle, Some(dimension))
    }

    fn view_of(
        &self,
        handle: &Handle<graph::Image>,
        dimension: Option<vk::ImageViewType>,
    ) -> Result<ImageView, GpuError> {
        let image = self.image(handle)?;
        let desc = image.desc();
        let Some(range) = handle.range().resolve(desc.mips, desc.layers) else {
            return Err(GpuError::misuse(image.name(), "the handle's mips or layers are not the image's"));
        };
        let dimension = dimension.unwrap_or(match (desc.extent[2] > 1, range.layers > 1) {
            (true, _) => vk::ImageViewType::TYPE_3D,
            (false, true) => vk::ImageViewType::TYPE_2D_ARRAY,
            (false, false) => vk::ImageViewType::TYPE_2D,
        });
        let graph::ImageRange { base_mip, mips, base_layer, layers } = range;
        image.view(ViewDesc { dimension, base_mip, mips, base_layer, layers })
    }

    pub(crate) fn concrete(&self, index: usize) -> Option<&Concrete> {
        let transient = self.transients.get(index)?.as_ref();
        transient.or_else(|| self.imports.0.get(index)?.as_ref())
    }

    fn unknown<T: Kind>(&self, handle: &Handle<T>) -> GpuError {
        let name = self.plan.resource(handle).map_or("a handle", |resource| &resource.name);
        GpuError::misuse(name, "no such resource in this plan; use handles of the graph it was compiled from")
    }
}

/// Every import is there and is what was declared.
pub(crate) fn check_imports(
    context: &Context,
    plan: &Plan<Record>,
    imports: &Imports,
) -> Result<(), GpuError> {
    for (index, resource) in plan.resources().iter().enumerate() {
        if matches!(resource.origin, Origin::Transient) {
            continue;
        }
        let problem = match (imports.0.get(index).and_then(Option::as_ref), &resource.desc) {
            (None, _) => "no import given; add it to Imports",
            (Some(Concrete::Buffer(buffer)), ResourceDesc::Buffer(desc)) => {
                if !buffer.belongs_to(&context.shared) {
                    "the buffer was made by another context"
                } else if buffer.size() < desc.size || !buffer.desc().usage.contains(desc.usage) {
                    "the buffer is smaller than declared or lacks usages"
                } else {
                    continue;
                }
            }
            (Some(Concrete::Image(image)), ResourceDesc::Image(desc)) => {
                let usage = image.desc().usage;
                if !image.belongs_to(&context.shared) {
                    "the image was made by another context"
                } else if (graph::ImageDesc { usage, ..*desc }) != *image.desc()
                    || !usage.contains(desc.usage)
                {
                    "the image has not the extent, format, mips, layers or usage declared"
                } else {
                    continue;
                }
            }
            (Some(_), _) => "a buffer given for an image, or an image for a buffer",
        };
        return Err(GpuError::misuse(&*resource.name, problem));
    }
    Ok(())
}
