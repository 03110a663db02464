//! The verdict on a whole trace, and what in it does nothing.

use crate::mutation::{Edit, Mutation};
use crate::replay::Subresource;
use crate::structure;
use crate::trace::Trace;
use crate::violation::Violation;
use std::fmt::{self, Display, Formatter};

/// What was replayed without fault.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Mips times layers over all resources.
    pub subresources: usize,
    /// Uses by passes.
    pub uses: usize,
    /// Barriers.
    pub barriers: usize,
    /// Barriers without which the plan would be as sound.
    pub redundant: Vec<Superfluous>,
}

/// A barrier, or a flag of one, that is not needed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Superfluous {
    /// What can be taken away.
    pub edit: Edit,
    /// Where.
    pub place: String,
    /// The resource.
    pub resource: String,
}

impl Display for Superfluous {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { edit, place, resource } = self;
        write!(f, "{place}: barrier {} on `{resource}` does not need ", edit.barrier)?;
        match edit.mutation {
            Mutation::Drop => write!(f, "to be there"),
            mutation => write!(f, "{mutation:?}"),
        }
    }
}

impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { subresources, uses, barriers, redundant } = self;
        writeln!(f, "sound: {uses} uses, {barriers} barriers, {subresources} subresources replayed twice")?;
        redundant.iter().try_for_each(|superfluous| writeln!(f, "redundant: {superfluous}"))
    }
}

impl Trace {
    /// Replays every subresource twice, and once more without each barrier.
    ///
    /// # Errors
    /// The first thing wrong, by resource, mip and layer, then time.
    pub fn check(&self) -> Result<Report, Violation> {
        structure::check(self)?;
        let mut subresources = 0;
        for index in 0..self.resources.len() {
            for at in structure::subresources(&self.resources[index]) {
                subresources += 1;
                Subresource::replay(self, index, at, None)?;
            }
        }
        let dropped = self.edits().into_iter().filter(|edit| edit.mutation == Mutation::Drop);
        Ok(Report {
            subresources,
            uses: self.moments.iter().map(|moment| moment.uses.len()).sum(),
            barriers: self.barriers().count(),
            redundant: self.superfluous(dropped),
        })
    }

    /// Every flag of every barrier that can be taken away. For a sound trace.
    pub fn excess(&self) -> Vec<Superfluous> {
        let dropped = |edit: &Edit| edit.mutation == Mutation::Drop;
        self.superfluous(self.edits().into_iter().filter(|edit| edit.mutation.narrows() && !dropped(edit)))
    }

    /// Whether a sound trace stays so with one barrier changed.
    ///
    /// # Errors
    /// The first thing wrong.
    pub fn check_edit(&self, edit: Edit) -> Result<(), Violation> {
        let Some(barrier) = self.moments.get(edit.moment).and_then(|m| m.barriers.get(edit.barrier)) else {
            return Ok(());
        };
        for at in barrier.range.subresources() {
            Subresource::replay(self, barrier.resource, at, Some(edit))?;
        }
        Ok(())
    }

    fn superfluous(&self, edits: impl Iterator<Item = Edit>) -> Vec<Superfluous> {
        edits
            .filter(|edit| self.check_edit(*edit).is_ok())
            .map(|edit| {
                let moment = &self.moments[edit.moment];
                let resource = moment.barriers[edit.barrier].resource;
                let resource = self.resources[resource].name.clone();
                Superfluous { edit, place: moment.name.clone(), resource }
            })
            .collect()
    }
}
