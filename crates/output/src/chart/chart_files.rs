// SPDX-License-Identifier: MIT OR Apache-2.0
//! The two files of a chart: SVG and PNG.

use std::sync::OnceLock;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use plotters::prelude::*;
use plotters::style::register_font;

use super::canvas::ChartCanvas;
use super::chart_data::SIZE;
use super::{Chart, ChartError, drawing};
use crate::lettering::picture_font;
use crate::xml_text;

impl Chart {
    /// Returns the chart as SVG, with `notes` as a comment.
    ///
    /// # Errors
    /// Fails if the chart cannot be drawn.
    pub fn to_svg(&self, notes: &[String]) -> Result<String, ChartError> {
        self.load_font()?;
        let mut text = String::new();
        drawing::draw(self, &SVGBackend::with_string(&mut text, SIZE).into_drawing_area())
            .map_err(|error| self.chart_error(&error))?;
        let notes = xml_text::comment_text(&notes.join("\n"));
        Ok(xml_text::valid_document(format!("<!--\n{notes}\n-->\n{text}")))
    }

    /// Returns the chart as PNG.
    ///
    /// # Errors
    /// Fails if the chart cannot be drawn.
    pub fn to_png(&self) -> Result<Vec<u8>, ChartError> {
        self.load_font()?;
        let mut pixels = vec![0; 3 * (SIZE.0 * SIZE.1) as usize];
        let font = picture_font().map_err(|_| self.chart_error(&"the font is damaged"))?;
        let page = ChartCanvas { pixels: &mut pixels, size: SIZE, font };
        drawing::draw(self, &page.into_drawing_area()).map_err(|error| self.chart_error(&error))?;
        let mut file = Vec::new();
        PngEncoder::new(&mut file)
            .write_image(&pixels, SIZE.0, SIZE.1, ExtendedColorType::Rgb8)
            .map_err(|error| self.chart_error(&error))?;
        Ok(file)
    }

    fn load_font(&self) -> Result<(), ChartError> {
        static LOADED: OnceLock<bool> = OnceLock::new();
        let load =
            || register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular()).is_ok();
        if *LOADED.get_or_init(load) {
            Ok(())
        } else {
            Err(self.chart_error(&"the font is damaged"))
        }
    }

    fn chart_error(&self, problem: &dyn std::fmt::Display) -> ChartError {
        ChartError { name: self.file_stem.clone(), problem: problem.to_string() }
    }
}
