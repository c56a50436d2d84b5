// SPDX-License-Identifier: MIT OR Apache-2.0
//! The widths of registers that follow from the largest values.

/// Returns the bits of an unsigned register that holds every value in `0..=max`. It is at least 1.
#[must_use]
pub const fn bits_for(max: u64) -> u32 {
    if max == 0 { 1 } else { u64::BITS - max.leading_zeros() }
}

/// Returns the bits of a number in `0..n`: the smallest `b` with `2^b >= n`.
#[must_use]
pub const fn index_bits(n: u64) -> u32 {
    if n <= 1 { 0 } else { bits_for(n - 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_hold_their_maximum_and_not_one_bit_more() {
        for (max, bits) in [(0, 1), (1, 1), (2, 2), (63, 6), (64, 7), (255, 8), (256, 9)] {
            assert_eq!(bits_for(max), bits);
        }
        assert_eq!([1, 2, 3, 4, 5, 64, 65].map(index_bits), [0, 1, 2, 2, 3, 6, 7]);
    }
}
