// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores of a square of pixels under the configured thresholds, for squares that meet a
//! minimum exactly. They only affect the choice of vectors; the expected outputs come from the
//! model.

use foveate_design::{DenoiseFilter, Design, SpatialFeature};
use foveate_model::denoising::median;
use foveate_model::feature::score;
use foveate_model::window::PixelWindow;
use foveate_model::{RegionView, changed_pixels};
use std::ops::Range;

/// A calculator of the scores of squares of one size.
#[derive(Clone, Debug)]
pub(super) struct PatternScorer {
    scores: Vec<PatternScore>,
    denoise: bool,
    side: usize,
    /// The width of the halo on each side, in pixels.
    margin: usize,
}

#[derive(Clone, Debug)]
enum PatternScore {
    /// The score of a feature.
    Spatial(SpatialFeature),
    /// The number of pixels that have changed by more than the level.
    Changes { level: u32, minimum: u64 },
}

impl PatternScorer {
    pub(super) fn for_design(design: &Design, side: usize) -> Self {
        let mut meters = Vec::new();
        for feature in design.features() {
            meters.push(PatternScore::Spatial(feature.clone()));
        }
        let temporal = design.temporal();
        let (level, minimum) = (temporal.level, temporal.min_count.into());
        meters.push(PatternScore::Changes { level, minimum });
        let margin = side.saturating_sub(design.region_size() as usize) / 2;
        Self { scores: meters, denoise: design.filter() == DenoiseFilter::Median3x3, side, margin }
    }

    /// Returns the number of scores.
    pub(super) fn score_count(&self) -> usize {
        self.scores.len()
    }

    /// Returns the minimum of a score.
    pub(super) fn minimum(&self, meter: usize) -> u64 {
        match &self.scores[meter] {
            PatternScore::Spatial(feature) => feature.min_score(),
            PatternScore::Changes { minimum, .. } => *minimum,
        }
    }

    /// Returns a scorer for squares that follow `before`.
    pub(super) fn followers_of(&self, before: &[u16]) -> FollowerScorer<'_> {
        FollowerScorer { gauge: self, before: self.denoised(before) }
    }

    fn denoised(&self, square: &[u16]) -> Vec<u16> {
        if self.denoise { median_filtered(square) } else { square.to_vec() }
    }
}

/// A scorer for squares that follow another square.
pub(super) struct FollowerScorer<'a> {
    gauge: &'a PatternScorer,
    before: Vec<u16>,
}

impl FollowerScorer<'_> {
    /// Returns a score of the square `now`.
    pub(super) fn score(&self, meter: usize, now: &[u16]) -> u64 {
        let PatternScorer { scores: meters, side, margin, .. } = self.gauge;
        let own = *margin..side - margin;
        let now = self.gauge.denoised(now);
        let seen = FollowerRegion { now: &now, before: &self.before, side: *side, own };
        match &meters[meter] {
            // A feature without a level ignores the argument.
            PatternScore::Spatial(feature) => score(feature, feature.level().unwrap_or(0), &seen),
            &PatternScore::Changes { level, .. } => changed_pixels(&seen, level).into(),
        }
    }
}

/// The region in the middle of a square that follows another one.
struct FollowerRegion<'a> {
    now: &'a [u16],
    before: &'a [u16],
    side: usize,
    /// The columns of the region, and its rows.
    own: Range<usize>,
}

impl FollowerRegion<'_> {
    fn places(&self) -> impl Iterator<Item = usize> {
        self.own.clone().flat_map(move |y| self.own.clone().map(move |x| y * self.side + x))
    }
}

impl RegionView for FollowerRegion<'_> {
    fn pixel_count(&self) -> u64 {
        (self.own.len() as u64).pow(2)
    }

    fn pixels(&self) -> impl Iterator<Item = u16> {
        self.places().map(|at| self.now[at])
    }

    fn windows(&self) -> impl Iterator<Item = PixelWindow> {
        self.places().map(|at| window_at(self.now, at))
    }

    fn reference(&self) -> Option<impl Iterator<Item = u16>> {
        Some(self.places().map(|at| self.before[at]))
    }
}

/// Returns the window around a pixel of a square; beyond the square its border repeats.
pub(super) fn window_at(square: &[u16], at: usize) -> PixelWindow {
    let side = square.len().isqrt();
    let around = |place: usize| [place.saturating_sub(1), place, (place + 1).min(side - 1)];
    let (columns, rows) = (around(at % side), around(at / side));
    std::array::from_fn(|number| square[rows[number / 3] * side + columns[number % 3]])
}

/// Returns the median of every window.
pub(super) fn median_filtered(square: &[u16]) -> Vec<u16> {
    (0..square.len()).map(|at| median(&window_at(square, at))).collect()
}
