// SPDX-License-Identifier: MIT OR Apache-2.0
//! The range of the luma of video.

/// The range of the luma of video.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LumaRange {
    /// The luma as it was coded. In most video black is 16 and white is 235, of 8 bits.
    #[default]
    Coded,
    /// The luma with black at 0 and white at the largest value, as players, OpenCV and
    /// `ffmpeg -pix_fmt gray` expand it. Video that is coded with the full range is not changed.
    Full,
}

impl LumaRange {
    /// Returns the name in options and summaries.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Coded => "coded",
            Self::Full => "full",
        }
    }
}

/// Expands a sample of `depth` bits, at least 8, from the narrow range, in which black is 16 and
/// white is 235, of 8 bits. Values outside are limited. Halves are rounded up.
pub(crate) fn expanded(sample: u16, depth: u32) -> u16 {
    let unit = 1_u32 << (depth - 8);
    let (black, white) = (16 * unit, 235 * unit);
    let (span, max) = (white - black, (1_u32 << depth) - 1);
    let above = u32::from(sample).clamp(black, white) - black;
    u16::try_from((above * max + span / 2) / span).expect("it is at most the largest sample")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_and_white_become_the_ends_of_the_range() {
        for depth in 8..=16 {
            let unit = 1_u16 << (depth - 8);
            let max = u16::MAX >> (16 - depth);
            assert_eq!(
                [0, 16 * unit, 235 * unit, max].map(|value| expanded(value, depth)),
                [0, 0, max, max]
            );
            let nearest =
                |value: u16| f64::from(value - 16 * unit) / f64::from(219 * unit) * f64::from(max);
            for value in (16 * unit..=235 * unit).step_by(usize::from(unit)) {
                let error = f64::from(expanded(value, depth)) - nearest(value);
                assert!(error.abs() <= 0.5, "{value} of {depth} bits: {error}");
            }
        }
    }
}
