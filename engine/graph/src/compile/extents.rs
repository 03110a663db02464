//! Phase 1: extents relative to the frame or to another image become texels.

use crate::declaration::{Declaration, Resource};
use crate::error::GraphError;
use crate::extent::{ExtentBase, RelativeExtent};
use crate::options::Options;
use crate::resource::{Origin, ResourceDesc};

pub(super) fn extents(declaration: &mut Declaration, options: &Options) -> Result<(), GraphError> {
    for index in 0..declaration.resources.len() {
        let (before, rest) = declaration.resources.split_at_mut(index);
        let resource = &mut rest[0];
        let Some(extent) = resource.relative else { continue };
        resolve(resource, before, extent, options).map_err(|(problem, mend)| GraphError::Resource {
            resource: resource.name.clone(),
            problem: problem.to_owned(),
            mend: mend.to_owned(),
        })?;
    }
    Ok(())
}

fn resolve(
    resource: &mut Resource,
    before: &[Resource],
    extent: RelativeExtent,
    options: &Options,
) -> Result<(), (&'static str, &'static str)> {
    let imported = matches!(resource.origin, Origin::Imported { .. }) && resource.half.is_none();
    let ResourceDesc::Image(image) = &mut resource.desc else {
        return Err(("a buffer has no extent", "size images only"));
    };
    if imported {
        return Err(("it is imported with an extent of its own", "size transients and histories only"));
    }
    let base = match extent.base {
        ExtentBase::Frame => options
            .frame_extent
            .ok_or(("its extent is relative to the frame's", "compile with `Options::frame_extent`"))?,
        ExtentBase::Image(base) => match before.get(base.index()).map(|base| &base.desc) {
            Some(ResourceDesc::Image(base)) => [base.extent[0], base.extent[1]],
            _ => {
                return Err((
                    "its extent is relative to no image declared before it",
                    "name an image this graph returned earlier",
                ));
            }
        },
    };
    let ratio = "its extent is a ratio with a zero, or past 32 bits";
    for (side, base) in image.extent.iter_mut().zip(base) {
        *side = extent.of_side(base).ok_or((ratio, "give a ratio of positive numbers"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Access, Graph, ImageDesc};
    use ash::vk;

    fn image() -> ImageDesc {
        ImageDesc::new_2d(1, 1, vk::Format::R32_SFLOAT)
    }

    fn run(graph: &mut Graph<()>, frame_extent: Option<[u32; 2]>) -> Result<Vec<[u32; 3]>, String> {
        let options = Options { frame_extent, ..Options::default() };
        extents(&mut graph.declaration, &options).map_err(|error| error.to_string())?;
        let images = graph.declaration.resources.iter().map(|resource| match resource.desc {
            ResourceDesc::Image(image) => image.extent,
            ResourceDesc::Buffer(_) => [0; 3],
        });
        Ok(images.collect())
    }

    #[test]
    fn ratios_of_ratios_and_of_the_frame_resolve() {
        let mut graph = Graph::new();
        let half = graph.create_image("half", image());
        graph.size_relative(&half, RelativeExtent::of_frame(1, 2));
        let eighth = graph.create_image("eighth", image());
        graph.size_relative(&eighth, RelativeExtent::of_image(&half, 1, 4));
        let history = graph.history_image("history", image(), Access::ComputeSampled);
        graph.size_relative(&history.current, RelativeExtent::of_frame(1, 1));
        let extents = run(&mut graph, Some([1281, 720]));
        let expected = vec![[641, 360, 1], [161, 90, 1], [1281, 720, 1], [1281, 720, 1]];
        assert_eq!(extents, Ok(expected));
        assert!(run(&mut graph, None).is_err_and(|message| message.contains("Options::frame_extent")));
    }

    #[test]
    fn an_image_relative_to_itself_or_imported_is_refused() {
        let mut graph = Graph::new();
        let itself = graph.create_image("itself", image());
        graph.size_relative(&itself, RelativeExtent::of_image(&itself, 1, 2));
        assert!(run(&mut graph, None).is_err_and(|message| message.contains("declared before")));
        let mut graph = Graph::new();
        let hosts = graph.import_image("host's", image(), Access::ComputeSampled, Access::ComputeSampled);
        graph.size_relative(&hosts, RelativeExtent::of_frame(1, 2));
        assert!(run(&mut graph, Some([8, 8])).is_err_and(|message| message.contains("imported")));
    }
}
