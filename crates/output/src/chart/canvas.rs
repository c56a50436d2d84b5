// SPDX-License-Identifier: MIT OR Apache-2.0
//! The canvas of a PNG: the pixels that a chart is drawn on.
//!
//! Lines and rectangles are drawn by `plotters`. Text is set here, on a baseline as in the SVG: the
//! bitmap backend of `plotters` 0.3.7 places every letter by its own height, which lifts `.` and
//! `,` off the line. Dots are drawn round here, too.

use std::convert::Infallible;
use std::ops::Range;

use ab_glyph::{Font, FontRef, Glyph};
use plotters::style::text_anchor::{HPos, VPos};
use plotters_backend::rasterizer::draw_rect;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};

use crate::lettering::place_letters;

/// The ratio of the text size in `plotters` to the em.
const SIZE_OF_EM: f32 = 1.24;

/// The unfinished picture of a chart: red, green and blue of each pixel, in row-major order from
/// the top.
pub(crate) struct ChartCanvas<'a> {
    pub(crate) pixels: &'a mut [u8],
    pub(crate) size: (u32, u32),
    pub(crate) font: FontRef<'static>,
}

type CanvasResult = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for ChartCanvas<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> CanvasResult {
        Ok(())
    }

    fn present(&mut self) -> CanvasResult {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> CanvasResult {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return Ok(()) };
        if x < self.size.0 && y < self.size.1 {
            let (red, green, blue) = colour.rgb;
            let at = 3 * (y as usize * self.size.0 as usize + x as usize);
            for (below, above) in self.pixels[at..at + 3].iter_mut().zip([red, green, blue]) {
                *below = mixed_value(*below, above, colour.alpha);
            }
        }
        Ok(())
    }

    /// Fills a rectangle. An opaque one is copied row by row and not mixed pixel by pixel, because
    /// whole pages are filled, too.
    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> CanvasResult {
        let colour = style.color();
        if !fill || colour.alpha < 1.0 {
            return draw_rect(self, from, to, style, fill);
        }
        self.fill_opaque(from, to, colour.rgb);
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> CanvasResult {
        // A ring extends half of its line width beyond its radius. The coverage of a pixel changes
        // from 1 to 0 over the width of a pixel across the border, which smooths it.
        let half_stroke = f64::from(style.stroke_width()) / 2.0;
        let reach = i32::try_from(radius + style.stroke_width()).unwrap_or(i32::MAX - 1) + 1;
        for (dx, dy) in (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy))) {
            let inside = f64::from(radius) - f64::from(dx).hypot(f64::from(dy));
            let coverage = 0.5 + if fill { inside } else { half_stroke - inside.abs() };
            let colour = style.color();
            let alpha = colour.alpha * coverage.clamp(0.0, 1.0);
            self.draw_pixel((x + dx, y + dy), BackendColor { alpha, ..colour })?;
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (x, y): BackendCoord,
    ) -> CanvasResult {
        let (glyphs, transform) = (self.place_letters(text, style), style.transform());
        for glyph in glyphs {
            let Some(outline) = self.font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            let mut covered_pixels = Vec::new();
            outline.draw(|dx, dy, coverage| covered_pixels.push((dx, dy, coverage)));
            for (dx, dy, coverage) in covered_pixels {
                let (dx, dy) =
                    transform.transform(dot_position(corner.x, dx), dot_position(corner.y, dy));
                let colour = style.color();
                let alpha = colour.alpha * f64::from(coverage.clamp(0.0, 1.0));
                self.draw_pixel((x + dx, y + dy), BackendColor { alpha, ..colour })?;
            }
        }
        Ok(())
    }
}

impl ChartCanvas<'_> {
    /// Fills a rectangle with a colour, including its corners.
    fn fill_opaque(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        (red, green, blue): (u8, u8, u8),
    ) {
        let (width, height) = self.size;
        let columns = clipped_range(from.0, to.0, width);
        let row = [red, green, blue].repeat(columns.len());
        for y in clipped_range(from.1, to.1, height) {
            let at = 3 * (y * width as usize + columns.start);
            self.pixels[at..at + row.len()].copy_from_slice(&row);
        }
    }

    /// Places the letters of a text on their baseline, relative to its anchor, as in an SVG.
    fn place_letters<S: BackendTextStyle>(&self, text: &str, style: &S) -> Vec<Glyph> {
        #[allow(clippy::cast_possible_truncation, reason = "sizes of letters")]
        let em = style.size() as f32 / SIZE_OF_EM;
        let baseline = match style.anchor().v_pos {
            VPos::Top => 0.76 * em,
            VPos::Center => 0.27 * em,
            VPos::Bottom => -0.27 * em,
        };
        let (mut glyphs, width) = place_letters(&self.font, text, em, baseline);
        let left = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Right => width,
            HPos::Center => width / 2.0,
        };
        glyphs.iter_mut().for_each(|glyph| glyph.position.x -= left);
        glyphs
    }
}

/// Returns the position of a dot of a letter; the bounds of letters are whole numbers.
#[allow(clippy::cast_possible_truncation, reason = "places on the page")]
fn dot_position(corner: f32, step: u32) -> i32 {
    (corner.round() as i32).saturating_add_unsigned(step)
}

/// Returns the pixel positions between two ends in any order, limited to the `end` pixels of the
/// canvas.
fn clipped_range(a: i32, b: i32, end: u32) -> Range<usize> {
    let place = |at: i64| usize::try_from(at.clamp(0, end.into())).unwrap_or(usize::MAX);
    place(a.min(b).into())..place(i64::from(a.max(b)) + 1)
}

/// Returns the mix of two values, in which `above` has the weight `alpha`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
fn mixed_value(below: u8, above: u8, alpha: f64) -> u8 {
    (f64::from(below) + (f64::from(above) - f64::from(below)) * alpha).round() as u8
}

#[cfg(test)]
mod tests {
    use crate::lettering::picture_font;

    use plotters::prelude::*;

    use super::*;

    /// A rectangle over any edge of the canvas, with its corners in any order, equals that of the
    /// rasterizer of `plotters`.
    #[test]
    fn an_opaque_rectangle_equals_that_of_the_rasterizer() {
        let coordinates = [-3, -1, 0, 2, 6, 7, 8, 12];
        let pairs = || coordinates.into_iter().flat_map(|a| coordinates.map(|b| (a, b)));
        for ((x0, x1), (y0, y1)) in pairs().flat_map(|x| pairs().map(move |y| (x, y))) {
            let pixels_of = |draw: fn(&mut ChartCanvas<'_>, BackendCoord, BackendCoord)| {
                let mut pixels = vec![9; 3 * 7 * 8];
                let font = picture_font().unwrap();
                draw(
                    &mut ChartCanvas { pixels: &mut pixels, size: (7, 8), font },
                    (x0, y0),
                    (x1, y1),
                );
                pixels
            };
            let ours =
                pixels_of(|page, from, to| page.draw_rect(from, to, &RED.filled(), true).unwrap());
            let theirs =
                pixels_of(|page, from, to| draw_rect(page, from, to, &RED.filled(), true).unwrap());
            assert_eq!(ours, theirs, "{x0}..{x1}, {y0}..{y1}");
        }
    }

    /// Returns the rows with ink of a text at 20, 20 on white.
    fn inked_rows(text: &str, size: u32) -> Vec<usize> {
        let (width, height) = (80, 60);
        let mut pixels = vec![255; 3 * width * height];
        let font = picture_font().unwrap();
        let page = ChartCanvas { pixels: &mut pixels, size: (80, 60), font };
        let area = page.into_drawing_area();
        let style = ("sans-serif", size).into_font().color(&BLACK);
        area.draw(&Text::new(text.to_owned(), (20, 20), style)).unwrap();
        drop(area);
        let dark = |row: &[u8]| row.iter().any(|&value| value < 128);
        (0..height).filter(|y| dark(&pixels[3 * width * y..3 * width * (y + 1)])).collect()
    }

    #[test]
    fn points_and_commas_stand_on_the_baseline_of_digits() {
        for size in 11..=30 {
            let [digit, point, comma] = ["1", ".", ","].map(|text| inked_rows(text, size));
            // Half-covered rows may count for one text and not for the other.
            let last = |rows: &[usize]| *rows.last().unwrap();
            assert!(last(&digit).abs_diff(last(&point)) <= 1, "size {size}");
            assert!(last(&comma) + 1 >= last(&digit), "size {size}");
            assert!(digit.len() > 2 * point.len(), "size {size}: {} {}", digit.len(), point.len());
        }
    }
}
