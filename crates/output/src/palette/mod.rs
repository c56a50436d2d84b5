// SPDX-License-Identifier: MIT OR Apache-2.0
//! Colours by meaning: active regions have the same colour in pictures, charts and pages.
//!
//! The colours are those of Okabe and Ito, which can be distinguished with any colour vision.
//! Yellow is left out, because it is hard to see on white. [`vision`] simulates colour vision, for
//! tests.

pub mod vision;

/// A colour as red, green and blue, 0 to 255 each (sRGB).
pub type Colour = [u8; 3];

/// The colour of relevant and changed regions (SRS and TRS): bluish green.
pub const ACTIVE: Colour = [0, 158, 115];
/// A brighter green, for outlines of active regions and for their share on a dark background.
pub const ACTIVE_BRIGHT: Colour = [70, 230, 180];
/// The colour of relevance (SRS): orange. A single region in it is relevant but unchanged.
pub const RELEVANT: Colour = [230, 159, 0];
/// The colour of change (TRS): sky blue. A single region in it changed but is not relevant.
pub const CHANGED: Colour = [86, 180, 233];

/// The colours of series without a meaning of their own, such as clips or designs, in order.
/// Colours with a meaning come last.
pub const SERIES: [Colour; 7] =
    [[0, 114, 178], [213, 94, 0], [204, 121, 167], [0, 0, 0], ACTIVE, RELEVANT, CHANGED];

/// The colours of a chart in a file or on a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChartStyle {
    /// The background.
    pub background: Colour,
    /// The colour of titles, axes and outlines.
    pub ink: Colour,
    /// The colour of secondary text.
    pub secondary: Colour,
    /// The colour of the grid, behind everything.
    pub grid: Colour,
    /// The colour of each series, in order.
    pub series: [Colour; SERIES.len()],
    /// The colour of all further series, which cannot be distinguished.
    pub further_series: Colour,
}

/// The style on a light background: for files, print, and pages in light mode.
pub const LIGHT: ChartStyle = ChartStyle {
    background: [255, 255, 255],
    ink: [0, 0, 0],
    secondary: [90, 90, 90],
    grid: [225, 225, 225],
    series: SERIES,
    further_series: [160, 164, 169],
};

/// The style on a dark background, for pages in dark mode. The series are those of [`LIGHT`],
/// except that black becomes white.
pub const DARK: ChartStyle = ChartStyle {
    background: [27, 30, 33],
    ink: [230, 228, 223],
    secondary: [154, 161, 168],
    grid: [39, 43, 47],
    series: {
        let mut series = SERIES;
        series[3] = [255, 255, 255];
        series
    },
    further_series: [109, 114, 120],
};

#[cfg(test)]
mod tests {
    use super::vision::{VISIONS, distance};
    use super::*;

    #[test]
    fn colours_are_distinguishable_with_any_colour_vision() {
        for (vision, style) in VISIONS.into_iter().flat_map(|v| [(v, LIGHT), (v, DARK)]) {
            for (index, &first) in style.series.iter().enumerate() {
                for &second in &style.series[..index] {
                    let difference = distance(first, second, vision);
                    assert!(difference > 30.0, "{first:?} {second:?}: {difference}");
                }
                let difference = distance(first, style.background, vision);
                assert!(
                    difference > 60.0,
                    "{first:?} is lost on {:?}: {difference}",
                    style.background
                );
            }
        }
    }

    #[test]
    fn a_series_has_one_colour_on_every_background() {
        for (light, dark) in LIGHT.series.into_iter().zip(DARK.series) {
            assert!(light == dark || (light, dark) == ([0; 3], [255; 3]), "{light:?} {dark:?}");
        }
    }

    #[test]
    fn colours_with_a_meaning_come_last() {
        let first = |colour| SERIES.iter().position(|&other| other == colour);
        assert!([ACTIVE, RELEVANT, CHANGED].into_iter().all(|colour| first(colour) >= Some(4)));
    }
}
