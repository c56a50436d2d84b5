// SPDX-License-Identifier: MIT OR Apache-2.0
//! The share of active regions from the first frame to the current one, as bars below a picture.
//!
//! A bar is one frame until the chart is full. Then each two bars become one, with the mean of
//! both, and so on. So the chart shows the whole clip in constant memory, whatever its length. Its bars
//! fill the width, and its scale is the smallest one for all bars but the first.

use foveate_output::palette::{ACTIVE_BRIGHT, Colour};

use super::canvas::{BACKGROUND, LINE_DOTS, PictureCanvas, PictureLayout, TEXT_DOTS, text_width};

/// The colour of the lines at the upper end of the scale and at its half.
const LINE_COLOUR: Colour = [70, 70, 70];

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
    /// The height of the bars in dots.
    const BAR_DOTS: u32 = 28;
    pub(super) const HEIGHT_DOTS: u32 = LINE_DOTS + Self::BAR_DOTS;
    /// The upper ends of the scale, in permille. The smallest one that no bar passes is taken.
    const SCALES: [u64; 7] = [10, 20, 50, 100, 200, 500, 1000];

    /// Returns the largest number of bars, each of which has two dots or more.
    pub(super) fn most_bars(layout: PictureLayout) -> usize {
        (layout.width / (2 * layout.dot)) as usize
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

    /// Draws the bars at the bottom of a picture, over its whole width. A frame has `regions` regions.
    pub(super) fn draw(&self, canvas: &mut PictureCanvas, layout: PictureLayout, regions: u64) {
        let (bottom, height) = (canvas.height, Self::BAR_DOTS * layout.dot);
        let last = self.bars.len().saturating_sub(1);
        let whole =
            |index| regions * if index == last { self.frames_in_last } else { self.frames_per_bar };
        // At the first frame everything that is relevant changes, so its bar may end above the scale.
        let counted = usize::from(self.bars.len() > 1);
        let fits = |scale: &&u64| {
            let mut bars = self.bars.iter().enumerate().skip(counted);
            bars.all(|(index, active)| active * 1000 <= **scale * whole(index))
        };
        let scale = *Self::SCALES.iter().find(fits).unwrap_or(&1000);
        canvas.fill_rectangle(0, bottom - height, canvas.width, 1, LINE_COLOUR);
        canvas.fill_rectangle(0, bottom - height / 2, canvas.width, 1, LINE_COLOUR);
        let count = u32::try_from(self.bars.len()).expect("a bar has a pixel or more");
        for (place, (index, &active)) in (0..).zip(self.bars.iter().enumerate()) {
            let [left, right] = [place, place + 1].map(|place| canvas.width * place / count);
            let bar = active * 1000 * u64::from(height) / (scale * whole(index));
            // A bar with any active region is visible.
            let bar = u32::try_from(bar).unwrap_or(height).min(height).max(u32::from(active > 0));
            canvas.fill_rectangle(left, bottom - bar, right - left, bar, ACTIVE_BRIGHT);
        }
        let (dot, top) = (layout.dot, bottom - Self::HEIGHT_DOTS * layout.dot + 2 * layout.dot);
        let share = format!("{} %", scale / 10);
        canvas.draw_text(2 * dot, top, dot, "Share sent, by frame");
        let right = canvas.width.saturating_sub(text_width(&share, dot) + 2 * dot);
        canvas.fill_rectangle(
            right.saturating_sub(2 * dot),
            top - dot,
            canvas.width,
            (TEXT_DOTS + 2) * dot,
            BACKGROUND,
        );
        canvas.draw_text(right, top, dot, &share);
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
