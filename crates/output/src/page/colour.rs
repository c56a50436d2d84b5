// SPDX-License-Identifier: MIT OR Apache-2.0
//! The colours of a page: those of the palette, as variables and as classes of lines and marks.

use std::fmt::Write as _;

use crate::palette::{ChartStyle, Colour, SERIES};

/// The number of distinguishable colours; further groups have the same colours with square marks.
pub const COLOUR_COUNT: usize = SERIES.len();

/// Returns the class of a group's colour and the shape of its marks. Groups beyond twice
/// [`COLOUR_COUNT`] are grey.
#[must_use]
pub fn group_look(group: usize) -> (String, &'static str) {
    let shape = if (COLOUR_COUNT..2 * COLOUR_COUNT).contains(&group) { "box" } else { "dot" };
    let class = if group < 2 * COLOUR_COUNT { group % COLOUR_COUNT } else { COLOUR_COUNT };
    (format!("k{class}"), shape)
}

/// Returns the colours of a style as variables; those of the series begin at `--k0`.
#[must_use]
pub fn colour_variables(style: &ChartStyle) -> String {
    let mut text = String::new();
    let mut add_variable = |name: &str, [red, green, blue]: Colour| {
        let _ = write!(text, "--{name}:#{red:02x}{green:02x}{blue:02x};");
    };
    add_variable("card", style.background);
    add_variable("ink", style.ink);
    add_variable("quiet", style.secondary);
    add_variable("grid", style.grid);
    for (number, colour) in style.series.into_iter().chain([style.further_series]).enumerate() {
        add_variable(&format!("k{number}"), colour);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_the_colours_of_the_palette() {
        let dark = colour_variables(&crate::palette::DARK);
        assert!(dark.starts_with("--card:#1b1e21;--ink:#e6e4df;"), "{dark}");
        assert!(dark.contains("--k4:#009e73;--k5:#e69f00;--k6:#56b4e9;--k7:#"), "{dark}");
    }

    #[test]
    fn groups_without_a_look_of_their_own_are_grey() {
        let looks = [0, COLOUR_COUNT, 2 * COLOUR_COUNT, 99].map(group_look);
        assert_eq!(looks.each_ref().map(|(class, _)| class.as_str()), ["k0", "k0", "k7", "k7"]);
        assert_eq!(looks.map(|(_, shape)| shape), ["dot", "box", "dot", "dot"]);
    }
}
