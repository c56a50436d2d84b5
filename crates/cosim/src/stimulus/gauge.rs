// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores of a square of pixels under the configured thresholds, for squares that meet a
//! minimum exactly. They only affect the choice of vectors; the expected outputs come from the
//! model.

use foveate_design::{Design, Filter, SpatialFeature};
use foveate_model::denoise::median;
use foveate_model::feature::score;
use foveate_model::window::Window;
use foveate_model::{RegionView, changed_pixels};
use std::ops::Range;

/// A calculator of the scores of squares of one size.
#[derive(Clone, Debug)]
pub(super) struct Gauge {
    meters: Vec<Meter>,
    denoise: bool,
    side: usize,
    /// The width of the halo on each side, in pixels.
    margin: usize,
}

#[derive(Clone, Debug)]
enum Meter {
    /// The score of a feature.
    Spatial(SpatialFeature),
    /// The number of pixels that have changed by more than the level.
    Changes { level: u32, minimum: u64 },
}

impl Gauge {
    pub(super) fn of(design: &Design, side: usize) -> Self {
        let mut meters = Vec::new();
        for feature in design.features() {
            meters.push(Meter::Spatial(feature.clone()));
        }
        let temporal = design.temporal();
        let (level, minimum) = (temporal.level, temporal.min_count.into());
        meters.push(Meter::Changes { level, minimum });
        let margin = side.saturating_sub(design.region_size() as usize) / 2;
        Self { meters, denoise: design.filter() == Filter::Median3x3, side, margin }
    }

    /// Returns the number of scores.
    pub(super) fn meters(&self) -> usize {
        self.meters.len()
    }

    /// Returns the minimum of a score.
    pub(super) fn minimum(&self, meter: usize) -> u64 {
        match &self.meters[meter] {
            Meter::Spatial(feature) => feature.min_score(),
            Meter::Changes { minimum, .. } => *minimum,
        }
    }

    /// Returns a scorer for squares that follow `before`.
    pub(super) fn after(&self, before: &[u16]) -> Following<'_> {
        Following { gauge: self, before: self.scored(before) }
    }

    fn scored(&self, square: &[u16]) -> Vec<u16> {
        if self.denoise { filtered(square) } else { square.to_vec() }
    }
}

/// A scorer for squares that follow another square.
pub(super) struct Following<'a> {
    gauge: &'a Gauge,
    before: Vec<u16>,
}

impl Following<'_> {
    /// Returns a score of the square `now`.
    pub(super) fn read(&self, meter: usize, now: &[u16]) -> u64 {
        let Gauge { meters, side, margin, .. } = self.gauge;
        let own = *margin..side - margin;
        let now = self.gauge.scored(now);
        let seen = Seen { now: &now, before: &self.before, side: *side, own };
        match &meters[meter] {
            // A feature without a level ignores the argument.
            Meter::Spatial(feature) => score(feature, feature.level().unwrap_or(0), &seen),
            &Meter::Changes { level, .. } => changed_pixels(&seen, level).into(),
        }
    }
}

/// The region in the middle of a square that follows another one.
struct Seen<'a> {
    now: &'a [u16],
    before: &'a [u16],
    side: usize,
    /// The columns of the region, and its rows.
    own: Range<usize>,
}

impl Seen<'_> {
    fn places(&self) -> impl Iterator<Item = usize> {
        self.own.clone().flat_map(move |y| self.own.clone().map(move |x| y * self.side + x))
    }
}

impl RegionView for Seen<'_> {
    fn n(&self) -> u64 {
        (self.own.len() as u64).pow(2)
    }

    fn pixels(&self) -> impl Iterator<Item = u16> {
        self.places().map(|at| self.now[at])
    }

    fn windows(&self) -> impl Iterator<Item = Window> {
        self.places().map(|at| window(self.now, at))
    }

    fn before(&self) -> Option<impl Iterator<Item = u16>> {
        Some(self.places().map(|at| self.before[at]))
    }
}

/// Returns the window around a pixel of a square; beyond the square its border repeats.
pub(super) fn window(square: &[u16], at: usize) -> Window {
    let side = square.len().isqrt();
    let around = |place: usize| [place.saturating_sub(1), place, (place + 1).min(side - 1)];
    let (columns, rows) = (around(at % side), around(at / side));
    std::array::from_fn(|number| square[rows[number / 3] * side + columns[number % 3]])
}

/// Returns the median of every window.
pub(super) fn filtered(square: &[u16]) -> Vec<u16> {
    (0..square.len()).map(|at| median(&window(square, at))).collect()
}
