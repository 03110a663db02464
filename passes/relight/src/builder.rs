//! A frame while its stages are collected: resources, stages, what is left out, copies to the device.

use std::collections::BTreeMap;

use airglow_graph::{Access, BufferDesc, LeftOut, PassKind, ResourceDesc, State};

use crate::control::{Once, Rotations};
use crate::frame::ResultRange;
use crate::resident::{Resident, Upload};
use crate::shown::Shown;
use crate::stage::{Need, Prepared, Resource, Stage, Use, Work};

/// A frame while its stages are collected.
#[derive(Default)]
pub(crate) struct Builder {
    pub stages: Vec<Stage>,
    pub needs: BTreeMap<Resource, Need>,
    pub left_out: Vec<LeftOut>,
    uploads: Vec<(Resource, Upload)>,
}

impl Builder {
    /// A buffer of ours that is read as `access` in this frame and others.
    pub(crate) fn resident(&mut self, resource: Resource, resident: &Resident, access: Access) {
        let state = State::of(access);
        let need = Need::Ours { buffer: resident.buffer().clone(), entry: state, exit: state };
        if self.needs.insert(resource, need).is_none() {
            self.uploads.extend(resident.upload().map(|upload| (resource, upload)));
        }
    }

    pub(crate) fn host(&mut self, resource: Resource) {
        self.needs.insert(resource, Need::Host);
    }

    pub(crate) fn scratch(&mut self, resource: Resource, size: u64) {
        self.needs.insert(resource, Need::Scratch(ResourceDesc::Buffer(BufferDesc::new(size))));
    }

    pub(crate) fn stage(
        &mut self,
        name: &'static str,
        kind: PassKind,
        uses: Vec<(Resource, Access)>,
        work: Work,
        once: Option<Once>,
    ) {
        let uses = uses.into_iter().map(|(resource, access)| Use { resource, access }).collect();
        self.stages.push(Stage { name, kind, uses, before: Vec::new(), work, once, shown: None });
    }

    pub(crate) fn leave_out(&mut self, what: &str, why: &str, bytes: u64, would_return: &str) {
        let (what, why, would_return) = (what.to_owned(), why.to_owned(), would_return.to_owned());
        self.left_out.push(LeftOut { what, why, bytes, time: None, would_return });
    }

    /// The stages, copies to the device first.
    pub(crate) fn finish(
        mut self,
        ranges: Vec<ResultRange>,
        rotations: Option<Rotations>,
        shown: Shown,
    ) -> Prepared {
        self.stages.iter_mut().for_each(|stage| stage.shown = Some(shown.clone()));
        if !self.uploads.is_empty() {
            let (resources, uploads): (Vec<_>, Vec<_>) =
                std::mem::take(&mut self.uploads).into_iter().unzip();
            let uses =
                resources.into_iter().map(|resource| (resource, Access::TransferDestination)).collect();
            self.stage("relight uploads", PassKind::Transfer, uses, Work::Uploads(uploads), None);
            self.stages.rotate_right(1);
        }
        let mut last = BTreeMap::new();
        for stage in &mut self.stages {
            stage.before = stage.uses.iter().map(|used| last.insert(used.resource, used.access)).collect();
        }
        let needs = self.needs.into_iter().collect();
        Prepared { stages: self.stages, needs, left_out: self.left_out, ranges, rotations, shown }
    }
}
