//! Adds the pass to a graph.

use airglow_gpu::Record;
use airglow_graph::{Graph, Handle, Image, ImageDesc, PassKind};

use crate::FogError;
use crate::fog::{ACCESSES, Bindings, Fog, Prepared};
use crate::frame::{Counts, Fogged, Frame};

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
        let prepared = self.prepare(frame)?;
        graph.pipelines("fog", 1);
        let prepared = match prepared {
            Prepared::Pass(pass) => pass,
            Prepared::LeftOut(left_out) => {
                let colour = graph.forward(frame.surface, left_out);
                let left_out = frame.view.lights.len() as u32;
                return Ok(Fogged { colour, control: None, counts: Counts { evaluated: 0, left_out } });
            }
        };
        let counts = prepared.control.counts();
        let [(_, reads), (_, reads_depth), (_, writes)] = ACCESSES;
        let (surface, depth) = (frame.surface, frame.depth);
        let mut pass = graph.pass("fog airlight", PassKind::Graphics);
        pass.read(&surface, reads).read(&depth, reads_depth);
        let [width, height] = frame.size;
        let target = match frame.target {
            Some(target) => pass.write(target, writes),
            None => {
                let desc = ImageDesc::new_2d(width, height, self.settings().format);
                pass.create_image("fog picture", desc, writes)
            }
        };
        let control = Some(prepared.control.clone());
        pass.record(Box::new(move |recorder, resources| {
            let view = |handle| resources.view(handle);
            let bindings =
                Bindings { surface: view(&surface)?, depth: view(&depth)?, target: view(&target)? };
            prepared.record(recorder, &bindings)
        }));
        Ok(Fogged { colour: target, control, counts })
    }
}
