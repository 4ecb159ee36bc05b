//! What nothing else beats in both speed and error.

/// Which of some points (cost, error) are on the Pareto front: no other is at most as large in both
/// and less in one. Of equal points all are.
#[must_use]
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let beats = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    points
        .iter()
        .map(|point| !points.iter().any(|other| beats(other, point)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::front;

    #[test]
    fn what_another_beats_is_not_on_it() {
        let points = [(1.0, 4.0), (2.0, 2.0), (2.0, 3.0), (3.0, 2.0), (4.0, 0.0)];
        assert_eq!(front(&points), [true, true, false, false, true]);
    }

    #[test]
    fn equal_points_do_not_beat_each_other() {
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0)]), [true, true]);
    }
}
