// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbers of frames as ranges, for people.

/// Formats ascending numbers as ranges, such as `0-2 5`.
pub(crate) fn frame_ranges(frames: &[u64]) -> String {
    let follow = |one: &u64, next: &u64| one + 1 == *next;
    let range = |run: &[u64]| match run {
        [first, .., last] => format!("{first}-{last}"),
        [only] => only.to_string(),
        [] => String::new(),
    };
    frames.chunk_by(follow).map(range).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_follow_each_other_are_a_range() {
        assert_eq!(frame_ranges(&[]), "");
        assert_eq!(frame_ranges(&[7]), "7");
        assert_eq!(frame_ranges(&[0, 1, 2, 5, 8, 9]), "0-2 5 8-9");
    }
}
