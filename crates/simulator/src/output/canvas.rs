// SPDX-License-Identifier: MIT OR Apache-2.0
//! A colour picture to draw on, and the common layout of pictures of regions: the frame, enlarged
//! if it is small, above a footer for a legend.

use foveate_pictures::palette::Colour;

use super::font;

pub(super) const BACKGROUND: Colour = [16, 16, 16];
pub(super) const TEXT: Colour = [230, 230, 230];

/// The width up to which frames are enlarged, by a whole factor.
const MIN_ENLARGED_WIDTH: u32 = 448;
/// The largest height of an enlarged frame.
const MAX_ENLARGED_HEIGHT: u32 = 1024;
/// The number of dots across, from which the size of a dot follows.
const DOTS_ACROSS: u32 = 220;
/// The width that a legend needs, in dots.
const LEGEND_DOTS: u32 = 150;

/// The layout of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PictureLayout {
    /// The number of pixels of the picture per pixel of the frame, along each side.
    pub(super) scale: u32,
    /// The number of pixels per dot of a letter, along each side.
    pub(super) dot: u32,
    pub(super) width: u32,
    /// The height of the enlarged frame, where the footer begins.
    pub(super) frame_height: u32,
    pub(super) frame_width: u32,
}

impl PictureLayout {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let scale = MIN_ENLARGED_WIDTH.div_ceil(width).min(MAX_ENLARGED_HEIGHT / height).max(1);
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

    /// Draws the border of a rectangle on its inside.
    pub(super) fn draw_border(&mut self, at: [u32; 4], line: u32, colour: Colour) {
        let [left, top, width, height] = at;
        let line = line.min(width).min(height);
        self.fill_rectangle(left, top, width, line, colour);
        self.fill_rectangle(left, top + height - line, width, line, colour);
        self.fill_rectangle(left, top, line, height, colour);
        self.fill_rectangle(left + width - line, top, line, height, colour);
    }

    /// Draws a line of text with `dot` pixels per dot. Returns the column at which it ends.
    pub(super) fn draw_text(&mut self, left: u32, top: u32, dot: u32, text: &str) -> u32 {
        let mut at = left;
        for letter in text.chars() {
            for (x, y) in (0..font::SIZE.1).flat_map(|y| (0..font::SIZE.0).map(move |x| (x, y))) {
                if font::has_dot(letter, x, y) {
                    self.fill_rectangle(at + x * dot, top + y * dot, dot, dot, TEXT);
                }
            }
            at += (font::SIZE.0 + 1) * dot;
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_frames_are_enlarged_to_448_pixels_or_more() {
        let sizes = [(224, 224), (300, 200), (320, 240), (447, 300), (448, 300), (28, 28)];
        let scales = sizes.map(|(width, height)| PictureLayout::new(width, height).scale);
        assert_eq!(scales, [2, 2, 2, 2, 1, 16]);
        assert_eq!(
            PictureLayout::new(100, 600).scale,
            1,
            "no picture is higher than 1024 for that"
        );
    }
}
