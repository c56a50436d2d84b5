// SPDX-License-Identifier: MIT OR Apache-2.0
//! A page around what it shows: heading, style and script.

use crate::palette::{DARK, LIGHT};
use crate::xml;
use askama::Template;

use super::PageError;
use super::colour::variables;

/// A figure of the heading.
#[derive(Clone, Debug)]
pub struct Fact {
    /// What it is.
    pub name: &'static str,
    /// As it is read.
    pub value: String,
    /// Smaller, beneath it.
    pub note: String,
}

/// Something that a reader must know first.
#[derive(Clone, Debug)]
pub struct Notice<'a> {
    /// What kind of thing.
    pub title: &'static str,
    /// Sentences.
    pub lines: &'a [String],
}

/// Where the figures of a mark lead to: the element whose id is the mark's with this before it.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Before the id.
    pub prefix: &'static str,
    /// What is there, such as `its row`.
    pub name: &'static str,
}

/// A page. What is said to be HTML comes from a template, which escapes.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// What kind of result it shows.
    pub kind: &'static str,
    /// The program with its version.
    pub program: &'a str,
    /// Its heading.
    pub title: &'a str,
    /// In boxes, below the heading; those without lines are left out.
    pub notices: &'a [Notice<'a>],
    /// Figures below them.
    pub facts: &'a [Fact],
    /// HTML after the figures.
    pub about: &'a str,
    /// HTML of the sections.
    pub main: &'a str,
    /// HTML at the end.
    pub footer: &'a str,
    /// Where marks lead to.
    pub targets: &'a [Target],
    /// More of the script, which may use `all(selector, inside)`.
    pub script: &'a str,
}

#[derive(Template)]
#[template(path = "page.html")]
struct Whole<'a> {
    page: &'a Page<'a>,
    /// Colours as variables, on a light ground and on a dark one.
    light: String,
    dark: String,
}

impl Page<'_> {
    /// The whole page.
    ///
    /// # Errors
    /// When it cannot be rendered.
    pub fn render(&self) -> Result<String, PageError> {
        let (light, dark) = (variables(&LIGHT), variables(&DARK));
        let whole = Whole { page: self, light, dark };
        whole
            .render()
            .map(xml::document)
            .map_err(|error| PageError { page: self.title.to_owned(), problem: error.to_string() })
    }
}
