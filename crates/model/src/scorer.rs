// SPDX-License-Identifier: MIT OR Apache-2.0
//! What one region scores, from its stream alone.

use foveate_camera::{Camera, FeatureKind, Filter, SpatialFeature};

use crate::Thresholds;
use crate::denoise::median;
use crate::feature::score;
use crate::number::{count, index};
use crate::square::Square;

/// Scores one region after the other. Whoever wants to know a frame's scores before the array
/// says them, to aim thresholds at them, asks this.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionScorer {
    /// Side of a region N.
    side: usize,
    filter: Filter,
    needs_border: bool,
    features: Vec<SpatialFeature>,
    raw: Square,
    /// Side of the square that is scored: the region with what its windows see around it.
    scored_side: usize,
    scored: Square,
}

impl RegionScorer {
    /// A scorer of the camera's regions.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let scored_side = index(camera.denoised_side());
        Self {
            side: index(camera.region_size()),
            filter: camera.filter(),
            needs_border: camera.needs_border(),
            features: camera.features().to_vec(),
            raw: Square::black(index(camera.stream_side())),
            scored_side,
            scored: Square::black(scored_side),
        }
    }

    /// Takes the stream of a region (as of [`crate::region_stream`]) and denoises it; `border` is
    /// that of [`crate::region_border`].
    pub fn take(&mut self, stream: impl Iterator<Item = u16>, border: u8) {
        match self.filter {
            Filter::None => self.scored.fill(stream),
            Filter::Median3x3 => {
                self.raw.fill(stream);
                let windows = self.raw.windows(self.scored_side);
                self.scored.fill(windows.map(|window| median(&window)));
                if self.needs_border {
                    self.scored.repeat_beyond(border);
                }
            }
        }
    }

    /// The region's pixels that are scored, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = u16> + '_ {
        self.scored.middle(self.side)
    }

    /// The scores of the features, in the order of the camera.
    #[must_use]
    pub fn scores(&self, thresholds: &Thresholds) -> [u64; FeatureKind::COUNT] {
        let mut scores = [0; FeatureKind::COUNT];
        let features = self.features.iter().zip(&thresholds.level);
        for (score, (feature, &level)) in scores.iter_mut().zip(features) {
            *score = self.score(feature, level);
        }
        scores
    }

    /// Pixels that differ from the reference; all where there is none.
    pub fn temporal_count(&self, reference: Option<&[u16]>, thresholds: &Thresholds) -> u32 {
        let changed = |(now, before): (u16, &u16)| {
            u32::from(now.abs_diff(*before)) > thresholds.temporal_level
        };
        match reference {
            Some(reference) => count(self.pixels().zip(reference).map(changed)),
            None => count(self.pixels().map(|_| true)),
        }
    }

    fn score(&self, feature: &SpatialFeature, level: u32) -> u64 {
        let n = u64::from(count(self.pixels().map(|_| true)));
        score(feature, level, n, || self.pixels(), self.scored.windows(self.side))
    }
}
