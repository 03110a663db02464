//! Phase 2: every use makes sense by itself. Resolves ranges and completes the usage of transients.

use super::histories::share_usage;
use crate::access::{Access, writes};
use crate::declaration::{Declaration, Half, Resource};
use crate::error::GraphError;
use crate::handle::ImageRange;
use crate::options::Limits;
use crate::pass::{Pass, PassKind, Use};
use crate::resource::{BufferDesc, ImageDesc, Origin, ResourceDesc};
use ash::vk::{self, PipelineStageFlags2 as S};

/// What is wrong, and the mend.
type Problem = (String, &'static str);
type Checked<T = ()> = Result<T, Problem>;

const FOREIGN_HANDLE: &str = "use only handles this graph returned";

fn fail<T>(problem: impl Into<String>, mend: &'static str) -> Checked<T> {
    Err((problem.into(), mend))
}

pub(super) fn validate(declaration: &mut Declaration, limits: &Limits) -> Result<(), GraphError> {
    let Declaration { resources, passes, exports, .. } = declaration;
    for resource in resources.iter() {
        check_desc(&resource.desc, limits).and_then(|()| check_history(resource)).map_err(
            |(problem, mend)| GraphError::Resource {
                resource: resource.name.clone(),
                problem,
                mend: mend.to_owned(),
            },
        )?;
    }
    for pass in passes.iter_mut() {
        check_pass(pass, resources).map_err(|(problem, mend)| GraphError::Pass {
            pass: pass.name.clone(),
            problem,
            mend: mend.to_owned(),
        })?;
    }
    share_usage(resources);
    for i in 0..exports.len() {
        let (before, rest) = exports.split_at_mut(i);
        let export = &mut rest[0];
        let known = resources.get(export.resource.index());
        let name = known.map_or_else(|| "a resource of another graph".to_owned(), |r| r.name.clone());
        let checked = resolve(known, export.is_image, export.version, export.range).and_then(|range| {
            export.range = range;
            let again = before.iter().any(|e| e.resource == export.resource && e.range.overlaps(range));
            if again { fail("the same part is exported twice", "export it once") } else { Ok(()) }
        });
        checked.map_err(|(problem, mend)| GraphError::Export {
            resource: name,
            problem,
            mend: mend.to_owned(),
        })?;
    }
    Ok(())
}

fn check_desc(desc: &ResourceDesc, limits: &Limits) -> Checked {
    match desc {
        ResourceDesc::Buffer(BufferDesc { size, .. }) => {
            if *size == 0 {
                return fail("its size is 0 bytes", "leave it out, or give it at least one byte");
            }
            if *size > limits.max_buffer_size {
                let problem = format!("{size} bytes are past the limit of {}", limits.max_buffer_size);
                return fail(problem, "split it, or compile with the device's own limits");
            }
            Ok(())
        }
        ResourceDesc::Image(image) => check_image(image, limits),
    }
}

/// What a history rests in has to be safe to find and to leave: reads of the plan's own queue.
fn check_history(resource: &Resource) -> Checked {
    let (Some(_), Origin::Imported { exit, .. }) = (resource.half, resource.origin) else { return Ok(()) };
    let layout = !resource.desc.is_image() || exit.layout != vk::ImageLayout::UNDEFINED;
    let own = exit.queue_family == vk::QUEUE_FAMILY_IGNORED;
    if exit.stage.is_empty() || writes(exit.access) || !layout || !own {
        return fail(
            "a history cannot rest in that state",
            "let it rest in a state that reads, such as the one in which its previous half is read",
        );
    }
    Ok(())
}

fn check_image(image: &ImageDesc, limits: &Limits) -> Checked {
    let [width, height, depth] = image.extent;
    let largest = if depth > 1 { limits.max_image_dimension_3d } else { limits.max_image_dimension_2d };
    if image.extent.contains(&0) {
        return fail(format!("its extent is {width}x{height}x{depth}"), "make each side at least 1");
    }
    if image.extent.iter().any(|side| *side > largest) {
        let problem = format!("{width}x{height}x{depth} texels are past the limit of {largest} a side");
        return fail(problem, "make it smaller, or compile with the device's own limits");
    }
    let full = u32::BITS - width.max(height).max(depth).leading_zeros();
    if image.mips == 0 || image.mips > full {
        return fail(format!("{} mips where 1 to {full} exist", image.mips), "ask for as many as exist");
    }
    if image.layers == 0 || image.layers > limits.max_image_array_layers {
        let problem = format!("{} layers where the limit is {}", image.layers, limits.max_image_array_layers);
        return fail(problem, "ask for at least 1 and at most the limit");
    }
    if depth > 1 && image.layers > 1 {
        return fail("a 3D image with layers", "use one layer");
    }
    if image.cube && (!image.layers.is_multiple_of(6) || width != height) {
        let problem = format!("a cube of {} layers of {width}x{height}", image.layers);
        return fail(problem, "use square faces, 6 layers per cube");
    }
    if image.format == vk::Format::UNDEFINED {
        return fail("its format is UNDEFINED", "name its format");
    }
    let samples = image.samples.as_raw();
    if !samples.is_power_of_two() || (samples > 1 && image.mips > 1) {
        return fail(
            format!("samples {:?} with {} mips", image.samples, image.mips),
            "use one sample count; with mips, 1",
        );
    }
    Ok(())
}

fn check_pass(pass: &mut Pass, resources: &mut [Resource]) -> Checked {
    for used in &mut pass.uses {
        let resource = resources.get_mut(used.resource.index());
        used.range = resolve(resource.as_deref(), used.is_image, used.version, used.range)?;
        // `resolve` has refused a missing resource.
        if let Some(resource) = resource {
            check_use(used, pass.kind, resource).map_err(|(problem, mend)| {
                (format!("its use of `{}` as {:?}: {problem}", resource.name, used.access), mend)
            })?;
        }
    }
    for (i, second) in pass.uses.iter().enumerate() {
        for first in &pass.uses[..i] {
            check_pair(first, second).map_err(|(problem, mend)| {
                let name = &resources[second.resource.index()].name;
                (format!("it uses `{name}` as {:?} and {:?}: {problem}", first.access, second.access), mend)
            })?;
        }
    }
    Ok(())
}

/// The range a handle names, if the handle is of this graph.
fn resolve(
    resource: Option<&Resource>,
    is_image: bool,
    version: u32,
    range: ImageRange,
) -> Checked<ImageRange> {
    let Some(resource) = resource else {
        return fail("a handle of another graph", FOREIGN_HANDLE);
    };
    if resource.desc.is_image() != is_image || version as usize > resource.versions.len() {
        return fail(
            format!("a handle of another graph, where `{}` stands here", resource.name),
            FOREIGN_HANDLE,
        );
    }
    let (mips, layers) = resource.desc.subresources();
    range.resolve(mips, layers).ok_or_else(|| {
        let problem =
            format!("{range:?} is not within the {mips} mips and {layers} layers of `{}`", resource.name);
        (problem, "name mips and layers that exist")
    })
}

fn check_use(used: &Use, kind: PassKind, resource: &mut Resource) -> Checked {
    let access = used.access;
    if used.output.is_some() != access.writes() {
        return fail(
            "the access does not go with the verb",
            "use `read` for reads, `write` or `update` for writes",
        );
    }
    let loads = |loaded| access == loaded && used.keeps;
    if loads(Access::ColorAttachmentWrite) || loads(Access::DepthAttachmentWrite) {
        return fail("an update has to load the attachment", "use the ReadWrite access of the attachment");
    }
    check_kind(access, kind)?;
    if resource.half == Some(Half::Previous) && access.writes() {
        return fail("it is what the frame before left", "write its current half");
    }
    let imported = matches!(resource.origin, Origin::Imported { .. }) && resource.half.is_none();
    match &mut resource.desc {
        ResourceDesc::Buffer(buffer) => {
            let needed = access.buffer_usage();
            if needed.is_empty() {
                return fail("a pass cannot use a buffer so", "choose an access for buffers");
            }
            if imported && !buffer.usage.contains(needed) {
                return fail(
                    format!("it was imported without usage {needed:?}"),
                    "create it with that usage",
                );
            }
            buffer.usage |= needed;
        }
        ResourceDesc::Image(image) => {
            let needed = access.image_usage();
            if needed.is_empty() {
                return fail("a pass cannot use an image so", "choose an access for images");
            }
            if imported && !image.usage.contains(needed) {
                return fail(
                    format!("it was imported without usage {needed:?}"),
                    "create it with that usage",
                );
            }
            check_aspect(access, image)?;
            image.usage |= needed;
        }
    }
    Ok(())
}

fn check_kind(access: Access, kind: PassKind) -> Checked {
    let drawing = S::VERTEX_ATTRIBUTE_INPUT
        | S::INDEX_INPUT
        | S::VERTEX_SHADER
        | S::FRAGMENT_SHADER
        | S::EARLY_FRAGMENT_TESTS
        | S::LATE_FRAGMENT_TESTS
        | S::COLOR_ATTACHMENT_OUTPUT;
    let refused = match kind {
        PassKind::Graphics => S::COMPUTE_SHADER,
        PassKind::Compute => drawing,
        PassKind::Transfer => drawing | S::COMPUTE_SHADER | S::DRAW_INDIRECT,
    };
    if access.stage().intersects(refused) {
        return fail(
            format!("a {kind:?} pass has no such stage"),
            "choose the pass kind or the access to match",
        );
    }
    Ok(())
}

fn check_aspect(access: Access, image: &ImageDesc) -> Checked {
    use Access as U;
    let depth = image.aspects() != vk::ImageAspectFlags::COLOR;
    let wants_depth = match access {
        U::ColorAttachmentWrite | U::ColorAttachmentReadWrite => Some(false),
        U::VertexSampled | U::FragmentSampled | U::ComputeSampled => Some(false),
        U::VertexSampledDepth | U::FragmentSampledDepth | U::ComputeSampledDepth => Some(true),
        U::DepthAttachmentWrite | U::DepthAttachmentReadWrite | U::DepthAttachmentRead => Some(true),
        _ => None,
    };
    if wants_depth.is_some_and(|wanted| wanted != depth) {
        return fail(
            format!("format {:?}", image.format),
            "use a depth access with a depth format, and only then",
        );
    }
    Ok(())
}

/// Two uses by one pass: no barrier can stand between them.
fn check_pair(first: &Use, second: &Use) -> Checked {
    if first.resource != second.resource || !first.range.overlaps(second.range) {
        return Ok(());
    }
    if first.access.writes() || second.access.writes() {
        return fail(
            "the parts overlap and one use writes",
            "use one ReadWrite access, parts that do not overlap, or two passes",
        );
    }
    if first.version != second.version {
        return fail("two versions of one part", "read one version, or copy the older one first");
    }
    if first.is_image && first.access.layout() != second.access.layout() {
        return fail("an image has one layout at a time", "use accesses of one layout, or two passes");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builder::PassBuilder;
    use crate::graph::Graph;

    /// The message about a pass of one kind that uses a fresh buffer and a fresh image somehow.
    fn message(kind: PassKind, declare: impl FnOnce(&mut PassBuilder<'_, ()>)) -> String {
        let mut graph = Graph::new();
        let mut pass = graph.pass("p", kind);
        declare(&mut pass);
        pass.record(());
        validate(&mut graph.declaration, &Limits::default()).map_err(|e| e.to_string()).unwrap_err()
    }

    fn image() -> ImageDesc {
        ImageDesc { mips: 3, ..ImageDesc::new_2d(4, 4, vk::Format::R32_SFLOAT) }
    }

    /// The same for one write of a fresh buffer.
    fn buffer_message(kind: PassKind, size: u64, access: Access) -> String {
        message(kind, |pass| {
            pass.create_buffer("b", BufferDesc::new(size), access);
        })
    }

    /// The same for one write of a fresh image.
    fn image_message(kind: PassKind, access: Access) -> String {
        message(kind, |pass| {
            pass.create_image("i", image(), access);
        })
    }

    #[test]
    fn uses_that_make_no_sense_are_named_with_their_mend() {
        use PassKind::{Compute, Graphics};
        let cases = [
            (buffer_message(Compute, 4, Access::ComputeStorageRead), "`read`"),
            (buffer_message(Compute, 0, Access::ComputeStorageWrite), "0 bytes"),
            (buffer_message(Compute, 8, Access::HostWrite), "cannot use"),
            (image_message(Compute, Access::ColorAttachmentWrite), "no such stage"),
            (image_message(Graphics, Access::DepthAttachmentWrite), "R32_SFLOAT"),
        ];
        for (message, expected) in cases {
            assert!(message.contains(expected), "expected `{expected}` in: {message}");
        }
    }

    #[test]
    fn two_uses_of_one_part_by_one_pass_are_refused() {
        let message = message(PassKind::Compute, |pass| {
            let image = pass.create_image("i", image(), Access::ComputeStorageWrite);
            pass.read(&image.mip(1), Access::ComputeSampled);
        });
        assert!(message.contains("overlap"), "{message}");
    }

    #[test]
    fn ranges_are_resolved_and_checked() {
        let missing = message(PassKind::Compute, |pass| {
            let image = pass.create_image("i", image(), Access::ComputeStorageWrite);
            pass.read(&image.mip(3), Access::ComputeSampled);
        });
        assert!(missing.contains("not within the 3 mips"), "{missing}");
        let part = ImageRange { base_mip: 1, mips: ImageRange::REMAINING, base_layer: 0, layers: 1 };
        assert_eq!(part.resolve(3, 1).map(|range| range.mips), Some(2));
        assert_eq!(part.resolve(1, 1), None);
    }

    #[test]
    fn imports_need_their_usage_and_transients_get_it() {
        let mut graph = Graph::<()>::new();
        let made = graph.create_buffer("made", BufferDesc::new(4));
        graph.pass("p", PassKind::Compute).write(made, Access::ComputeStorageWrite);
        assert_eq!(validate(&mut graph.declaration, &Limits::default()), Ok(()));
        let ResourceDesc::Buffer(desc) = graph.declaration.resources[0].desc else { panic!("a buffer") };
        assert_eq!(desc.usage, vk::BufferUsageFlags::STORAGE_BUFFER);

        let hosts = graph.import_buffer("host's", BufferDesc::new(4), Access::HostWrite, Access::HostRead);
        graph.pass("q", PassKind::Compute).write(hosts, Access::ComputeStorageWrite);
        let message = validate(&mut graph.declaration, &Limits::default()).unwrap_err().to_string();
        assert!(message.contains("STORAGE_BUFFER"), "{message}");
    }
}
