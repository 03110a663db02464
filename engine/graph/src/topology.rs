//! A key of what was declared, so that a host that declares the same frame again can keep its plan.

use crate::declaration::LeftOut;
use crate::graph::Graph;
use std::hash::{DefaultHasher, Hash, Hasher};

/// A 128-bit hash of everything declared but the payloads: resources, uses, exports, what was left out.
///
/// Equal keys mean equal plans under equal [`Limits`](crate::Limits) and [`Options`](crate::Options). For use
/// within one process: another build of the library may hash otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Topology(u128);

impl<R> Graph<R> {
    /// The key of the declaration as it stands. Payloads are not in it: a plan that is kept keeps its own.
    pub fn topology(&self) -> Topology {
        let hash = |salt: u8| {
            let mut hasher = DefaultHasher::new();
            salt.hash(&mut hasher);
            self.declaration.hash(&mut hasher);
            u128::from(hasher.finish())
        };
        Topology(hash(0) << 64 | hash(1))
    }
}

impl Hash for LeftOut {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let Self { what, why, bytes, time, would_return } = self;
        (what, why, bytes, time.map(f64::to_bits), would_return).hash(state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Access, BufferDesc, PassKind};

    fn declare(size: u64, access: Access, payload: u32) -> Graph<u32> {
        let mut graph = Graph::new();
        let mut pass = graph.pass("write", PassKind::Compute);
        let buffer = pass.create_buffer("buffer", BufferDesc::new(size), Access::ComputeStorageWrite);
        pass.record(payload);
        graph.export(buffer, access);
        graph
    }

    #[test]
    fn the_key_changes_with_the_declaration_and_not_with_the_payload() {
        let key = declare(4, Access::VertexBuffer, 1).topology();
        assert_eq!(key, declare(4, Access::VertexBuffer, 2).topology());
        let mut left_out = declare(4, Access::VertexBuffer, 1);
        left_out.leave_out(LeftOut {
            what: "fog".to_owned(),
            why: "no medium".to_owned(),
            bytes: 0,
            time: None,
            would_return: "a medium".to_owned(),
        });
        let others =
            [declare(8, Access::VertexBuffer, 1), declare(4, Access::ComputeStorageRead, 1), left_out];
        for other in others {
            assert_ne!(key, other.topology());
        }
    }
}
