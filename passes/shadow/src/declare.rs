//! Adds the pass to a graph.

use airglow_gpu::Record;
use airglow_graph::{Access, Buffer, BufferDesc, Graph, Handle, LeftOut, PassKind};

use crate::blockers::Blockers;
use crate::shadow::{Bindings, Receivers, Shadow};

/// What the graph holds of a frame's shadow.
#[derive(Clone, Copy, Debug)]
pub struct Shadowed {
    /// Visibility of each receiver, as relighting takes it; `None` where nothing dynamic blocks.
    pub visibility: Option<Handle<Buffer>>,
    /// `[u32; 2]` a cluster for [`Counts::of`](crate::Counts::of).
    pub records: Option<Handle<Buffer>>,
}

impl Shadow {
    /// Adds the pass over the receivers of one instance to a graph. The plan may be recorded again in later frames;
    /// [`Blockers::set`] moves the spheres in between. Where there are none now the pass is left out, with the reason, and
    /// the instance has no dynamic visibility.
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        receivers: &Receivers,
        blockers: &Blockers,
        positions: Handle<Buffer>,
        normals: Option<Handle<Buffer>>,
    ) -> Shadowed {
        let bytes = receivers.visibility_bytes(self.settings().order);
        if blockers.is_empty() {
            graph.leave_out(LeftOut {
                what: "shadow".to_owned(),
                why: "nothing that moves blocks".to_owned(),
                bytes,
                time: None,
                would_return: "a sphere with a radius".to_owned(),
            });
            return Shadowed { visibility: None, records: None };
        }
        graph.pipelines("shadow", self.pipeline_count());
        let mut pass = graph.pass("shadow visibility", PassKind::Compute);
        pass.read(&positions, Access::ComputeStorageRead);
        if let Some(normals) = &normals {
            pass.read(normals, Access::ComputeStorageRead);
        }
        let write = Access::ComputeStorageWrite;
        let visibility = pass.create_buffer("shadow visibility", BufferDesc::new(bytes), write);
        let records = pass.create_buffer("shadow records", BufferDesc::new(receivers.record_bytes()), write);
        let (shadow, receivers, blockers) = (self.clone(), receivers.clone(), blockers.clone());
        pass.record(Box::new(move |recorder, resources| {
            let bindings = Bindings {
                positions: resources.buffer(&positions)?.into(),
                normals: normals.map(|normals| resources.buffer(&normals)).transpose()?.map(Into::into),
                visibility: resources.buffer(&visibility)?.into(),
                records: resources.buffer(&records)?.into(),
            };
            shadow.record(recorder, &receivers, &blockers, &bindings)
        }));
        Shadowed { visibility: Some(visibility), records: Some(records) }
    }
}
