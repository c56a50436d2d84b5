// SPDX-License-Identifier: MIT OR Apache-2.0
//! Colours by meaning: active regions have the same colour in pictures, charts and pages.
//!
//! The colours are those of Okabe and Ito, which can be distinguished with any colour vision. Yellow is
//! left out, because it is hard to see on white. [`vision`] simulates colour vision, for tests.

pub mod vision;

/// Red, green and blue, 0 to 255 each (sRGB).
pub type Colour = [u8; 3];

/// Relevant and changed (SRS and TRS): bluish green.
pub const ACTIVE: Colour = [0, 158, 115];
/// A brighter green, for outlines of active regions and for their share on a dark ground.
pub const ACTIVE_BRIGHT: Colour = [70, 230, 180];
/// Relevant (SRS); of a single region: relevant, but unchanged. Orange.
pub const RELEVANT: Colour = [230, 159, 0];
/// Changed (TRS); of a single region: changed, but not relevant. Sky blue.
pub const CHANGED: Colour = [86, 180, 233];

/// Series without a meaning of their own, such as clips or designs, in order. Colours that mean something
/// come last.
pub const SERIES: [Colour; 7] =
    [[0, 114, 178], [213, 94, 0], [204, 121, 167], [0, 0, 0], ACTIVE, RELEVANT, CHANGED];

#[cfg(test)]
mod tests {
    use super::vision::{VISIONS, distance};
    use super::*;

    #[test]
    fn colours_can_be_told_apart_with_any_colour_vision() {
        for vision in VISIONS {
            for (index, &first) in SERIES.iter().enumerate() {
                for &second in &SERIES[..index] {
                    let seen = distance(first, second, vision);
                    assert!(seen > 30.0, "{first:?} {second:?}: {seen}");
                }
                assert!(distance(first, [255; 3], vision) > 60.0, "{first:?} is lost on white");
            }
        }
    }

    #[test]
    fn meanings_come_last() {
        let first = |colour| SERIES.iter().position(|&other| other == colour);
        assert!([ACTIVE, RELEVANT, CHANGED].into_iter().all(|colour| first(colour) >= Some(4)));
    }
}
