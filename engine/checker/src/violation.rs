//! What the checker refuses, where, and how to mend it.

/// What kind of thing is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A read that does not wait for a write, or to which the write is not available and visible.
    ReadAfterWrite,
    /// A write that does not wait for a read.
    WriteAfterRead,
    /// A write that does not wait for a write, or comes before that is available and visible.
    WriteAfterWrite,
    /// A layout transition or ownership transfer that does not wait for an access.
    Transition,
    /// An image in another layout than a use, a barrier or the host wants.
    Layout,
    /// A use of contents that nobody wrote, that were dropped, or that are of another version.
    Contents,
    /// A resource not left as the host asked.
    Exit,
    /// A transfer between queue families that does not match its other half, or a use without ownership.
    Ownership,
    /// A use whose stages, accesses or layout are not those of what it says it is.
    Use,
    /// Transients in one place at once, or one that does not wait for its predecessor there.
    Sharing,
    /// A barrier or use that names what is not there.
    Structure,
}

/// One thing wrong with a plan.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: `{resource}` mip {mip} layer {layer}: {problem}; {mend}")]
pub struct Violation {
    /// What kind of thing is wrong.
    pub kind: Kind,
    /// The pass at fault, or the moment before or after the passes.
    pub place: String,
    /// The resource.
    pub resource: String,
    /// The mip level.
    pub mip: u32,
    /// The array layer.
    pub layer: u32,
    /// What is wrong.
    pub problem: String,
    /// What to change.
    pub mend: String,
}
