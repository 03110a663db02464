//! Adds the pass to a graph.

use std::slice::from_ref;

use airglow_gpu::Record;
use airglow_graph::{Graph, Handle, Image, ImageDesc, PassKind};

use crate::FogError;
use crate::control::Counts;
use crate::fog::{ACCESSES, Bindings, Fog, Prepared};
use crate::frame::{Fogged, Frame};

impl Fog {
    /// Adds the pass to a graph. The plan may be recorded again in later frames while the size stays and the medium is
    /// not clear; [`Fogged::control`] changes the view in between. Lights come and go within the plan: which of them are
    /// left out is said by the control, not by the plan.
    ///
    /// # Errors
    /// As [`Fog::prepare`].
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        frame: &Frame<Handle<Image>>,
    ) -> Result<Fogged<Handle<Image>>, FogError> {
        let mut fogged = self.add_views(graph, from_ref(frame))?;
        fogged.pop().ok_or(FogError::Plan { what: "there is no view" })
    }

    /// Adds one pass for several views, in the order of `frames`: pipelines, and the barriers before and after it, are
    /// those of one. A view whose medium is clear is left out by itself.
    ///
    /// # Errors
    /// As [`Fog::prepare`], before anything is added.
    pub fn add_views(
        &self,
        graph: &mut Graph<Record>,
        frames: &[Frame<Handle<Image>>],
    ) -> Result<Vec<Fogged<Handle<Image>>>, FogError> {
        let prepared = frames.iter().map(|frame| self.prepare(frame)).collect::<Result<Vec<_>, _>>()?;
        graph.pipelines("fog", self.pipeline_count());
        let mut fogged = Vec::with_capacity(frames.len());
        let mut passes = Vec::with_capacity(frames.len());
        for (frame, prepared) in frames.iter().zip(prepared) {
            match prepared {
                Prepared::Pass(pass) => {
                    let (control, counts) = (Some(pass.control.clone()), pass.control.counts());
                    fogged.push(Fogged { colour: frame.surface, control, counts });
                    passes.push(Some(pass));
                }
                Prepared::LeftOut(left_out) => {
                    let colour = graph.forward(frame.surface, left_out);
                    let left_out = frame.view.lights.len() as u32;
                    let counts = Counts { left_out, ..Counts::default() };
                    fogged.push(Fogged { colour, control: None, counts });
                    passes.push(None);
                }
            }
        }
        if passes.iter().all(Option::is_none) {
            return Ok(fogged);
        }
        let [(_, reads), (_, reads_depth), (_, writes)] = ACCESSES;
        let mut builder = graph.pass("fog airlight", PassKind::Graphics);
        let mut views = Vec::new();
        for ((frame, fogged), pass) in frames.iter().zip(&mut fogged).zip(passes) {
            let Some(pass) = pass else { continue };
            builder.read(&frame.surface, reads).read(&frame.depth, reads_depth);
            let [width, height] = frame.size;
            fogged.colour = match frame.target {
                Some(target) => builder.write(target, writes),
                None => {
                    let desc = ImageDesc::new_2d(width, height, self.settings().format);
                    builder.create_image("fog picture", desc, writes)
                }
            };
            views.push((pass, [frame.surface, frame.depth, fogged.colour]));
        }
        builder.record(Box::new(move |recorder, resources| {
            views.iter().try_for_each(|(pass, [surface, depth, target])| {
                let [surface, depth, target] =
                    [resources.view(surface)?, resources.view(depth)?, resources.view(target)?];
                pass.record(recorder, &Bindings { surface, depth, target })
            })
        }));
        Ok(fogged)
    }
}
