// SPDX-License-Identifier: MIT OR Apache-2.0
//! Luma of a mosaic of colours, as a sensor with a Bayer filter gives it.
//!
//! The two colours that a pixel lacks are the mean of those of the nearest pixels that have them:
//! four or two, halves rounded up. Beyond the edge lies the mirror image of the frame, so that the
//! second row follows the first again. Red, green and blue then become luma by [`luma`].

use std::fmt;

use foveate_pixels::luma;

/// The colours of the upper left 2x2 pixels of a mosaic, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BayerPattern {
    /// Red and green, then green and blue.
    Rggb,
    /// Blue and green, then green and red.
    Bggr,
    /// Green and red, then blue and green.
    Grbg,
    /// Green and blue, then red and green.
    Gbrg,
}

impl BayerPattern {
    /// All patterns.
    pub const ALL: [Self; 4] = [Self::Rggb, Self::Bggr, Self::Grbg, Self::Gbrg];

    /// Returns the name in options: the colours in order.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rggb => "rggb",
            Self::Bggr => "bggr",
            Self::Grbg => "grbg",
            Self::Gbrg => "gbrg",
        }
    }

    /// Returns the column and row, each 0 or 1, of the red pixel.
    fn red_place(self) -> (usize, usize) {
        match self {
            Self::Rggb => (0, 0),
            Self::Bggr => (1, 1),
            Self::Grbg => (1, 0),
            Self::Gbrg => (0, 1),
        }
    }
}

impl fmt::Display for BayerPattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The smallest width and height of a mosaic.
pub(crate) const MIN_MOSAIC_SIDE: usize = 2;

/// Returns the luma of a mosaic of `width` columns. Both sides have at least [`MIN_MOSAIC_SIDE`]
/// pixels.
pub(crate) fn luma_of_mosaic(samples: &[u16], width: usize, pattern: BayerPattern) -> Vec<u16> {
    let height = samples.len() / width;
    let (red_x, red_y) = pattern.red_place();
    let mut pixels = Vec::with_capacity(samples.len());
    for y in 0..height {
        let rows = [mirrored_before(y), y, mirrored_after(y, height)].map(|row| row * width);
        for x in 0..width {
            let columns = [mirrored_before(x), x, mirrored_after(x, width)];
            let at = |row: usize, column: usize| u32::from(samples[rows[row] + columns[column]]);
            let own = samples[rows[1] + x];
            let across = mean([at(1, 0), at(1, 2)]);
            let along = mean([at(0, 1), at(2, 1)]);
            pixels.push(match (x % 2 == red_x, y % 2 == red_y) {
                (true, false) => luma(along, own, across),
                (false, true) => luma(across, own, along),
                (is_red, _) => {
                    let green = mean([at(0, 1), at(1, 0), at(1, 2), at(2, 1)]);
                    let other = mean([at(0, 0), at(0, 2), at(2, 0), at(2, 2)]);
                    if is_red { luma(own, green, other) } else { luma(other, green, own) }
                }
            });
        }
    }
    pixels
}

fn mirrored_before(place: usize) -> usize {
    place.checked_sub(1).unwrap_or(1)
}

fn mirrored_after(place: usize, count: usize) -> usize {
    if place + 1 < count { place + 1 } else { count - 2 }
}

/// Returns the mean of two or four samples, halves rounded up.
fn mean<const N: usize>(samples: [u32; N]) -> u16 {
    let count = u32::try_from(N).expect("it is 2 or 4");
    let sum: u32 = samples.iter().sum();
    u16::try_from((sum + count / 2) / count).expect("a mean is no larger than the samples")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the mosaic of a frame of colours, given as a function of column and row.
    fn mosaic(
        pattern: BayerPattern,
        (width, height): (usize, usize),
        colours: impl Fn(usize, usize) -> [u16; 3],
    ) -> Vec<u16> {
        let channel = |x: usize, y: usize| match pattern.name().as_bytes()[x % 2 + 2 * (y % 2)] {
            b'r' => 0,
            b'g' => 1,
            _ => 2,
        };
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        places.map(|(x, y)| colours(x, y)[channel(x, y)]).collect()
    }

    #[test]
    fn a_frame_of_one_colour_has_its_luma_everywhere() {
        for pattern in BayerPattern::ALL {
            for size in [(2, 2), (3, 2), (2, 5), (7, 6)] {
                let samples = mosaic(pattern, size, |_, _| [200, 100, 40]);
                let pixels = luma_of_mosaic(&samples, size.0, pattern);
                assert_eq!(pixels, vec![luma(200, 100, 40); size.0 * size.1], "{pattern} {size:?}");
            }
        }
    }

    #[test]
    fn colours_that_change_evenly_are_exact_inside() {
        let colours = |x: usize, y: usize| {
            let [x, y] = [x, y].map(|place| u16::try_from(place).unwrap());
            [1000 + 8 * x, 500 + 2 * y, 3000 - 4 * x + 6 * y]
        };
        for pattern in BayerPattern::ALL {
            let pixels = luma_of_mosaic(&mosaic(pattern, (10, 8), colours), 10, pattern);
            for (x, y) in (1..7).flat_map(|y| (1..9).map(move |x| (x, y))) {
                let [red, green, blue] = colours(x, y);
                assert_eq!(pixels[10 * y + x], luma(red, green, blue), "{pattern} at ({x}, {y})");
            }
        }
    }

    #[test]
    fn halves_are_rounded_up_and_edges_are_mirrored() {
        // Row 0 is R G R, row 1 is G B G.
        let samples = [10, 20, 31, 40, 50, 61];
        let pixels = luma_of_mosaic(&samples, 3, BayerPattern::Rggb);
        assert_eq!(pixels[0], luma(10, 30, 50));
        assert_eq!(pixels[1], luma(21, 20, 50));
        assert_eq!(pixels[4], luma(21, 35, 50));
    }
}
