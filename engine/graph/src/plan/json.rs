//! The plan as JSON: fields in a fixed order, flags by their Vulkan names, resources by name.

use super::text::flags;
use super::{Barriers, CullReason, Culled, Lifetime, Plan, PlanAccess, PlanBytes, PlanResource, Step};
use crate::access::State;
use crate::declaration::{LeftOut, RoomPipelines};
use crate::handle::{ImageRange, ResourceId};
use crate::pass::PassKind;
use crate::resource::{Origin, ResourceDesc};
use serde::Serialize;

impl<R> Plan<R> {
    /// The plan as indented JSON. Payloads are not in it.
    ///
    /// # Errors
    /// None in practice: strings and numbers always serialise; serde's type is passed through.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        let barriers = |barriers: &Barriers| self.barriers_json(barriers);
        serde_json::to_string_pretty(&PlanJson {
            resources: self.resources.iter().map(resource_json).collect(),
            acquires: barriers(&self.acquires),
            steps: self.steps.iter().map(|step| self.step_json(step)).collect(),
            final_barriers: barriers(&self.final_barriers),
            releases: barriers(&self.releases),
            culled: self.culled.iter().map(|c| culled_json(c)).collect(),
            left_out: &self.left_out,
            pipelines: &self.pipelines,
            bytes: self.bytes(),
        })
    }

    fn name(&self, id: ResourceId) -> &str {
        &self.resources[id.index()].name
    }

    fn step_json<'a>(&'a self, step: &'a Step<R>) -> StepJson<'a> {
        let access = |access: &PlanAccess| AccessJson {
            resource: self.name(access.resource).to_owned(),
            range: access.range.into(),
            access: format!("{:?}", access.access),
            stage: flags(access.stage),
            flags: flags(access.flags),
            layout: flags(access.layout),
            version: access.version,
            output: access.output,
            keeps_contents: access.keeps_contents,
        };
        StepJson {
            name: &step.name,
            kind: step.kind,
            async_suitable: step.async_suitable,
            barriers: self.barriers_json(&step.barriers),
            accesses: step.accesses.iter().map(access).collect(),
        }
    }

    fn barriers_json(&self, barriers: &Barriers) -> Vec<BarrierJson> {
        let after = |step: Option<usize>| step.map(|step| self.steps[step].name.clone());
        let buffers = barriers.buffers.iter().map(|b| BarrierJson {
            resource: self.name(b.resource).to_owned(),
            range: None,
            src_stage: flags(b.src_stage),
            src_access: flags(b.src_access),
            dst_stage: flags(b.dst_stage),
            dst_access: flags(b.dst_access),
            layouts: None,
            queue_families: [b.src_queue_family, b.dst_queue_family],
            cause: format!("{:?}", b.cause),
            after: after(b.after),
        });
        let images = barriers.images.iter().map(|b| BarrierJson {
            resource: self.name(b.resource).to_owned(),
            range: Some(b.range.into()),
            src_stage: flags(b.src_stage),
            src_access: flags(b.src_access),
            dst_stage: flags(b.dst_stage),
            dst_access: flags(b.dst_access),
            layouts: Some([flags(b.old_layout), flags(b.new_layout)]),
            queue_families: [b.src_queue_family, b.dst_queue_family],
            cause: format!("{:?}", b.cause),
            after: after(b.after),
        });
        buffers.chain(images).collect()
    }
}

fn resource_json(resource: &PlanResource) -> ResourceJson<'_> {
    let (kind, extent, format, mips, layers, usage) = match &resource.desc {
        ResourceDesc::Buffer(b) => ("buffer", None, None, 1, 1, flags(b.usage)),
        ResourceDesc::Image(i) => {
            ("image", Some(i.extent), Some(flags(i.format)), i.mips, i.layers, flags(i.usage))
        }
    };
    let imported = match resource.origin {
        Origin::Imported { entry, exit } => Some([state_json(entry), state_json(exit)]),
        Origin::Transient => None,
    };
    let PlanResource { name, lifetime, exports, bytes, .. } = resource;
    ResourceJson {
        name,
        kind,
        extent,
        format,
        mips,
        layers,
        usage,
        bytes: *bytes,
        imported,
        exported: !exports.is_empty(),
        lifetime: *lifetime,
    }
}

fn state_json(state: State) -> StateJson {
    StateJson {
        stage: flags(state.stage),
        access: flags(state.access),
        layout: flags(state.layout),
        queue_family: state.queue_family,
    }
}

fn culled_json(culled: &Culled) -> CulledJson<'_> {
    CulledJson { pass: &culled.pass, text: culled.reason.to_string(), reason: &culled.reason }
}

#[derive(Serialize)]
struct PlanJson<'a> {
    resources: Vec<ResourceJson<'a>>,
    acquires: Vec<BarrierJson>,
    steps: Vec<StepJson<'a>>,
    final_barriers: Vec<BarrierJson>,
    releases: Vec<BarrierJson>,
    culled: Vec<CulledJson<'a>>,
    left_out: &'a [LeftOut],
    pipelines: &'a [RoomPipelines],
    bytes: PlanBytes,
}

#[derive(Serialize)]
struct ResourceJson<'a> {
    name: &'a str,
    kind: &'static str,
    extent: Option<[u32; 3]>,
    format: Option<String>,
    mips: u32,
    layers: u32,
    usage: String,
    bytes: Option<u64>,
    /// Entry and exit.
    imported: Option<[StateJson; 2]>,
    exported: bool,
    lifetime: Option<Lifetime>,
}

#[derive(Serialize)]
struct StateJson {
    stage: String,
    access: String,
    layout: String,
    queue_family: u32,
}

#[derive(Serialize)]
struct StepJson<'a> {
    name: &'a str,
    kind: PassKind,
    async_suitable: bool,
    barriers: Vec<BarrierJson>,
    accesses: Vec<AccessJson>,
}

#[derive(Serialize)]
struct AccessJson {
    resource: String,
    range: RangeJson,
    access: String,
    stage: String,
    flags: String,
    layout: String,
    version: u32,
    output: Option<u32>,
    keeps_contents: bool,
}

#[derive(Serialize)]
struct BarrierJson {
    resource: String,
    range: Option<RangeJson>,
    src_stage: String,
    src_access: String,
    dst_stage: String,
    dst_access: String,
    /// Old and new, of an image.
    layouts: Option<[String; 2]>,
    queue_families: [u32; 2],
    cause: String,
    /// The last step waited for.
    after: Option<String>,
}

#[derive(Serialize)]
struct RangeJson {
    base_mip: u32,
    mips: u32,
    base_layer: u32,
    layers: u32,
}

impl From<ImageRange> for RangeJson {
    fn from(range: ImageRange) -> Self {
        let ImageRange { base_mip, mips, base_layer, layers } = range;
        Self { base_mip, mips, base_layer, layers }
    }
}

#[derive(Serialize)]
struct CulledJson<'a> {
    pass: &'a str,
    text: String,
    reason: &'a CullReason,
}
