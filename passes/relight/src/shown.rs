//! What a frame does without although its plan has it: instances that are hidden, shadows that nothing moving casts, a
//! light that is out.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use airglow_graph::LeftOut;

use crate::RelightError;

/// What of a prepared frame is shown: its light, its instances, and the dynamic visibility of these. Nothing is recorded
/// for what is not, and it changes no plan, makes no pipeline and allocates nothing.
#[derive(Clone, Debug)]
pub struct Shown(Arc<State>);

#[derive(Debug)]
struct State {
    lit: AtomicBool,
    instances: Vec<Flags>,
}

#[derive(Debug)]
struct Flags {
    shown: AtomicBool,
    shadowed: AtomicBool,
    /// Whether the frame has dynamic visibility for it.
    has_visibility: bool,
    /// Whether its kernel takes product matrices even without dynamic visibility.
    takes_matrices: bool,
}

impl Shown {
    /// All is shown. Of each instance: whether it has dynamic visibility, and whether it takes product matrices without.
    pub(crate) fn all(instances: impl Iterator<Item = (bool, bool)>) -> Self {
        let flags = |(has_visibility, takes_matrices)| Flags {
            shown: AtomicBool::new(true),
            shadowed: AtomicBool::new(true),
            has_visibility,
            takes_matrices,
        };
        Self(Arc::new(State { lit: AtomicBool::new(true), instances: instances.map(flags).collect() }))
    }

    /// Shows or hides an instance, by its index in the frame, from the next recording on. Results of one that is hidden are
    /// not to be read.
    ///
    /// # Errors
    /// [`RelightError::Size`] for an index past the instances.
    pub fn set(&self, instance: usize, shown: bool) -> Result<(), RelightError> {
        self.flags(instance).map(|flags| flags.shown.store(shown, Ordering::Relaxed))
    }

    /// Says whether the dynamic visibility of an instance blocks anything, by its index in the frame, from the next
    /// recording on. Where it does not, the kernel without it runs and the buffer is not read; without any, product
    /// matrices that nothing else takes are not made. For an instance without dynamic visibility it is nothing.
    ///
    /// # Errors
    /// [`RelightError::Size`] for an index past the instances.
    pub fn set_shadowed(&self, instance: usize, shadowed: bool) -> Result<(), RelightError> {
        self.flags(instance).map(|flags| flags.shadowed.store(shadowed, Ordering::Relaxed))
    }

    /// Puts the light on or out, from the next recording on. While it is out nothing is recorded: results are not to be
    /// read, all is black.
    pub fn set_lit(&self, lit: bool) {
        self.0.lit.store(lit, Ordering::Relaxed);
    }

    /// What the next recording does without, why, and what would bring it back. No part of a plan, which stays.
    #[must_use]
    pub fn left_out(&self) -> Vec<LeftOut> {
        let record = |what: String, why: &str, would_return: &str| LeftOut {
            what,
            why: why.to_owned(),
            bytes: 0,
            time: None,
            would_return: would_return.to_owned(),
        };
        let count = self.0.instances.len();
        if !self.is_lit() {
            return vec![record("relight".to_owned(), "the light is out", "Shown::set_lit")];
        }
        let away = |flag: fn(&Flags) -> bool| self.0.instances.iter().filter(|flags| flag(flags)).count();
        let hidden = away(|flags| !is(&flags.shown));
        let open = away(|flags| is(&flags.shown) && flags.has_visibility && !is(&flags.shadowed));
        let hidden = (hidden > 0).then(|| {
            record(format!("relight of {hidden} of {count} instances"), "they are hidden", "Shown::set")
        });
        let open = (open > 0).then(|| {
            let (why, back) = ("nothing that moves blocks their light", "Shown::set_shadowed");
            record(format!("relight visibility of {open} of {count} instances"), why, back)
        });
        hidden.into_iter().chain(open).collect()
    }

    fn flags(&self, instance: usize) -> Result<&Flags, RelightError> {
        self.0.instances.get(instance).ok_or_else(|| RelightError::Size {
            name: "the frame".to_owned(),
            what: "an index of an instance",
            actual: instance as u64,
            allowed: format!("below {}", self.0.instances.len()),
        })
    }

    /// Whether anything is recorded.
    pub(crate) fn is_lit(&self) -> bool {
        is(&self.0.lit)
    }

    /// Whether work is done for an instance, by the kernel with dynamic visibility or by the one without.
    pub(crate) fn takes(&self, instance: u32, shadowed: bool) -> bool {
        let flags = self.0.instances.get(instance as usize);
        flags.is_some_and(|flags| {
            is(&flags.shown) && (flags.has_visibility && is(&flags.shadowed)) == shadowed
        })
    }

    /// Whether some instance that is shown takes a product matrix.
    pub(crate) fn takes_matrices(&self) -> bool {
        self.0.instances.iter().any(|flags| {
            is(&flags.shown) && (flags.takes_matrices || flags.has_visibility && is(&flags.shadowed))
        })
    }
}

fn is(flag: &AtomicBool) -> bool {
    flag.load(Ordering::Relaxed)
}
