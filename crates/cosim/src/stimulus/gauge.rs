// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scores of a square of pixels under the configured thresholds, to draw squares that meet a
//! minimum exactly. Only the choice of vectors depends on it: the model says what is right.

use foveate_design::{Design, Filter, SpatialFeature};
use foveate_model::denoise::median;
use foveate_model::feature::score;
use foveate_model::window::Window;

/// Reads the scores of squares of one size.
#[derive(Clone, Debug)]
pub(super) struct Gauge {
    meters: Vec<Meter>,
    denoise: bool,
    side: usize,
    /// Columns and rows on each side that are halo.
    margin: usize,
}

#[derive(Clone, Debug)]
enum Meter {
    /// The score of a feature.
    Spatial(SpatialFeature),
    /// Pixels that have changed by more than the level.
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

    /// How many scores there are.
    pub(super) fn meters(&self) -> usize {
        self.meters.len()
    }

    /// The minimum of a score.
    pub(super) fn minimum(&self, meter: usize) -> u64 {
        match &self.meters[meter] {
            Meter::Spatial(feature) => feature.min_score(),
            Meter::Changes { minimum, .. } => *minimum,
        }
    }

    /// A score of a square that follows another.
    pub(super) fn read(&self, meter: usize, now: &[u16], before: &[u16]) -> u64 {
        let now = self.scored(now);
        let places = || {
            let own = self.margin..self.side - self.margin;
            own.clone().flat_map(move |y| own.clone().map(move |x| y * self.side + x))
        };
        match &self.meters[meter] {
            Meter::Spatial(feature) => {
                let n = places().count() as u64;
                let windows = places().map(|at| window(&now, at));
                // Of a feature without a level it means nothing.
                let level = feature.level().unwrap_or(0);
                score(feature, level, n, || places().map(|at| now[at]), windows)
            }
            &Meter::Changes { level, .. } => {
                let before = self.scored(before);
                let changed = |at: &usize| u32::from(now[*at].abs_diff(before[*at])) > level;
                places().filter(changed).count() as u64
            }
        }
    }

    fn scored(&self, square: &[u16]) -> Vec<u16> {
        if self.denoise { filtered(square) } else { square.to_vec() }
    }
}

/// The window around a pixel of a square, whose border repeats.
pub(super) fn window(square: &[u16], at: usize) -> Window {
    let side = square.len().isqrt();
    let around = |place: usize| [place.saturating_sub(1), place, (place + 1).min(side - 1)];
    let (columns, rows) = (around(at % side), around(at / side));
    std::array::from_fn(|number| square[rows[number / 3] * side + columns[number % 3]])
}

/// The median of every window.
pub(super) fn filtered(square: &[u16]) -> Vec<u16> {
    (0..square.len()).map(|at| median(&window(square, at))).collect()
}
