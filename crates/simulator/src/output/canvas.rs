// SPDX-License-Identifier: MIT OR Apache-2.0
//! A colour picture to draw on, and the common layout of pictures of regions: the frame, enlarged
//! if it is small, above a footer for a legend.

use foveate_camera::Camera;
use foveate_output::{lettering, palette::Colour};

pub(super) const BACKGROUND: Colour = [16, 16, 16];
pub(super) const TEXT: Colour = [230, 230, 230];

/// The width up to which frames are enlarged, by a whole factor.
const MIN_ENLARGED_WIDTH: u32 = 448;
/// The largest height of an enlarged frame.
const MAX_ENLARGED_HEIGHT: u32 = 1024;
/// The side up to which regions with arrows are enlarged, by a whole factor.
const MIN_ARROW_CELL: u32 = 16;
/// The colour of the stripes of a hatching, and their opacity.
const STRIPE: Colour = [120; 3];
const HATCHING: f64 = 0.6;
/// The height of capitals, and of marks beside them, in dots.
pub(super) const TEXT_DOTS: u32 = 5;
/// The height of a line of text in dots.
pub(super) const LINE_DOTS: u32 = 9;
/// The size of letters in dots. Capitals have 0.73 of it.
const EM_DOTS: u32 = 7;
/// The number of dots across, from which the size of a dot follows.
const DOTS_ACROSS: u32 = 220;
/// The width that a legend needs, in dots.
const LEGEND_DOTS: u32 = 150;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PictureLayout {
    /// The number of pixels of the picture per pixel of the frame, along each side.
    pub(super) scale: u32,
    /// The number of pixels per dot, in which legends are measured, along each side.
    pub(super) dot: u32,
    pub(super) width: u32,
    /// The height of the enlarged frame, where the footer begins.
    pub(super) frame_height: u32,
    pub(super) frame_width: u32,
}

impl PictureLayout {
    /// Returns the layout of the pictures of a camera. Its regions have space for arrows if it
    /// finds displacements.
    pub(super) fn of_camera(camera: &Camera) -> Self {
        let space = camera.displacement_feature().map(|_| MIN_ARROW_CELL);
        let least = space.map_or(1, |side| side.div_ceil(camera.region_size()));
        Self::enlarged(camera.width(), camera.height(), least)
    }

    /// Returns the left, top, width and height of the region in a column and row, whose regions have a
    /// side of `cell` in the picture. Those at the right and bottom edge may be smaller.
    pub(super) fn region_area(self, cell: u32, (column, row): (u32, u32)) -> [u32; 4] {
        let (left, top) = (column * cell, row * cell);
        let (width, height) = (self.frame_width - left, self.frame_height - top);
        [left, top, cell.min(width), cell.min(height)]
    }

    /// Returns the layout of pictures of a frame whose pixels are enlarged by `least` or more, unless
    /// the picture becomes too high.
    fn enlarged(width: u32, height: u32, least: u32) -> Self {
        let wanted = MIN_ENLARGED_WIDTH.div_ceil(width).max(least);
        let scale = wanted.min(MAX_ENLARGED_HEIGHT / height).max(1);
        let (frame_width, frame_height) = (width * scale, height * scale);
        let dot = (frame_width / DOTS_ACROSS).clamp(1, 4);
        Self { scale, dot, width: frame_width.max(LEGEND_DOTS), frame_height, frame_width }
    }
}

/// A colour picture.
pub(super) struct PictureCanvas {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) rgb: Vec<u8>,
}

impl PictureCanvas {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self { width, height, rgb: BACKGROUND.repeat(pixels) }
    }

    /// Fills the part of a rectangle that lies on the picture.
    pub(super) fn fill_rectangle(
        &mut self,
        left: u32,
        top: u32,
        width: u32,
        height: u32,
        colour: Colour,
    ) {
        let right = left.saturating_add(width).min(self.width);
        let bottom = top.saturating_add(height).min(self.height);
        for y in top..bottom {
            let row = y as usize * self.width as usize;
            let pixels = 3 * (row + left.min(right) as usize)..3 * (row + right as usize);
            for pixel in self.rgb[pixels].chunks_exact_mut(3) {
                pixel.copy_from_slice(&colour);
            }
        }
    }

    /// Mixes a pixel with a colour: 0 leaves it, and 1 replaces it. Nothing happens beyond the picture.
    pub(super) fn blend(&mut self, x: u32, y: u32, colour: Colour, share: f64) {
        if x >= self.width || y >= self.height {
            return;
        }
        let at = 3 * (y as usize * self.width as usize + x as usize);
        let pixel = &mut self.rgb[at..at + 3];
        let own = [pixel[0], pixel[1], pixel[2]];
        pixel.copy_from_slice(&mix(own, colour, share));
    }

    /// Draws the border of a rectangle on its inside.
    pub(super) fn draw_border(&mut self, at: [u32; 4], line: u32, colour: Colour) {
        let [left, top, width, height] = at;
        let line = line.min(width).min(height);
        self.fill_rectangle(left, top, width, line, colour);
        self.fill_rectangle(left, top + height - line, width, line, colour);
        self.fill_rectangle(left, top, line, height, colour);
        self.fill_rectangle(left + width - line, top, line, height, colour);
    }

    /// Draws every fourth diagonal stripe of an area in grey.
    pub(super) fn hatch(&mut self, [left, top, width, height]: [u32; 4], dot: u32) {
        for y in top..top + height {
            for x in (left..left + width).filter(|x| ((x + y) / dot).is_multiple_of(4)) {
                self.blend(x, y, STRIPE, HATCHING);
            }
        }
    }

    /// Draws a line of text whose capitals have a height of [`TEXT_DOTS`]. Returns the column at which
    /// it ends.
    pub(super) fn draw_text(&mut self, left: u32, top: u32, dot: u32, text: &str) -> u32 {
        let place = (left, top + TEXT_DOTS * dot);
        let blend = |x, y, share| self.blend(x, y, TEXT, share);
        left + lettering::draw_text(text, EM_DOTS * dot, place, blend)
    }
}

/// Returns the width of a text in pixels.
pub(super) fn text_width(text: &str, dot: u32) -> u32 {
    lettering::text_width(text, EM_DOTS * dot)
}

/// Returns the mixture of two colours: the first for a share of 0, and the second for 1.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a mixture of two bytes is a byte"
)]
pub(super) fn mix(one: Colour, other: Colour, share: f64) -> Colour {
    std::array::from_fn(|at| {
        let mixed = f64::from(one[at]) * (1.0 - share) + f64::from(other[at]) * share;
        mixed.round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_frames_are_enlarged_to_448_pixels_or_more() {
        let sizes = [(224, 224), (300, 200), (320, 240), (447, 300), (448, 300), (28, 28)];
        let scales = sizes.map(|(width, height)| PictureLayout::enlarged(width, height, 1).scale);
        assert_eq!(scales, [2, 2, 2, 2, 1, 16]);
        let scale = PictureLayout::enlarged(100, 600, 1).scale;
        assert_eq!(scale, 1, "no picture is higher than 1024 for that");
    }

    #[test]
    fn arrows_have_space_in_regions_of_16_pixels() {
        let sizes = [(640, 480, 2), (640, 480, 4), (1280, 720, 2), (64, 48, 2)];
        let scales =
            sizes.map(|(width, height, least)| PictureLayout::enlarged(width, height, least).scale);
        assert_eq!(scales, [2, 2, 1, 7]);
    }
}
