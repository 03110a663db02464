//! The knobs' sweep for the report, and the counts that do not depend on the machine.

use crate::kernels::{Source, vertices_per_workgroup};
use crate::order::MAX_ORDER;
use crate::settings::{Method, Output, Settings, Storage};

/// Every setting of the error/time curve: orders, storages and methods, for colours under uniform light.
#[must_use]
pub fn sweep() -> Vec<Settings> {
    let mut settings = Vec::new();
    for order in 1..=MAX_ORDER {
        for storage in [Storage::F32, Storage::F16] {
            for method in [Method::Compute, Method::Fragment] {
                settings.push(Settings { order, storage, method, ..Settings::default() });
            }
        }
    }
    settings
}

/// What the kernel over vertices costs on any machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Bytes of baked vectors that are read; also the memory of the mesh, alignment apart.
    pub read: u64,
    /// Bytes written, those of the packed rectangle and its copy included.
    pub written: u64,
    /// Invocations of the compute or fragment stage that belong to a vertex or a pair of vertices.
    pub invocations: u64,
    /// Bytes of memory for the results, and for the packed rectangle.
    pub memory: u64,
}

/// Counts for a mesh of `vertices` vertices, lit by uniform light without dynamic visibility.
#[must_use]
pub fn counts(settings: &Settings, vertices: u32) -> Counts {
    let vertices = u64::from(vertices);
    let results = vertices * settings.output_bytes();
    // The fragment method writes the rectangle and then copies it.
    let images = if settings.method == Method::Fragment { 2 } else { 1 };
    let shared = settings.method == Method::Compute && settings.output == Output::Colour;
    let of_invocation =
        if shared { vertices_per_workgroup(settings, Source::Baked) / crate::kernels::WORKGROUP } else { 1 };
    Counts {
        read: vertices * settings.vector_bytes(),
        written: images * results,
        invocations: vertices.div_ceil(u64::from(of_invocation)),
        memory: images * results,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_those_of_the_kernels() {
        let settings = Settings::default();
        let expected = Counts { read: 6_400_000, written: 1_600_000, invocations: 50_000, memory: 1_600_000 };
        assert_eq!(counts(&settings, 100_000), expected);
        let half = Settings { storage: Storage::F16, method: Method::Fragment, ..settings };
        let expected =
            Counts { read: 3_200_000, written: 3_200_000, invocations: 100_000, memory: 3_200_000 };
        assert_eq!(counts(&half, 100_000), expected);
        assert_eq!(sweep().len(), 24);
    }
}
