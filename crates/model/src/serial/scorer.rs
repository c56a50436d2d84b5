// SPDX-License-Identifier: MIT OR Apache-2.0
//! What one region scores, from its stream alone.

use foveate_design::{Design, FeatureKind, Filter, SpatialFeature};

use super::square::Square;
use crate::Thresholds;
use crate::denoise::median;
use crate::feature::{is_hit, mad, variance};
use crate::number::{count, index};

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
    /// A scorer of the design's regions.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        let scored_side = index(design.denoised_side());
        Self {
            side: index(design.region_size()),
            filter: design.filter(),
            needs_border: design.needs_border(),
            features: design.features().to_vec(),
            raw: Square::black(index(design.stream_side())),
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

    /// The scores of the features, in the order of the design.
    #[must_use]
    pub fn scores(&self, thresholds: &Thresholds) -> [u64; 4] {
        let mut scores = [0; 4];
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
        match feature.kind() {
            kind @ (FeatureKind::Edge | FeatureKind::Corner) => {
                let windows = self.scored.windows(self.side);
                count(windows.map(|window| is_hit(kind, &window, level))).into()
            }
            FeatureKind::Mad => {
                let fraction_bits = feature.mean().map_or(0, |mean| mean.fraction_bits);
                let mean = mad::mean(self.sum(), self.count(), fraction_bits);
                self.pixels().map(|pixel| mad::deviation(pixel, mean, fraction_bits)).sum()
            }
            FeatureKind::Variance => {
                let square_sum = self.pixels().map(variance::square).sum();
                variance::score(self.count(), self.sum(), square_sum)
            }
        }
    }

    fn sum(&self) -> u64 {
        self.pixels().map(u64::from).sum()
    }

    fn count(&self) -> u64 {
        self.pixels().map(|_| 1).sum()
    }
}
