//! What can be wrong with a declaration, and how to mend it.

/// Why a graph does not compile. Each message names the passes and the resource, and ends with the mend.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GraphError {
    /// A description no device could meet, or past [`Limits`](crate::Limits).
    #[error("resource `{resource}`: {problem}; {mend}")]
    Resource {
        /// The resource.
        resource: String,
        /// What is wrong.
        problem: String,
        /// What to change.
        mend: String,
    },
    /// A pass that cannot be recorded, or a use that makes no sense.
    #[error("pass `{pass}`: {problem}; {mend}")]
    Pass {
        /// The pass.
        pass: String,
        /// What is wrong.
        problem: String,
        /// What to change.
        mend: String,
    },
    /// An export that makes no sense.
    #[error("export of `{resource}`: {problem}; {mend}")]
    Export {
        /// The resource.
        resource: String,
        /// What is wrong.
        problem: String,
        /// What to change.
        mend: String,
    },
    /// Two passes write from the same version, so that one's result would be lost.
    #[error(
        "passes `{first}` and `{second}` both write version {version} of `{resource}`; let `{second}` write the handle that `{first}` returned"
    )]
    TwoWriters {
        /// The resource.
        resource: String,
        /// The version both write.
        version: u32,
        /// The pass declared first.
        first: String,
        /// The pass declared second.
        second: String,
    },
    /// A pass writes from a version that later versions have replaced.
    #[error(
        "pass `{pass}` writes version {version} of `{resource}`, but `{newest_writer}` has already made version {newest}; write the handle that `{newest_writer}` returned"
    )]
    WriteToOldVersion {
        /// The resource.
        resource: String,
        /// The version written from.
        version: u32,
        /// The pass at fault.
        pass: String,
        /// The newest version at that point.
        newest: u32,
        /// The pass that made it.
        newest_writer: String,
    },
    /// A read of contents nobody wrote.
    #[error(
        "pass `{pass}` reads `{resource}` (version {version}, mip {mip}, layer {layer}), which nothing has written by then; write it in an earlier pass and read the handle that returns, import it with contents, or use an access that does not keep the old contents"
    )]
    ReadOfNeverWritten {
        /// The resource.
        resource: String,
        /// The version read.
        version: u32,
        /// The first mip without contents.
        mip: u32,
        /// The first layer without contents.
        layer: u32,
        /// The pass that reads.
        pass: String,
    },
    /// A version was exported and then overwritten.
    #[error(
        "pass `{pass}` writes `{resource}` after its version {version}{} was exported; export the handle that `{pass}` returned, or copy the version before it is overwritten",
        .exported_writer.as_ref().map(|w| format!(" (by `{w}`)")).unwrap_or_default()
    )]
    UseAfterExport {
        /// The resource.
        resource: String,
        /// The exported version.
        version: u32,
        /// The pass that made the exported version, if one did.
        exported_writer: Option<String>,
        /// The pass that overwrites it.
        pass: String,
    },
    /// A read of an old version that no order of the passes can place before its overwriting.
    #[error(
        "pass `{reader}` reads version {version} of `{resource}`, must therefore run before `{writer}` overwrites it, and yet depends on what `{writer}` makes; read a newer version, or copy the old one before `{writer}`"
    )]
    Cycle {
        /// The resource.
        resource: String,
        /// The version read.
        version: u32,
        /// The pass that reads the old version.
        reader: String,
        /// The pass that overwrites it.
        writer: String,
    },
}
