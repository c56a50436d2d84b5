// SPDX-License-Identifier: MIT OR Apache-2.0
//! The legend below a picture: marks with words, in as many lines as they need.

use foveate_output::palette::Colour;

use super::arrow::Arrow;
use super::canvas::{LINE_DOTS, PictureCanvas, PictureLayout, TEXT, TEXT_DOTS, text_width};

/// The space between two keys in dots.
const SPACE_DOTS: u32 = 4;

/// The mark of a key.
#[derive(Clone, Copy, Debug)]
pub(super) enum LegendMark {
    /// A square of a colour with a border of another one.
    Filled(Colour, Colour),
    /// The border of a square.
    Border(Colour),
    /// A hatched square.
    Hatched,
    Arrow(Colour),
}

/// A mark and what it means.
#[derive(Clone, Debug)]
pub(super) struct LegendKey {
    pub(super) mark: LegendMark,
    pub(super) text: String,
    /// The longest text that the key may have in another frame.
    pub(super) longest: String,
}

impl LegendKey {
    pub(super) fn new(mark: LegendMark, text: &str) -> Self {
        Self { mark, text: text.to_owned(), longest: text.to_owned() }
    }

    fn width(&self, dot: u32) -> u32 {
        text_width(&self.longest, dot) + (self.mark.width_dots() + 2) * dot
    }
}

impl LegendMark {
    fn width_dots(self) -> u32 {
        if matches!(self, Self::Arrow(_)) { 2 * TEXT_DOTS } else { TEXT_DOTS }
    }

    fn draw(self, canvas: &mut PictureCanvas, left: u32, top: u32, dot: u32) {
        let side = TEXT_DOTS * dot;
        let (area, line) = ([left, top, side, side], dot.div_ceil(2));
        match self {
            Self::Filled(colour, border) => {
                canvas.fill_rectangle(left, top, side, side, colour);
                canvas.draw_border(area, line, border);
            }
            Self::Border(colour) => canvas.draw_border(area, line, colour),
            Self::Hatched => {
                canvas.fill_rectangle(left, top, side, side, [128; 3]);
                canvas.hatch(area, dot);
            }
            Self::Arrow(colour) => {
                let [start, top, side] = [left, top, side].map(f64::from);
                let middle = top + side / 2.0;
                let (tail, tip) = ([start, middle], [start + 2.0 * side, middle]);
                Arrow { tail, tip, head_width: side }.draw(canvas, colour, 1.0);
            }
        }
    }
}

/// The keys of a picture, each with its place.
pub(super) struct Legend {
    keys: Vec<(LegendKey, u32, u32)>,
    dot: u32,
    pub(super) height: u32,
}

impl Legend {
    /// Places the keys below the frame of a picture.
    pub(super) fn new(keys: Vec<LegendKey>, layout: PictureLayout) -> Self {
        let dot = layout.dot;
        let (start, mut top) = (2 * dot, layout.frame_height + 2 * dot);
        let mut left = start;
        let mut placed = Vec::new();
        for key in keys {
            let width = key.width(dot);
            if left > start && left + width > layout.width {
                (left, top) = (start, top + LINE_DOTS * dot);
            }
            placed.push((key, left, top));
            left += width + SPACE_DOTS * dot;
        }
        let height = top + (LINE_DOTS - 2) * dot - layout.frame_height;
        Self { keys: placed, dot, height }
    }

    pub(super) fn draw(&self, canvas: &mut PictureCanvas) {
        let dot = self.dot;
        for &(LegendKey { mark, ref text, .. }, left, top) in &self.keys {
            mark.draw(canvas, left, top, dot);
            canvas.draw_text(left + (mark.width_dots() + 2) * dot, top, dot, text);
        }
    }
}

/// The marks of what is sent as a whole, and of what is not sent.
pub(super) const SENT: LegendMark = LegendMark::Filled([235; 3], TEXT);
pub(super) const NOT_SENT: LegendMark = LegendMark::Filled([48; 3], [120; 3]);
