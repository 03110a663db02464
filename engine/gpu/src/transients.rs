//! The transients of a plan: each with memory of its own, or in places that they hand to one another.

use crate::allocator::Location;
use crate::context::Context;
use crate::error::GpuError;
use crate::memory::heap::Heap;
use crate::memory::{Buffer, Image, Label, image};
use crate::resources::Concrete;
use crate::shared::Shared;
use airglow_graph::{Origin, Placement, Plan, PlanResource, ResourceDesc, Sharing};
use ash::vk;
use std::collections::BTreeMap;

/// Whom transients are charged to.
const OWNER: &str = "transient";

/// The transients of a plan by resource; `None` for imports and what no step uses.
pub(crate) type Transients = Vec<Option<Concrete>>;

/// Makes each transient with memory of its own.
pub(crate) fn apart<R>(context: &Context, plan: &Plan<R>) -> Result<Transients, GpuError> {
    context.shared.check_budget("the plan's transient resources", plan.bytes().transient)?;
    plan.resources().iter().map(|resource| transient(context, resource)).collect()
}

/// Makes transients in two heaps, buffers and images, and returns how they share them; `None`, and nothing made, where no
/// memory of the device suits all of them or they do not fit into one piece of it.
pub(crate) fn shared<R>(
    context: &Context,
    plan: &Plan<R>,
) -> Result<Option<(Transients, Sharing)>, GpuError> {
    let shared = &context.shared;
    let mut unbound = BTreeMap::new();
    for placement in &plan.sharing_with(|_| Some((1, 1))).placements {
        let index = placement.resource.index();
        unbound.insert(index, Unbound::new(shared, &plan.resources()[index])?);
    }
    let needs = |index: usize| unbound.get(&index).map(|unbound: &Unbound<'_>| unbound.needs);
    let sharing = plan.sharing_with(|id| needs(id.index()).map(|needs| (needs.size, needs.alignment)));
    let is_buffer =
        |place: &Placement| matches!(plan.resources()[place.resource.index()].desc, ResourceDesc::Buffer(_));
    let mut transients: Transients = vec![None; plan.resources().len()];
    let mut pieces = Vec::new();
    for (buffers, size) in [(true, sharing.buffer_heap), (false, sharing.image_heap)] {
        let places: Vec<_> = sharing.placements.iter().filter(|place| is_buffer(place) == buffers).collect();
        let each = || places.iter().filter_map(|place| needs(place.resource.index()));
        let requirements = vk::MemoryRequirements {
            size,
            alignment: each().map(|needs| needs.alignment).max().unwrap_or(1),
            memory_type_bits: each().fold(!0, |bits, needs| bits & needs.memory_type_bits),
        };
        if requirements.memory_type_bits == 0 || size > shared.facts.max_allocation {
            return Ok(None);
        }
        pieces.push((buffers, requirements, places));
    }
    shared.check_budget("the plan's transient resources", sharing.buffer_heap + sharing.image_heap)?;
    for (buffers, requirements, places) in pieces {
        if places.is_empty() {
            continue;
        }
        let label = Label::new(OWNER, if buffers { "shared buffers" } else { "shared images" });
        let heap = Heap::new(shared, label, requirements, buffers)?;
        for place in places {
            let index = place.resource.index();
            let Some(unbound) = unbound.remove(&index) else { continue };
            transients[index] = Some(unbound.bind(context, &plan.resources()[index], &heap, place.offset)?);
        }
    }
    // What an export keeps has memory of its own.
    for (place, resource) in transients.iter_mut().zip(plan.resources()) {
        if place.is_none() {
            *place = transient(context, resource)?;
        }
    }
    Ok(Some((transients, sharing)))
}

/// A transient that some step uses, or `None`.
fn transient(context: &Context, resource: &PlanResource) -> Result<Option<Concrete>, GpuError> {
    if !matches!(resource.origin, Origin::Transient) || resource.lifetime.is_none() {
        return Ok(None);
    }
    let label = Label::new(OWNER, &resource.name);
    Ok(Some(match &resource.desc {
        ResourceDesc::Buffer(desc) => {
            Concrete::Buffer(context.create_buffer(label, desc, Location::Device)?)
        }
        ResourceDesc::Image(desc) => Concrete::Image(context.create_image(label, desc)?),
    }))
}

/// A buffer or image without memory; destroyed with it unless it was bound.
struct Unbound<'a> {
    shared: &'a Shared,
    raw: Raw,
    needs: vk::MemoryRequirements,
}

#[derive(Clone, Copy)]
enum Raw {
    Buffer(vk::Buffer),
    Image(vk::Image),
    Bound,
}

impl<'a> Unbound<'a> {
    fn new(shared: &'a Shared, resource: &PlanResource) -> Result<Self, GpuError> {
        let device = shared.device();
        // SAFETY: a live device and complete descriptions, images checked.
        let (raw, needs) = unsafe {
            match &resource.desc {
                ResourceDesc::Buffer(desc) => {
                    let info = vk::BufferCreateInfo::default().size(desc.size).usage(desc.usage);
                    let raw =
                        device.create_buffer(&info, None).map_err(GpuError::vulkan("vkCreateBuffer"))?;
                    (Raw::Buffer(raw), device.get_buffer_memory_requirements(raw))
                }
                ResourceDesc::Image(desc) => {
                    let info = image::create_info(desc);
                    image::check(shared, Label::new(OWNER, &resource.name), desc, &info)?;
                    let raw = device.create_image(&info, None).map_err(GpuError::vulkan("vkCreateImage"))?;
                    (Raw::Image(raw), device.get_image_memory_requirements(raw))
                }
            }
        };
        Ok(Self { shared, raw, needs })
    }

    /// Binds it to a place in a heap.
    fn bind(
        mut self,
        context: &Context,
        resource: &PlanResource,
        heap: &Heap,
        offset: u64,
    ) -> Result<Concrete, GpuError> {
        let (device, label) = (self.shared.device(), Label::new(OWNER, &resource.name));
        let (memory, offset) = heap.place(offset);
        // SAFETY: a place of the right type, size and alignment in memory that outlives the resource.
        unsafe {
            match self.raw {
                Raw::Buffer(raw) => device
                    .bind_buffer_memory(raw, memory, offset)
                    .map_err(GpuError::vulkan("vkBindBufferMemory"))?,
                Raw::Image(raw) => device
                    .bind_image_memory(raw, memory, offset)
                    .map_err(GpuError::vulkan("vkBindImageMemory"))?,
                Raw::Bound => {}
            }
        }
        let raw = std::mem::replace(&mut self.raw, Raw::Bound);
        match (raw, &resource.desc) {
            (Raw::Buffer(raw), ResourceDesc::Buffer(desc)) => {
                Ok(Concrete::Buffer(Buffer::placed(&context.shared, raw, label, desc, heap)))
            }
            (Raw::Image(raw), ResourceDesc::Image(desc)) => {
                Ok(Concrete::Image(Image::placed(&context.shared, raw, label, desc, heap)))
            }
            _ => Err(GpuError::misuse(label.name, "it is placed as what it is not")),
        }
    }
}

impl Drop for Unbound<'_> {
    fn drop(&mut self) {
        // SAFETY: objects of this device that nothing was recorded with.
        unsafe {
            match self.raw {
                Raw::Buffer(raw) => self.shared.device().destroy_buffer(raw, None),
                Raw::Image(raw) => self.shared.device().destroy_image(raw, None),
                Raw::Bound => {}
            }
        }
    }
}
