//! One subresource through the whole plan, twice: what a frame leaves is what the next one finds.

use crate::event::{Actor, Event, Meeting, holds, written};
use crate::mutation::Edit;
use crate::trace::{Barrier, Role, Trace};
use crate::violation::{Kind, Violation};
use airglow_graph::{ImageRange, Origin, PlanAccess, ResourceDesc, State};
use ash::vk::{AccessFlags2 as A, ImageLayout, PipelineStageFlags2 as S, QUEUE_FAMILY_IGNORED};

/// What is known of a subresource at one moment.
pub(crate) struct Subresource<'a> {
    trace: &'a Trace,
    edit: Option<Edit>,
    index: usize,
    at: (u32, u32),
    is_image: bool,
    events: Vec<Event>,
    layout: ImageLayout,
    owner: u32,
    round: u32,
    /// The version its contents are of; `None` without contents.
    contents: Option<u32>,
}

impl<'a> Subresource<'a> {
    /// Replays mip and layer `at` of a resource, with one barrier edited if asked.
    pub fn replay(
        trace: &'a Trace,
        index: usize,
        at: (u32, u32),
        edit: Option<Edit>,
    ) -> Result<(), Violation> {
        let is_image = matches!(trace.resources[index].desc, ResourceDesc::Image(_));
        let (layout, owner) = (ImageLayout::UNDEFINED, trace.queue_family);
        let events = Vec::new();
        let mut here =
            Self { trace, edit, index, at, is_image, events, layout, owner, round: 0, contents: None };
        let (entry, exit) = here.ends();
        let untouched = here.uses().next().is_none() && trace.barriers().all(|(_, _, b)| !here.meets(b));
        if untouched && (entry.is_none() || entry == exit) {
            return Ok(());
        }
        for round in 0..2 {
            here.round = round;
            here.enter(entry);
            for (moment, what) in trace.moments.iter().enumerate() {
                here.batch(moment)?;
                for used in what.uses.iter().filter(|used| here.uses_here(used)).collect::<Vec<_>>() {
                    here.pass_use(moment, used)?;
                }
            }
            here.leave(entry, exit)?;
        }
        Ok(())
    }

    fn within(&self, range: ImageRange) -> bool {
        contains(range, self.at)
    }

    fn uses_here(&self, used: &PlanAccess) -> bool {
        used.resource.index() == self.index && self.within(used.range)
    }

    fn meets(&self, barrier: &Barrier) -> bool {
        barrier.resource == self.index && self.within(barrier.range)
    }

    fn uses(&self) -> impl Iterator<Item = &'a PlanAccess> {
        let uses = self.trace.moments.iter().flat_map(|moment| &moment.uses);
        let (index, at) = (self.index, self.at);
        uses.filter(move |used| used.resource.index() == index && contains(used.range, at))
    }

    /// The host's states before and after.
    fn ends(&self) -> (Option<State>, Option<State>) {
        let resource = &self.trace.resources[self.index];
        let export = resource.exports.iter().find(|e| self.within(e.range)).map(|e| e.state);
        match resource.origin {
            Origin::Imported { entry, exit } => (Some(entry), Some(export.unwrap_or(exit))),
            Origin::Transient => (None, export),
        }
    }

    fn family(&self, state: State) -> u32 {
        if state.queue_family == QUEUE_FAMILY_IGNORED { self.trace.queue_family } else { state.queue_family }
    }

    fn enter(&mut self, entry: Option<State>) {
        let Some(entry) = entry else {
            // A transient waits for its own last execution: its events stay.
            (self.layout, self.contents, self.owner) =
                (ImageLayout::UNDEFINED, None, self.trace.queue_family);
            return;
        };
        let emptied = self.trace.histories.iter().any(|history| history.current.index() == self.index);
        let filled = !emptied && (!self.is_image || entry.layout != ImageLayout::UNDEFINED);
        (self.layout, self.contents, self.owner) = (entry.layout, filled.then_some(0), self.family(entry));
        self.events.clear();
        if self.owner != self.trace.queue_family || entry.stage.is_empty() {
            return;
        }
        let wrote = written(entry.access);
        if wrote.is_empty() {
            // What the host reads was written before that, and is visible where the host reads it.
            let past = Event::past_write(Actor::HostWrote, self.round, entry.stage, entry.access);
            self.events.push(past);
        }
        self.events.push(Event::access(Actor::HostBefore, self.round, entry.stage, wrote));
    }

    fn leave(&mut self, entry: Option<State>, exit: Option<State>) -> Result<(), Violation> {
        let Some(exit) = exit else { return Ok(()) };
        let end = self.trace.moments.len();
        let newest = self.uses().filter_map(|used| used.output).max();
        let emptied = self.trace.histories.iter().any(|history| history.current.index() == self.index);
        let used = self.trace.resources[self.index].lifetime.is_some();
        if (newest.is_some() && newest != self.contents) || (emptied && used && newest.is_none()) {
            let problem = format!("is left with version {:?} instead of {newest:?}", self.contents);
            return Err(self.fail(Kind::Exit, end, problem, "keep the last version to the end"));
        }
        if self.is_image && exit.layout != ImageLayout::UNDEFINED && exit.layout != self.layout {
            let problem = format!("is left in {:?} instead of {:?}", self.layout, exit.layout);
            return Err(self.fail(Kind::Exit, end, problem, "add a final barrier to that layout"));
        }
        if self.owner != self.family(exit) {
            let problem = format!("is left to queue family {} instead of {}", self.owner, self.family(exit));
            return Err(self.fail(Kind::Ownership, end, problem, "release it to that family"));
        }
        if self.owner != self.trace.queue_family || exit.stage.is_empty() {
            // The host waits by means of its own.
            self.events.clear();
            return Ok(());
        }
        self.access(end, Actor::HostAfter, exit.stage, exit.access, exit.access)?;
        let waited = |event: &Event| holds(event.after, exit.stage) || holds(exit.stage, event.stage);
        let left = self.events.iter().find(|event| event.actor != Actor::HostAfter && !waited(event));
        match left {
            // The host that waits for the exit state must have waited for everything.
            Some(event) if entry.is_some() => {
                let problem = format!("the host's exit state does not cover {}", self.who(event));
                let mend = format!("add a final barrier from {:?} to {:?}", event.stage, exit.stage);
                Err(self.fail(Kind::Exit, end, problem, mend))
            }
            _ => Ok(()),
        }
    }

    fn batch(&mut self, moment: usize) -> Result<(), Violation> {
        let barriers = &self.trace.moments[moment].barriers;
        let mut met = None;
        for (i, barrier) in barriers.iter().enumerate().filter(|(_, barrier)| self.meets(barrier)) {
            let edited = match self.edit {
                Some(edit) if (edit.moment, edit.barrier) == (moment, i) => edit.mutation.of(barrier),
                _ => Some(*barrier),
            };
            if edited.is_some() && met.is_some() {
                let problem = "has two barriers in one batch, which no order holds apart";
                return Err(self.fail(Kind::Structure, moment, problem, "join them or record two batches"));
            }
            met = edited.or(met);
        }
        met.map_or(Ok(()), |barrier| self.barrier(moment, &barrier))
    }

    fn barrier(&mut self, moment: usize, b: &Barrier) -> Result<(), Violation> {
        let transfers = b.src_queue_family != b.dst_queue_family;
        let transitions = transfers || (self.is_image && b.old_layout != b.new_layout);
        let discards = b.old_layout == ImageLayout::UNDEFINED;
        if self.is_image && b.old_layout != self.layout && !discards {
            let problem = format!("a barrier from {:?} where it is in {:?}", b.old_layout, self.layout);
            return Err(self.fail(Kind::Layout, moment, problem, "start from the layout it is in"));
        }
        if transfers {
            self.transfer(moment, b)?;
        }
        for i in 0..self.events.len() {
            let event = &mut self.events[i];
            let meeting = event.pass_barrier((b.src_stage, b.src_access), (b.dst_stage, b.dst_access));
            if transitions && (meeting == Meeting::No || (event.writes && !event.available)) {
                let event = &self.events[i];
                let problem = format!("its transition races with {}", self.who(event));
                let mend = format!("wait for {:?} / {:?} in the barrier", event.stage, event.written);
                return Err(self.fail(Kind::Transition, moment, problem, mend));
            }
        }
        if self.is_image && discards {
            self.contents = None;
        }
        if transitions {
            self.layout = b.new_layout;
            let over = Event::past_write(Actor::Transition(moment), self.round, b.dst_stage, b.dst_access);
            self.events = vec![over];
        }
        Ok(())
    }

    /// One half of a transfer between families; the host's half states the same layouts and families.
    fn transfer(&mut self, moment: usize, b: &Barrier) -> Result<(), Violation> {
        let role = self.trace.moments[moment].role;
        let (from, to) = (b.src_queue_family, b.dst_queue_family);
        let own = self.trace.queue_family;
        let (problem, mend) = if from != self.owner {
            (format!("queue family {from} gives what {} owns", self.owner), "name the owning family")
        } else if !matches!(
            (role, from == own, to == own),
            (Role::Acquire, _, true) | (Role::Release, true, _)
        ) {
            let problem = format!("a transfer from queue family {from} to {to} has no other half here");
            (problem, "acquire before the passes, release after the final barriers")
        } else if b.old_layout != b.new_layout {
            let problem = format!("a transfer changes layout {:?} to {:?}", b.old_layout, b.new_layout);
            (problem, "change the layout in a barrier of its own, so that both halves agree")
        } else if role == Role::Acquire && (b.src_stage.is_empty() || !holds(b.src_stage, b.dst_stage)) {
            let problem = format!("an acquire opens {:?} but waits at {:?}", b.dst_stage, b.src_stage);
            (problem, "wait at every stage it opens, where the host's semaphore does")
        } else {
            self.owner = to;
            return Ok(());
        };
        Err(self.fail(Kind::Ownership, moment, problem, mend))
    }

    fn pass_use(&mut self, moment: usize, used: &PlanAccess) -> Result<(), Violation> {
        if self.is_image && used.layout != self.layout {
            let problem = format!("{:?} wants {:?}, finds {:?}", used.access, used.layout, self.layout);
            return Err(self.fail(Kind::Layout, moment, problem, "add a barrier to that layout before"));
        }
        if self.owner != self.trace.queue_family {
            let problem = format!("is used while queue family {} owns it", self.owner);
            return Err(self.fail(Kind::Ownership, moment, problem, "acquire it before the first pass"));
        }
        if used.keeps_contents {
            let outputs = self.uses().filter_map(|other| other.output);
            let wanted = outputs.filter(|output| *output <= used.version).max().unwrap_or(0);
            if self.contents != Some(wanted) {
                let problem = format!("{:?} wants version {wanted}, finds {:?}", used.access, self.contents);
                let mend = "run its writer before, keep its contents in every barrier between";
                return Err(self.fail(Kind::Contents, moment, problem, mend));
            }
        }
        let reads = if used.keeps_contents { used.flags } else { A::NONE };
        self.access(moment, Actor::Pass(moment), used.stage, reads, used.flags)?;
        if let Some(output) = used.output {
            if self.contents.is_some_and(|contents| contents >= output) {
                let problem = format!("version {output} is written over {:?}", self.contents);
                return Err(self.fail(Kind::Contents, moment, problem, "run the writers in their order"));
            }
            self.contents = Some(output);
        }
        Ok(())
    }

    /// Looks at the pair with every event before. `reads` is empty where older contents do not matter.
    fn access(&mut self, moment: usize, actor: Actor, stage: S, reads: A, flags: A) -> Result<(), Violation> {
        let wrote = written(flags);
        let writes = !wrote.is_empty();
        let reads = A::from_raw(reads.as_raw() & !written(reads).as_raw());
        let mut last_write = true;
        for e in self.events.iter().rev() {
            if (e.actor, e.round) == (actor, self.round) || !(e.writes || writes) {
                last_write &= e.writes;
                continue;
            }
            let kind = match (e.writes, writes && reads.is_empty()) {
                (true, true) => Kind::WriteAfterWrite,
                (true, false) => Kind::ReadAfterWrite,
                (false, _) => Kind::WriteAfterRead,
            };
            if !holds(e.after, stage) {
                let problem = format!("does not wait for {}", self.who(e));
                let mend = format!("add a barrier from {:?} to {stage:?}", e.stage);
                return Err(self.fail(kind, moment, problem, mend));
            }
            if e.writes && !e.available {
                let problem = format!("comes before the write of {} is available", self.who(e));
                let mend = format!("add {:?} to the barrier's first accesses", e.written);
                return Err(self.fail(kind, moment, problem, mend));
            }
            // What was read since needs no visibility to be written again.
            let needs = if last_write { reads | flags } else { reads };
            if e.writes && !needs.is_empty() && !e.is_visible_to(stage, needs) {
                let problem = format!("the write of {} is not visible to it", self.who(e));
                let mend = format!("add {stage:?} / {needs:?} to the barrier's second scope");
                return Err(self.fail(kind, moment, problem, mend));
            }
            last_write &= e.writes;
        }
        self.events.push(Event::access(actor, self.round, stage, wrote));
        Ok(())
    }

    fn who(&self, event: &Event) -> String {
        let name = |moment: usize| self.trace.moments.get(moment).map_or("the end", |m| m.name.as_str());
        let who = match event.actor {
            Actor::HostBefore => "the host's use before".to_owned(),
            Actor::HostWrote => "what the host wrote before".to_owned(),
            Actor::HostAfter => "the host's use after".to_owned(),
            Actor::Pass(moment) => name(moment).to_owned(),
            Actor::Transition(moment) => format!("the transition in the barriers of {}", name(moment)),
        };
        if event.round == self.round { who } else { format!("{who} in the execution before") }
    }

    fn fail(
        &self,
        kind: Kind,
        moment: usize,
        problem: impl Into<String>,
        mend: impl Into<String>,
    ) -> Violation {
        let place = self.trace.moments.get(moment).map_or("the host after", |m| m.name.as_str());
        Violation {
            kind,
            place: place.to_owned(),
            resource: self.trace.resources[self.index].name.clone(),
            mip: self.at.0,
            layer: self.at.1,
            problem: problem.into(),
            mend: mend.into(),
        }
    }
}

fn contains(range: ImageRange, (mip, layer): (u32, u32)) -> bool {
    (range.base_mip..range.base_mip.saturating_add(range.mips)).contains(&mip)
        && (range.base_layer..range.base_layer.saturating_add(range.layers)).contains(&layer)
}
