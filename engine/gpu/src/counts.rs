//! What recorded commands do, in numbers that are the same on every machine.

/// Work that was recorded. Counted while recording, so it is known before the device has done any of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Dispatches, indirect ones included.
    pub dispatches: u64,
    /// Invocations of the dispatches: workgroups times the size that the module states. What an indirect dispatch
    /// adds only the device knows; it is not in here.
    pub invocations: u64,
    /// Draws, each draw of an indirect call included.
    pub draws: u64,
    /// Vertices (or indices) times instances of the draws; without indirect draws.
    pub vertices: u64,
    /// Copies and fills.
    pub copies: u64,
    /// Bytes that copies and fills write.
    pub copied_bytes: u64,
    /// Bytes of all ranges bound: descriptors, vertex and index buffers, attachments. A range that is bound twice
    /// counts twice; how much of it a shader reads only the shader knows.
    pub bound_bytes: u64,
    /// Barriers: those the plan has before the pass, and the pass's own.
    pub barriers: u64,
    /// Bytes of the resources that the pass declares, each once and whole. Zero where commands were recorded without
    /// a plan.
    pub memory_bytes: u64,
}

impl Counts {
    /// Every count with its name, in one order everywhere: text, JSON, CSV.
    pub fn named(&self) -> [(&'static str, u64); 9] {
        [
            ("dispatches", self.dispatches),
            ("invocations", self.invocations),
            ("draws", self.draws),
            ("vertices", self.vertices),
            ("copies", self.copies),
            ("copied_bytes", self.copied_bytes),
            ("bound_bytes", self.bound_bytes),
            ("barriers", self.barriers),
            ("memory_bytes", self.memory_bytes),
        ]
    }

    /// Work of two passes together; memory they share counts twice.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            dispatches: self.dispatches + other.dispatches,
            invocations: self.invocations + other.invocations,
            draws: self.draws + other.draws,
            vertices: self.vertices + other.vertices,
            copies: self.copies + other.copies,
            copied_bytes: self.copied_bytes + other.copied_bytes,
            bound_bytes: self.bound_bytes + other.bound_bytes,
            barriers: self.barriers + other.barriers,
            memory_bytes: self.memory_bytes + other.memory_bytes,
        }
    }

    pub(crate) fn copied(&mut self, bytes: u64) {
        self.copies += 1;
        self.copied_bytes += bytes;
    }
}

#[cfg(test)]
mod tests {
    use super::Counts;

    #[test]
    fn sums_and_names_leave_no_count_out() {
        let ones = Counts {
            dispatches: 1,
            invocations: 1,
            draws: 1,
            vertices: 1,
            copies: 1,
            copied_bytes: 1,
            bound_bytes: 1,
            barriers: 1,
            memory_bytes: 1,
        };
        let sum = ones.and(ones);
        assert!(sum.named().iter().all(|(_, count)| *count == 2), "{sum:?}");
        assert_eq!(size_of::<Counts>(), 8 * sum.named().len());
    }
}
