// SPDX-License-Identifier: MIT OR Apache-2.0
//! Heat maps of one score: every region in the colour of its score, on the perceptually uniform
//! scale viridis, dark for 0. The scale belongs to the camera and not to the frame, so that
//! pictures can be compared. It goes from 0 to the largest possible score. Scores in squared levels
//! are shown by their square root, so that a variance appears as a standard deviation. The bar
//! below has a tick at the threshold.

use colorous::VIRIDIS;
use foveate_camera::{Camera, ScoreUnit};
use foveate_output::palette::Colour;

use super::canvas::{LINE_DOTS, PictureCanvas, PictureLayout, TEXT, TEXT_DOTS, text_width};
use super::picture_series::PicturePainter;
use super::sink::SinkFrame;

const SCALE_STEPS: u64 = 256;

/// The painter of the maps of one score.
pub(super) struct HeatmapPainter {
    score: MappedScore,
    title: String,
    max: u64,
    /// The largest score as it is written beside the bar, in grey levels or their square.
    label: String,
    threshold: u64,
}

#[derive(Clone, Copy)]
enum MappedScore {
    /// A spatial score: the index of the feature, and the unit of its score.
    Spatial(usize, ScoreUnit),
    Temporal,
}

impl HeatmapPainter {
    pub(super) fn all_maps(camera: &Camera) -> Vec<(String, Self)> {
        let n = u64::from(camera.region_pixels());
        let spatial = camera.features().iter().enumerate().map(|(index, feature)| Self {
            score: MappedScore::Spatial(index, feature.kind().score_unit()),
            title: feature.kind().to_string(),
            max: feature.score_max(),
            label: (feature.score_max() / feature.unit()).to_string(),
            threshold: feature.min_score(),
        });
        let temporal = Self {
            score: MappedScore::Temporal,
            title: "temporal".to_owned(),
            max: n,
            label: n.to_string(),
            threshold: camera.temporal().min_count.into(),
        };
        let all = spatial.chain([temporal]);
        all.map(|map| (format!("heatmap_{}", map.title), map)).collect()
    }

    fn score_of_region(&self, sink_frame: &SinkFrame<'_>, region: usize) -> u64 {
        match self.score {
            MappedScore::Spatial(index, _) => sink_frame.outcome.scores[index][region],
            MappedScore::Temporal => sink_frame.outcome.temporal_count[region].into(),
        }
    }

    /// Returns the step of a score on the scale, in `0..SCALE_STEPS`.
    fn scale_step(&self, score: u64) -> u64 {
        let last = u128::from(SCALE_STEPS - 1);
        let (score, max) = (u128::from(score.min(self.max)), u128::from(self.max.max(1)));
        let step = match self.score {
            MappedScore::Spatial(_, ScoreUnit::SquaredLevels) => {
                (score * last * last / max).isqrt()
            }
            MappedScore::Spatial(_, ScoreUnit::Pixels | ScoreUnit::Levels)
            | MappedScore::Temporal => score * last / max,
        };
        u64::try_from(step).expect("no score is above the largest")
    }

    fn draw_bar(&self, canvas: &mut PictureCanvas, layout: PictureLayout) {
        let dot = layout.dot;
        let top = layout.frame_height + 2 * dot;
        let height = TEXT_DOTS * dot;
        let title = format!("{} 0", self.title);
        let left = canvas.draw_text(2 * dot, top, dot, &title) + dot;
        let right = layout.width.saturating_sub(text_width(&self.label, dot) + 3 * dot);
        let width = right.saturating_sub(left).max(1);
        for x in 0..width {
            canvas.fill_rectangle(
                left + x,
                top,
                1,
                height,
                scale_colour(u64::from(x) * SCALE_STEPS / u64::from(width)),
            );
        }
        canvas.draw_text(right + dot, top, dot, &self.label);
        let tick = self.scale_step(self.threshold) * u64::from(width) / SCALE_STEPS;
        let tick = left + u32::try_from(tick).expect("it is on the bar");
        canvas.fill_rectangle(tick, top - dot, dot, height + 2 * dot, TEXT);
    }
}

impl PicturePainter for HeatmapPainter {
    fn paint(&mut self, sink_frame: &SinkFrame<'_>) -> PictureCanvas {
        let camera = sink_frame.camera;
        let layout = PictureLayout::of_camera(camera);
        let footer = LINE_DOTS * layout.dot;
        let mut canvas = PictureCanvas::new(layout.width, layout.frame_height + footer);
        let cell = camera.region_size() * layout.scale;
        for region in 0..camera.regions() {
            let place = (region % camera.columns(), region / camera.columns());
            let [left, top, width, height] = layout.region_area(cell, place);
            let colour =
                scale_colour(self.scale_step(self.score_of_region(sink_frame, region as usize)));
            canvas.fill_rectangle(left, top, width, height, colour);
        }
        self.draw_bar(&mut canvas, layout);
        canvas
    }
}

fn scale_colour(step: u64) -> Colour {
    let step = usize::try_from(step.min(SCALE_STEPS - 1)).expect("STEPS are few");
    let colour = VIRIDIS.eval_rational(step, 256);
    [colour.r, colour.g, colour.b]
}
