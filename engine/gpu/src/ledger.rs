//! Bytes of device memory by owner, so that every pass can be charged with what it holds.

/// What one owner holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnerBytes {
    /// The owner's label, as given when its resources were made.
    pub owner: String,
    /// Bytes of device memory, allocation padding included; imported resources count nothing.
    pub bytes: u64,
    /// How many buffers and images.
    pub objects: u64,
}

/// The account of a context.
#[derive(Default)]
pub(crate) struct Ledger {
    entries: Vec<OwnerBytes>,
}

impl Ledger {
    /// Charges `owner`; the result is the entry to give back to [`Ledger::remove`].
    pub(crate) fn add(&mut self, owner: &str, bytes: u64) -> usize {
        let entry = self.entries.iter().position(|entry| entry.owner == owner).unwrap_or_else(|| {
            self.entries.push(OwnerBytes { owner: owner.to_owned(), bytes: 0, objects: 0 });
            self.entries.len() - 1
        });
        self.entries[entry].bytes += bytes;
        self.entries[entry].objects += 1;
        entry
    }

    pub(crate) fn remove(&mut self, entry: usize, bytes: u64) {
        self.entries[entry].bytes -= bytes;
        self.entries[entry].objects -= 1;
    }

    /// The owners that hold something, by name.
    pub(crate) fn report(&self) -> Vec<OwnerBytes> {
        let mut report: Vec<_> = self.entries.iter().filter(|entry| entry.objects > 0).cloned().collect();
        report.sort_by(|a, b| a.owner.cmp(&b.owner));
        report
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn owners_are_charged_and_released() {
        let mut ledger = Ledger::default();
        let fog = ledger.add("fog", 100);
        let relight = ledger.add("relight", 7);
        assert_eq!(ledger.add("fog", 11), fog);
        ledger.remove(fog, 100);
        ledger.remove(relight, 7);
        assert_eq!(ledger.report(), [OwnerBytes { owner: "fog".into(), bytes: 11, objects: 1 }]);
    }
}
