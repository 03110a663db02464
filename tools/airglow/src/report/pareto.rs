//! The Pareto front: settings that no other setting beats in both cost and error.

/// Indices of the points on the front, from the cheapest on. A point belongs to it if no other point has
/// both a cost and an error at most as large and one of them smaller; not-a-number never belongs.
pub fn front(cost_and_error: &[(f64, f64)]) -> Vec<usize> {
    let finite = |&(cost, error): &(f64, f64)| !cost.is_nan() && !error.is_nan();
    let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1);
    let mut front: Vec<usize> = (0..cost_and_error.len())
        .filter(|&i| finite(&cost_and_error[i]))
        .filter(|&i| !cost_and_error.iter().any(|&other| finite(&other) && beats(other, cost_and_error[i])))
        .collect();
    front.sort_by(|&a, &b| cost_and_error[a].0.total_cmp(&cost_and_error[b].0));
    front
}

#[cfg(test)]
mod tests {
    use super::front;

    #[test]
    fn beaten_points_are_off_the_front() {
        let points = [(1.0, 8.0), (2.0, 4.0), (3.0, 5.0), (4.0, 1.0), (f64::NAN, 0.0), (4.0, 2.0)];
        assert_eq!(front(&points), [0, 1, 3]);
    }

    #[test]
    fn equal_points_share_the_front() {
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0)]), [0, 1]);
    }
}
