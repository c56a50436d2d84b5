// SPDX-License-Identifier: MIT OR Apache-2.0
//! The document of a page: its heading, style and script around its content.

use crate::palette::{DARK, LIGHT};
use crate::xml_text;
use askama::Template;

use super::PageError;
use super::colour::colour_variables;

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
