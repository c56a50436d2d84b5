// SPDX-License-Identifier: MIT OR Apache-2.0
//! Charts as SVG and PNG, from the same drawing. The font is part of the program, so charts look the
//! same on a machine without fonts. Colours are those of the palette; from the eighth series on, lines
//! are dashed.

mod draw;
mod page;

use std::sync::OnceLock;

use ab_glyph::FontRef;
use foveate_palette::Colour;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use plotters::prelude::*;
use plotters::style::register_font;

use crate::StudyError;
use page::Page;

/// Width and height of a chart in pixels.
const SIZE: (u32, u32) = (1000, 560);

/// What is drawn.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    /// The name of its files, without extension.
    pub(crate) file: String,
    pub(crate) title: String,
    /// With its unit, as for the other axis.
    pub(crate) x: String,
    pub(crate) y: String,
    /// Small, at the bottom: program, design and inputs.
    pub(crate) caption: String,
    pub(crate) shape: Shape,
}

#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// Lines over numbers.
    Lines(Vec<Line>),
    /// Groups of bars, one group per name, one bar per series.
    Bars { groups: Vec<String>, series: Vec<Bars> },
}

#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
}

#[derive(Clone, Debug)]
pub(crate) struct Bars {
    pub(crate) name: String,
    pub(crate) colour: Colour,
    pub(crate) values: Vec<f64>,
    /// From and to, a whisker on every bar; or none.
    pub(crate) ranges: Vec<(f64, f64)>,
}

impl Chart {
    /// The chart as SVG, with `notes` as a comment.
    pub(crate) fn svg(&self, notes: &[String]) -> Result<String, StudyError> {
        self.load_font()?;
        let mut text = String::new();
        draw::draw(self, &SVGBackend::with_string(&mut text, SIZE).into_drawing_area())
            .map_err(|error| self.failed(&error))?;
        // Two hyphens end a comment.
        let notes = notes.join("\n").replace("--", "- -");
        Ok(format!("<!--\n{notes}\n-->\n{text}"))
    }

    /// The chart as PNG.
    pub(crate) fn png(&self) -> Result<Vec<u8>, StudyError> {
        self.load_font()?;
        let mut pixels = vec![0; 3 * (SIZE.0 * SIZE.1) as usize];
        let font = FontRef::try_from_slice(dejavu::sans::regular())
            .map_err(|_| self.failed(&"the font is damaged"))?;
        let page = Page { pixels: &mut pixels, size: SIZE, font };
        draw::draw(self, &page.into_drawing_area()).map_err(|error| self.failed(&error))?;
        let mut file = Vec::new();
        PngEncoder::new(&mut file)
            .write_image(&pixels, SIZE.0, SIZE.1, ExtendedColorType::Rgb8)
            .map_err(|error| self.failed(&error))?;
        Ok(file)
    }

    fn load_font(&self) -> Result<(), StudyError> {
        static LOADED: OnceLock<bool> = OnceLock::new();
        let load =
            || register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular()).is_ok();
        if *LOADED.get_or_init(load) { Ok(()) } else { Err(self.failed(&"the font is damaged")) }
    }

    fn failed(&self, problem: &dyn std::fmt::Display) -> StudyError {
        StudyError::Chart { name: self.file.clone(), problem: problem.to_string() }
    }
}
