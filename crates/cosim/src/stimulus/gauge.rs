// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scores of a square of pixels under the configured thresholds, to draw squares that meet a
//! minimum exactly. Only the choice of vectors depends on it: the model says what is right.

use foveate_design::{Design, FeatureKind, Filter};
use foveate_model::denoise::median;
use foveate_model::feature::{is_hit, mad, variance};
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

#[derive(Clone, Copy, Debug)]
enum Meter {
    /// Pixels whose window is a hit above the level.
    Hits {
        kind: FeatureKind,
        level: u32,
        minimum: u64,
    },
    /// Sum of deviations from a mean with that many fraction bits.
    Deviation {
        fraction_bits: u32,
        minimum: u64,
    },
    Variance {
        minimum: u64,
    },
    /// Pixels that have changed by more than the level.
    Changes {
        level: u32,
        minimum: u64,
    },
}

impl Gauge {
    pub(super) fn of(design: &Design, side: usize) -> Self {
        let mut meters = Vec::new();
        for feature in design.features() {
            let (kind, minimum) = (feature.kind(), feature.min_score());
            meters.push(match kind {
                FeatureKind::Edge | FeatureKind::Corner => {
                    Meter::Hits { kind, level: feature.level().unwrap_or(0), minimum }
                }
                FeatureKind::Mad => {
                    let fraction_bits = feature.mean().map_or(0, |mean| mean.fraction_bits);
                    Meter::Deviation { fraction_bits, minimum }
                }
                FeatureKind::Variance => Meter::Variance { minimum },
            });
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
        match self.meters[meter] {
            Meter::Hits { minimum, .. }
            | Meter::Deviation { minimum, .. }
            | Meter::Variance { minimum }
            | Meter::Changes { minimum, .. } => minimum,
        }
    }

    /// A score of a square that follows another.
    pub(super) fn read(&self, meter: usize, now: &[u16], before: &[u16]) -> u64 {
        let now = self.scored(now);
        let places = || {
            let own = self.margin..self.side - self.margin;
            own.clone().flat_map(move |y| own.clone().map(move |x| y * self.side + x))
        };
        let n = places().count() as u64;
        let sum = || places().map(|at| u64::from(now[at])).sum();
        match self.meters[meter] {
            Meter::Hits { kind, level, .. } => {
                let hit = |at: &usize| is_hit(kind, &window(&now, *at), level);
                places().filter(hit).count() as u64
            }
            Meter::Deviation { fraction_bits, .. } => {
                let mean = mad::mean(sum(), n, fraction_bits);
                places().map(|at| mad::deviation(now[at], mean, fraction_bits)).sum()
            }
            Meter::Variance { .. } => {
                let squares = places().map(|at| variance::square(now[at])).sum();
                variance::score(n, sum(), squares)
            }
            Meter::Changes { level, .. } => {
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
