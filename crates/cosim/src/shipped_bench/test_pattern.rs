// SPDX-License-Identifier: MIT OR Apache-2.0
//! Test pictures of one region: patterns in which every feature finds much, and one in which it
//! finds nothing.

use crate::stimulus::Random;

/// A pattern that fills a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TestPattern {
    /// Independent random pixels.
    Noise,
    /// Random squares of 2x2 pixels, which a median filter keeps.
    Blocks,
    /// Pixels that are randomly 0 or the largest pixel.
    Binary,
    /// Squares of `.0` pixels a side, alternately dark and bright.
    Checkers(usize),
    /// Dark and bright columns, each `.0` pixels wide.
    Columns(usize),
    /// Dark and bright rows, each `.0` pixels high.
    Rows(usize),
    /// Bright squares of `.0` pixels a side, with a period of `.1` pixels.
    Dots(usize, usize),
    /// A dark left half and a bright right half, which give the largest deviations.
    Halves,
    /// One bright quadrant.
    Quadrant,
    /// A ramp that becomes brighter from the upper left to the lower right corner.
    Ramp,
    /// A single gray level.
    Flat,
}

/// The patterns with some structure; those with the most different values come first.
pub(super) const STRUCTURED_PATTERNS: &[TestPattern] = &[
    TestPattern::Noise,
    TestPattern::Blocks,
    TestPattern::Binary,
    TestPattern::Ramp,
    TestPattern::Quadrant,
    TestPattern::Dots(1, 3),
    TestPattern::Dots(3, 5),
    TestPattern::Dots(2, 4),
    TestPattern::Halves,
    TestPattern::Checkers(1),
    TestPattern::Checkers(2),
    TestPattern::Columns(1),
    TestPattern::Columns(2),
    TestPattern::Rows(1),
    TestPattern::Rows(2),
    TestPattern::Checkers(3),
];

impl TestPattern {
    /// Returns the pattern as `side` x `side` pixels up to `max`, row by row; `is_negative` swaps
    /// dark and bright.
    pub(crate) fn draw(
        self,
        side: usize,
        max: u16,
        is_negative: bool,
        random: &mut Random,
    ) -> Vec<u16> {
        let seed = random.next();
        let any = |x: usize, y: usize, max: u16| {
            let place = seed ^ (y * side + x) as u64;
            Random::new(place.wrapping_mul(0x9e37_79b9_7f4a_7c15)).pixel(max)
        };
        let extreme = |is_bright: bool| if is_bright { max } else { 0 };
        let pixel = |x: usize, y: usize| match self {
            Self::Noise => any(x, y, max),
            Self::Blocks => any(x / 2 * 2, y / 2 * 2, max),
            Self::Binary => extreme(any(x, y, 1) == 1),
            Self::Checkers(size) => extreme((x / size + y / size) % 2 == 1),
            Self::Columns(width) => extreme(x / width % 2 == 1),
            Self::Rows(height) => extreme(y / height % 2 == 1),
            Self::Dots(size, apart) => extreme(x % apart < size && y % apart < size),
            Self::Halves => extreme(x >= side / 2),
            Self::Quadrant => extreme(x < side / 2 && y < side / 2),
            Self::Ramp => {
                let steps = 2 * side - 2;
                u16::try_from(usize::from(max) * (x + y) / steps).expect("no more than the largest")
            }
            Self::Flat => max / 3,
        };
        let places = (0..side * side).map(|at| (at % side, at / side));
        let signed = |value: u16| if is_negative { max - value } else { value };
        places.map(|(x, y)| signed(pixel(x, y))).collect()
    }
}
