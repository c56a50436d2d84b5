// SPDX-License-Identifier: MIT OR Apache-2.0
//! The document of a page ([`ResultPage`]): its heading, style and script around its content.
//! The style has the colours of the palette, as variables ([`colour_variables`]) and as classes
//! of lines and marks ([`group_look`]).

use crate::palette::{ChartStyle, Colour, DARK, LIGHT, SERIES};
use crate::xml_text;
use askama::Template;
use std::fmt::Write as _;
use thiserror::Error;

/// A figure of the heading.
#[derive(Clone, Debug)]
pub struct HeadingFigure {
    /// The name of the figure.
    pub name: &'static str,
    /// The value as text.
    pub value: String,
    /// A small text below the value.
    pub note: String,
}

/// An important message to the reader.
#[derive(Clone, Debug)]
pub struct PageNotice<'a> {
    /// The kind of the message.
    pub title: &'static str,
    /// The sentences of the message.
    pub lines: &'a [String],
}

/// A link target for the figures of a mark: the element whose id is this prefix and the id of the
/// mark.
#[derive(Clone, Copy, Debug)]
pub struct LinkTarget {
    /// The prefix before the id.
    pub prefix: &'static str,
    /// The name of the target for the reader, such as `its row`.
    pub name: &'static str,
}

/// A page. Fields that are HTML come from a template, which escapes text.
#[derive(Clone, Debug)]
pub struct ResultPage<'a> {
    /// The kind of result that the page shows.
    pub kind: &'static str,
    /// The name of the program with its version.
    pub program: &'a str,
    /// The heading of the page.
    pub title: &'a str,
    /// The boxes below the heading; those without lines are left out.
    pub notices: &'a [PageNotice<'a>],
    /// The figures below the boxes.
    pub facts: &'a [HeadingFigure],
    /// The HTML after the figures.
    pub about: &'a str,
    /// The HTML of the sections.
    pub main: &'a str,
    /// The HTML at the end.
    pub footer: &'a str,
    /// The link targets of marks.
    pub targets: &'a [LinkTarget],
    /// A further script, which may use `all(selector, inside)`.
    pub script: &'a str,
}

#[derive(Template)]
#[template(path = "page.html")]
struct PageTemplate<'a> {
    page: &'a ResultPage<'a>,
    /// The colours as variables, for a light and for a dark background.
    light: String,
    dark: String,
}

impl ResultPage<'_> {
    /// Renders the whole page.
    ///
    /// # Errors
    /// Fails if the page cannot be rendered.
    pub fn render(&self) -> Result<String, PageError> {
        let (light, dark) = (colour_variables(&LIGHT), colour_variables(&DARK));
        let template = PageTemplate { page: self, light, dark };
        template
            .render()
            .map(xml_text::valid_document)
            .map_err(|error| PageError { page: self.title.to_owned(), problem: error.to_string() })
    }
}

/// A page cannot be written.
#[derive(Debug, Error)]
#[error("cannot write the page `{page}`: {problem}")]
pub struct PageError {
    /// The title of the page.
    pub page: String,
    /// The problem.
    pub problem: String,
}

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
        let dark = colour_variables(&DARK);
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
