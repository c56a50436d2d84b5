// SPDX-License-Identifier: MIT OR Apache-2.0
//! Spearman's rank correlation.

/// Returns the correlation of the ranks of two series, -1..=1; equal values share the mean of their
/// ranks. Returns `None` if the series differ in length, or if all values of one of them are equal.
#[must_use]
pub fn spearman(a: &[u64], b: &[u64]) -> Option<f64> {
    if a.len() != b.len() {
        return None;
    }
    let (a, b) = (doubled_ranks(a), doubled_ranks(b));
    // Doubled ranks are integers, and their sum is too; the mean of n doubled ranks is n + 1.
    let middle = i128::try_from(a.len()).ok()? + 1;
    let sum = |x: &[i128], y: &[i128]| -> i128 {
        x.iter().zip(y).map(|(x, y)| (x - middle) * (y - middle)).sum()
    };
    let (both, own_a, own_b) = (sum(&a, &b), sum(&a, &a), sum(&b, &b));
    #[allow(clippy::cast_precision_loss, reason = "a correlation is printed with a few digits")]
    let result = both as f64 / ((own_a as f64).sqrt() * (own_b as f64).sqrt());
    (own_a > 0 && own_b > 0).then_some(result)
}

/// Returns twice the rank of every value.
fn doubled_ranks(values: &[u64]) -> Vec<i128> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by_key(|&at| values[at]);
    let mut ranks = vec![0; values.len()];
    let mut before = 0_i128;
    for same in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let count = same.len() as i128;
        for &at in same {
            ranks[at] = 2 * before + count + 1;
        }
        before += count;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_correlations() {
        let near = |value: Option<f64>, expected: f64| (value.unwrap() - expected).abs() < 1e-12;
        assert!(near(spearman(&[1, 5, 900], &[0, 1, 2]), 1.0));
        assert!(near(spearman(&[1, 2, 3], &[9, 5, 1]), -1.0));
        assert!(near(spearman(&[1, 2, 3, 4, 5], &[5, 6, 7, 8, 7]), 0.820_782_681_668_123_3));
        assert_eq!(spearman(&[1, 1], &[1, 2]), None);
        assert_eq!(spearman(&[1], &[1, 2]), None);
        assert_eq!(spearman(&[], &[]), None);
    }
}
