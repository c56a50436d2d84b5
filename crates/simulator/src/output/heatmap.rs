// SPDX-License-Identifier: MIT OR Apache-2.0
//! Heat maps of one score: every region in the colour of its score, on the perceptually uniform
//! scale viridis, dark for 0. The scale belongs to the camera and not to the frame, so that
//! pictures can be compared. It goes from 0 to the largest possible score. Scores in squared levels
//! are shown by their square root, so that a variance appears as a standard deviation. The bar
//! below has a tick at the threshold.

use colorous::VIRIDIS;
use foveate_camera::{Camera, Measure};
use foveate_pictures::palette::Colour;

use super::canvas::{Canvas, Layout, TEXT};
use super::font;
use super::gallery::Painter;
use super::sink::Step;

/// The number of steps of the scale.
const STEPS: u64 = 256;

/// The painter of the maps of one score.
pub(super) struct Heatmap {
    score: Score,
    title: String,
    max: u64,
    /// The largest score as it is written beside the bar, in grey levels or their square.
    label: String,
    threshold: u64,
}

#[derive(Clone, Copy)]
enum Score {
    /// A spatial score: the index of the feature, and the unit of its score.
    Spatial(usize, Measure),
    Temporal,
}

impl Heatmap {
    /// Returns a map with its name for every score of a camera.
    pub(super) fn all(camera: &Camera) -> Vec<(String, Self)> {
        let n = u64::from(camera.region_pixels());
        let spatial = camera.features().iter().enumerate().map(|(index, feature)| Self {
            score: Score::Spatial(index, feature.kind().measure()),
            title: feature.kind().to_string(),
            max: feature.score_max(),
            label: (feature.score_max() / feature.unit()).to_string(),
            threshold: feature.min_score(),
        });
        let temporal = Self {
            score: Score::Temporal,
            title: "temporal".to_owned(),
            max: n,
            label: n.to_string(),
            threshold: camera.temporal().min_count.into(),
        };
        let all = spatial.chain([temporal]);
        all.map(|map| (format!("heatmap_{}", map.title), map)).collect()
    }

    fn value(&self, step: &Step<'_>, region: usize) -> u64 {
        match self.score {
            Score::Spatial(index, _) => step.outcome.scores[index][region],
            Score::Temporal => step.outcome.temporal_count[region].into(),
        }
    }

    /// Returns the place of a score on the scale, in `0..STEPS`.
    fn place(&self, score: u64) -> u64 {
        let last = u128::from(STEPS - 1);
        let (score, max) = (u128::from(score.min(self.max)), u128::from(self.max.max(1)));
        let place = match self.score {
            Score::Spatial(_, Measure::SquaredLevels) => (score * last * last / max).isqrt(),
            Score::Spatial(_, Measure::Pixels | Measure::Levels) | Score::Temporal => {
                score * last / max
            }
        };
        u64::try_from(place).expect("no score is above the largest")
    }

    fn draw_bar(&self, canvas: &mut Canvas, layout: Layout) {
        let dot = layout.dot;
        let top = layout.frame_height + 2 * dot;
        let height = font::SIZE.1 * dot;
        let title = format!("{} 0", self.title);
        let left = canvas.text(2 * dot, top, dot, &title) + dot;
        let letters = u32::try_from(self.label.len()).expect("labels are short");
        let right = layout.width.saturating_sub((letters * (font::SIZE.0 + 1) + 3) * dot);
        let width = right.saturating_sub(left).max(1);
        for x in 0..width {
            canvas.fill(left + x, top, 1, height, colour(u64::from(x) * STEPS / u64::from(width)));
        }
        canvas.text(right + dot, top, dot, &self.label);
        let tick = self.place(self.threshold) * u64::from(width) / STEPS;
        let tick = left + u32::try_from(tick).expect("it is on the bar");
        canvas.fill(tick, top - dot, dot, height + 2 * dot, TEXT);
    }
}

impl Painter for Heatmap {
    fn paint(&mut self, step: &Step<'_>) -> Canvas {
        let (camera, frame) = (step.camera, &step.source.frame);
        let layout = Layout::new(frame.width(), frame.height());
        let footer = (font::SIZE.1 + 4) * layout.dot;
        let mut canvas = Canvas::new(layout.width, layout.frame_height + footer);
        let cell = camera.region_size() * layout.scale;
        for region in 0..camera.regions() {
            let (left, top) = (region % camera.columns() * cell, region / camera.columns() * cell);
            let width = cell.min(layout.frame_width - left);
            let height = cell.min(layout.frame_height - top);
            let colour = colour(self.place(self.value(step, region as usize)));
            canvas.fill(left, top, width, height, colour);
        }
        self.draw_bar(&mut canvas, layout);
        canvas
    }
}

fn colour(place: u64) -> Colour {
    let place = usize::try_from(place.min(STEPS - 1)).expect("STEPS are few");
    let colour = VIRIDIS.eval_rational(place, 256);
    [colour.r, colour.g, colour.b]
}
