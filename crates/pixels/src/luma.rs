// SPDX-License-Identifier: MIT OR Apache-2.0
//! Conversion of colours to luma.

/// Returns the luma of a colour: `(77 R + 150 G + 29 B + 128) >> 8`. Grey keeps its value.
#[inline]
#[must_use]
pub fn luma(red: u16, green: u16, blue: u16) -> u16 {
    let sum = 77 * u32::from(red) + 150 * u32::from(green) + 29 * u32::from(blue) + 128;
    u16::try_from(sum >> 8).expect("the weights sum to 256")
}

/// Appends the [`luma`] of pixels of four bytes: red, green, blue, and an alpha that is ignored.
/// Bytes at the end that are not a whole pixel are left out.
pub fn append_luma_of_rgba(pixels: &[u8], grey: &mut Vec<u8>) {
    // The sum fits into 16 bits, so that the compiler can vectorise the loop.
    let weighted_sum = |&[red, green, blue, _]: &[u8; 4]| {
        let sum = 77 * u16::from(red) + 150 * u16::from(green) + 29 * u16::from(blue) + 128;
        sum.to_be_bytes()[0]
    };
    grey.extend(pixels.as_chunks().0.iter().map(weighted_sum));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luma_follows_the_rule_at_both_depths() {
        assert_eq!(luma(255, 0, 0), 77);
        assert_eq!(luma(0, 255, 0), 149);
        assert_eq!(luma(0, 0, 255), 29);
        assert_eq!(luma(10, 200, 30), (770 + 30_000 + 870 + 128) >> 8);
        assert_eq!(luma(65_535, 0, 0), 19_712);
    }

    #[test]
    fn grey_stays_what_it_is() {
        assert!((0..=u16::MAX).all(|value| luma(value, value, value) == value));
    }

    #[test]
    fn pixels_of_four_bytes_have_the_same_luma_whatever_their_alpha() {
        let mut grey = Vec::new();
        for red in 0..=255u8 {
            let colours = (0..=255u8).step_by(5).flat_map(|green| {
                (0..=255u8).step_by(3).map(move |blue| [red, green, blue, red ^ blue])
            });
            let colours: Vec<[u8; 4]> = colours.collect();
            grey.clear();
            append_luma_of_rgba(colours.as_flattened(), &mut grey);
            let expected = colours.iter().map(|&[r, g, b, _]| luma(r.into(), g.into(), b.into()));
            assert!(grey.iter().map(|&value| u16::from(value)).eq(expected), "red {red}");
        }
        grey.clear();
        append_luma_of_rgba(&[255, 255, 255, 0, 7, 7, 7], &mut grey);
        assert_eq!(grey, [255]);
    }
}
