//! Whether a trace names only what is there, and each use is what it says it is.

use crate::trace::{Barrier, Moment, Trace};
use crate::uses;
use crate::violation::{Kind, Violation};
use airglow_graph::{ImageRange, PlanAccess, PlanResource, ResourceDesc};
use ash::vk::{Format, ImageAspectFlags, ImageLayout};

pub(crate) fn check(trace: &Trace) -> Result<(), Violation> {
    for moment in &trace.moments {
        for barrier in &moment.barriers {
            check_barrier(trace, moment, barrier)?;
        }
        for used in &moment.uses {
            check_use(trace, moment, used)?;
        }
    }
    Ok(())
}

/// Every mip of every layer; a buffer has one of each.
pub(crate) fn subresources(resource: &PlanResource) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (mips, layers) = counts(resource);
    (0..mips).flat_map(move |mip| (0..layers).map(move |layer| (mip, layer)))
}

fn counts(resource: &PlanResource) -> (u32, u32) {
    match resource.desc {
        ResourceDesc::Buffer(_) => (1, 1),
        ResourceDesc::Image(image) => (image.mips, image.layers),
    }
}

fn check_barrier(trace: &Trace, moment: &Moment, barrier: &Barrier) -> Result<(), Violation> {
    let resource = find(trace, moment, barrier.resource, barrier.range)?;
    let aspects = match resource.desc {
        ResourceDesc::Buffer(_) => ImageAspectFlags::empty(),
        ResourceDesc::Image(image) => aspects(image.format),
    };
    if barrier.aspects != aspects {
        let problem = format!("a barrier on aspects {:?} of {aspects:?}", barrier.aspects);
        let mend = "name every aspect of the format".to_owned();
        return Err(violation(Kind::Structure, moment, &resource.name, barrier.range, problem, mend));
    }
    Ok(())
}

fn check_use(trace: &Trace, moment: &Moment, used: &PlanAccess) -> Result<(), Violation> {
    let resource = find(trace, moment, used.resource.index(), used.range)?;
    let fail = |problem: String, mend: String| {
        Err(violation(Kind::Use, moment, &resource.name, used.range, problem, mend))
    };
    let Some((stage, flags, layout)) = uses::needs(used.access) else {
        return fail(format!("a pass cannot use {:?}", used.access), "keep it for host states".to_owned());
    };
    let layout = match resource.desc {
        ResourceDesc::Buffer(_) => ImageLayout::UNDEFINED,
        ResourceDesc::Image(_) => layout,
    };
    if (used.stage, used.flags, used.layout) != (stage, flags, layout) {
        let problem = format!(
            "{:?} is stated as {:?} / {:?} in {:?}",
            used.access, used.stage, used.flags, used.layout
        );
        return fail(problem, format!("it is {stage:?} / {flags:?} in {layout:?}"));
    }
    Ok(())
}

fn find<'a>(
    trace: &'a Trace,
    moment: &Moment,
    index: usize,
    range: ImageRange,
) -> Result<&'a PlanResource, Violation> {
    let mend = || "name a resource of the plan, and mips and layers it has".to_owned();
    let Some(resource) = trace.resources.get(index) else {
        let problem = format!("there is no resource {index}");
        return Err(violation(Kind::Structure, moment, "?", range, problem, mend()));
    };
    let (mips, layers) = counts(resource);
    let fits = |base: u32, count: u32, total: u32| {
        count > 0 && base.checked_add(count).is_some_and(|end| end <= total)
    };
    if !fits(range.base_mip, range.mips, mips) || !fits(range.base_layer, range.layers, layers) {
        let problem = format!("{range:?} is not within {mips} mips and {layers} layers");
        return Err(violation(Kind::Structure, moment, &resource.name, range, problem, mend()));
    }
    Ok(resource)
}

fn aspects(format: Format) -> ImageAspectFlags {
    let (depth, stencil) = (ImageAspectFlags::DEPTH, ImageAspectFlags::STENCIL);
    match format {
        Format::D16_UNORM | Format::X8_D24_UNORM_PACK32 | Format::D32_SFLOAT => depth,
        Format::D16_UNORM_S8_UINT | Format::D24_UNORM_S8_UINT | Format::D32_SFLOAT_S8_UINT => depth | stencil,
        Format::S8_UINT => stencil,
        _ => ImageAspectFlags::COLOR,
    }
}

fn violation(
    kind: Kind,
    moment: &Moment,
    resource: &str,
    range: ImageRange,
    problem: String,
    mend: String,
) -> Violation {
    Violation {
        kind,
        place: moment.name.clone(),
        resource: resource.to_owned(),
        mip: range.base_mip,
        layer: range.base_layer,
        problem,
        mend,
    }
}
