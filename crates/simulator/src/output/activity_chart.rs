// SPDX-License-Identifier: MIT OR Apache-2.0
//! The share of active regions from the first frame to the current one, as bars below a picture.
//!
//! A bar is one frame until the chart is full. Then each two bars become one, with the mean of
//! both, and so on. So the chart shows the whole clip in constant memory, whatever its length.

use foveate_pictures::palette::Colour;

use super::canvas::{PictureCanvas, PictureLayout};

/// The colour of the line at one half.
const HALF_LINE_COLOUR: Colour = [70, 70, 70];

/// The bars so far.
pub(super) struct ActivityChart {
    /// The number of active regions of all frames of each bar. Only the last bar may have fewer
    /// frames than the others.
    bars: Vec<u64>,
    frames_per_bar: u64,
    frames_in_last: u64,
}

impl Default for ActivityChart {
    fn default() -> Self {
        Self { bars: Vec::new(), frames_per_bar: 1, frames_in_last: 1 }
    }
}

impl ActivityChart {
    /// The height in dots.
    pub(super) const HEIGHT_DOTS: u32 = 32;

    /// Returns the width of a bar in pixels.
    pub(super) fn bar_width(layout: PictureLayout) -> u32 {
        2 * layout.dot
    }

    /// Adds a frame to a chart of at most `most` bars.
    pub(super) fn push(&mut self, active: u64, most: usize) {
        if self.frames_in_last < self.frames_per_bar {
            self.frames_in_last += 1;
            if let Some(last) = self.bars.last_mut() {
                *last += active;
            }
            return;
        }
        if self.bars.len() >= most.max(2) {
            let remainder = self.bars.len() % 2;
            self.bars = self.bars.chunks(2).map(|pair| pair.iter().sum()).collect();
            self.frames_per_bar *= 2;
            // An odd last bar was merged with no other, so it has room for more frames.
            if remainder == 1 {
                self.frames_in_last = self.frames_per_bar / 2;
                return self.push(active, most);
            }
        }
        self.bars.push(active);
        self.frames_in_last = 1;
    }

    /// Draws the bars at the bottom of a picture. A frame has `regions` regions.
    pub(super) fn draw(
        &self,
        canvas: &mut PictureCanvas,
        layout: PictureLayout,
        regions: u64,
        colour: Colour,
    ) {
        let (bottom, height) = (canvas.height, Self::HEIGHT_DOTS * layout.dot);
        let bar = Self::bar_width(layout);
        canvas.fill_rectangle(0, bottom - height / 2, canvas.width, 1, HALF_LINE_COLOUR);
        let last = self.bars.len().saturating_sub(1);
        for (index, (&active, left)) in
            self.bars.iter().zip((0..).step_by(bar as usize)).enumerate()
        {
            let frames = if index == last { self.frames_in_last } else { self.frames_per_bar };
            let bar_height = active * u64::from(height) / (regions * frames);
            // A bar with any active region is visible.
            let bar_height =
                u32::try_from(bar_height).expect("no more regions are active than there are");
            let bar_height = bar_height.max(u32::from(active > 0));
            canvas.fill_rectangle(left, bottom - bar_height, bar, bar_height, colour);
        }
        let right = canvas.width.saturating_sub(4 * 4 * layout.dot);
        canvas.draw_text(right, bottom - height, layout.dot, "100%");
        canvas.draw_text(right, bottom - height / 2 + layout.dot, layout.dot, " 50%");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_counts_once_however_many_there_are() {
        for most in [2, 5, 8] {
            let mut chart = ActivityChart::default();
            for frame in 1..=100u64 {
                chart.push(frame, most);
                assert!(chart.bars.len() <= most, "{most} bars, {frame} frames");
                assert_eq!(chart.bars.iter().sum::<u64>(), frame * (frame + 1) / 2);
                let whole = chart.bars.len() as u64 - 1;
                assert_eq!(whole * chart.frames_per_bar + chart.frames_in_last, frame);
                let first: u64 = (1..=frame.min(chart.frames_per_bar)).sum();
                assert_eq!(chart.bars[0], first);
            }
        }
    }
}
