// SPDX-License-Identifier: MIT OR Apache-2.0
//! Shares as text and as coordinates of charts. They are integers until the last step, so that
//! every machine writes the same digits.

/// Returns `part / whole` in millionths, rounded to the nearest; 0 if `whole` is 0.
fn millionths(part: u64, whole: u64) -> u32 {
    let whole = u128::from(whole.max(1));
    u32::try_from((u128::from(part) * 1_000_000 + whole / 2) / whole)
        .expect("a part is no more than the whole")
}

/// Formats a share with six digits after the decimal point.
pub(crate) fn share_text(part: u64, whole: u64) -> String {
    let value = millionths(part, whole);
    format!("{}.{:06}", value / 1_000_000, value % 1_000_000)
}

/// Returns a share in percent, for a chart.
pub(crate) fn percent(part: u64, whole: u64) -> f64 {
    f64::from(millionths(part, whole)) / 1e4
}

/// Converts a count to a coordinate, exact up to 2^32.
pub(crate) fn coordinate(value: u64) -> f64 {
    f64::from(u32::try_from(value).unwrap_or(u32::MAX))
}

/// Counts the regions with a vote.
pub(crate) fn count_votes(votes: &[bool]) -> u64 {
    votes.iter().map(|&vote| u64::from(vote)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_rounded_to_six_digits() {
        assert_eq!(
            [share_text(1, 3), share_text(2, 3), share_text(3, 3)],
            ["0.333333", "0.666667", "1.000000"]
        );
        assert_eq!((share_text(0, 0).as_str(), percent(1, 8)), ("0.000000", 12.5));
    }
}
