//! Receivers that lie together: the workgroups of the kernel, which choose their spheres once for all 64.

/// Receivers of a cluster.
pub const CLUSTER: usize = 64;
/// A place in a cluster without receiver.
pub const NOBODY: u32 = u32::MAX;

/// The receivers in the order of their clusters, [`CLUSTER`] places each: halved along the longest side of their box until
/// they fit. The same for the same positions. Places left over hold [`NOBODY`].
#[must_use]
pub fn slots(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut indices: Vec<u32> = (0..positions.len() as u32).collect();
    let mut slots = Vec::with_capacity(positions.len().next_multiple_of(CLUSTER));
    // Ranges still to be halved; the first half is taken up first.
    let mut open = Vec::from([std::ops::Range { start: 0, end: indices.len() }]);
    while let Some(range) = open.pop() {
        if range.len() > CLUSTER {
            let axis = longest_axis(positions, &indices[range.clone()]);
            // Whole clusters to the left, so that only the last one has places left over.
            let middle = (range.len().div_ceil(CLUSTER) / 2) * CLUSTER;
            let key = |index: &u32| positions.get(*index as usize).map_or(0.0, |position| position[axis]);
            indices[range.clone()]
                .select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
            let split = range.start + middle;
            open.push(split..range.end);
            open.push(range.start..split);
        } else if !range.is_empty() {
            slots.extend_from_slice(&indices[range]);
            slots.resize(slots.len().next_multiple_of(CLUSTER), NOBODY);
        }
    }
    slots
}

fn longest_axis(positions: &[[f32; 3]], indices: &[u32]) -> usize {
    let side = |axis: usize| {
        let values = indices.iter().filter_map(|index| positions.get(*index as usize)).map(|p| p[axis]);
        let (low, high) =
            values.fold((f32::MAX, f32::MIN), |(low, high), value| (low.min(value), high.max(value)));
        high - low
    };
    let sides = [0, 1, 2].map(side);
    if sides[0] >= sides[1] && sides[0] >= sides[2] {
        0
    } else if sides[1] >= sides[2] {
        1
    } else {
        2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_receiver_has_one_place_and_clusters_are_small() {
        let grid: Vec<[f32; 3]> = (0..10_000).map(|i| [(i % 100) as f32, 0.0, (i / 100) as f32]).collect();
        let slots = slots(&grid);
        let mut found: Vec<u32> = slots.iter().copied().filter(|slot| *slot != NOBODY).collect();
        found.sort_unstable();
        assert!(found.iter().copied().eq(0..10_000));
        assert_eq!(slots.len(), 157 * CLUSTER);
        for cluster in slots.chunks(CLUSTER) {
            let side = |axis: usize| {
                let values = cluster.iter().filter_map(|slot| grid.get(*slot as usize)).map(|p| p[axis]);
                values.clone().fold(f32::MIN, f32::max) - values.fold(f32::MAX, f32::min)
            };
            assert!(side(0) < 30.0 && side(2) < 30.0, "{} x {}", side(0), side(2));
        }
    }

    #[test]
    fn equal_and_broken_positions_are_kept() {
        assert!(slots(&[]).is_empty());
        for position in [[0.0; 3], [f32::NAN; 3], [f32::INFINITY; 3]] {
            let slots = slots(&[position; 130]);
            assert_eq!(slots.iter().filter(|slot| **slot != NOBODY).count(), 130);
        }
    }
}
