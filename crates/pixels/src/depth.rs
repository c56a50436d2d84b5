// SPDX-License-Identifier: MIT OR Apache-2.0
//! Conversion of pixels from one number of bits to another, and the depth at which they are
//! displayed.
//!
//! A conversion to fewer bits drops the low bits. A conversion to more bits repeats the bits below
//! themselves as often as needed. So zero stays zero, full scale becomes full scale, and the
//! conversion back gives the same value.

/// Converts `value` from `from` bits to `to` bits; both numbers of bits are in 1..=16.
#[inline]
#[must_use]
pub fn convert_depth(value: u16, from: u32, to: u32) -> u16 {
    if to <= from {
        return value >> (from - to);
    }
    let mut repeated = u32::from(value);
    let mut bits = from;
    while bits < to {
        repeated = repeated << from | u32::from(value);
        bits += from;
    }
    u16::try_from(repeated >> (bits - to)).expect("at most 16 bits remain")
}

/// Returns the bits per pixel of a PNG that shows pixels of `bits` bits: 8 for up to 8 bits,
/// otherwise 16.
#[must_use]
pub fn display_depth(bits: u32) -> u32 {
    if bits <= 8 { 8 } else { 16 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_conversion_to_fewer_bits_drops_the_low_bits() {
        assert_eq!(convert_depth(0xABCD, 16, 8), 0xAB);
        assert_eq!(convert_depth(0xABCD, 16, 12), 0xABC);
        assert_eq!(convert_depth(0xFF, 8, 1), 1);
        assert_eq!(convert_depth(0x7F, 8, 1), 0);
    }

    #[test]
    fn a_conversion_to_more_bits_repeats_the_bits() {
        assert_eq!(convert_depth(0xAB, 8, 16), 0xABAB);
        assert_eq!(convert_depth(0xAB, 8, 12), 0xABA);
        assert_eq!(convert_depth(0b101, 3, 8), 0b1011_0110);
        assert_eq!(convert_depth(1, 1, 16), 0xFFFF);
    }

    #[test]
    fn a_conversion_keeps_ends_and_order_and_can_be_undone() {
        for from in 1..=16 {
            let max = u16::MAX >> (16 - from);
            for to in from..=16 {
                assert_eq!(convert_depth(0, from, to), 0);
                assert_eq!(convert_depth(max, from, to), u16::MAX >> (16 - to));
                let mut last = None;
                for value in 0..=max {
                    let wide = convert_depth(value, from, to);
                    assert_eq!(convert_depth(wide, to, from), value, "{from} -> {to} bits");
                    assert!(last < Some(wide));
                    last = Some(wide);
                }
            }
        }
    }
}
