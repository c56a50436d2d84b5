// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of the scores that both cameras have, region by region. They need regions of the same
//! size.

use foveate_camera::{Camera, Measure};
use foveate_engine::FrameOutcome;
use foveate_ideal::IdealOutcome;
use serde::{Deserialize, Serialize};

use crate::exact::{Exact, real};

/// The error of one score, summed over regions and frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ScoreTally {
    pub(crate) feature: String,
    pub(crate) unit: String,
    /// The number of regions times frames.
    pub(crate) count: u64,
    pub(crate) max: Exact,
    pub(crate) sum: Exact,
    pub(crate) squares: Exact,
}

impl ScoreTally {
    pub(crate) fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.max = self.max.max(other.max);
        self.sum.add(other.sum);
        self.squares.add(other.squares);
    }
}

/// A score that both cameras have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    /// The indices of the feature in the ideal and in the candidate; `None` for the temporal score.
    places: Option<(usize, usize)>,
    name: &'static str,
    unit: &'static str,
    /// The divisor that converts a score of the candidate to the unit of the ideal, which divides
    /// by the same number. `depth` is then a power of two for another pixel depth, which is exact.
    divisor: f64,
    depth: f64,
    /// The divisor of both scores, which makes shares of a region.
    share: f64,
}

impl Pair {
    /// Returns every score that can be compared, with the temporal score last; empty for regions of
    /// different sizes.
    pub(crate) fn all(ideal: &Camera, candidate: &Camera) -> Vec<Self> {
        if ideal.region_size() != candidate.region_size() {
            return Vec::new();
        }
        let n = f64::from(ideal.region_pixels());
        let hits = Self {
            places: None,
            name: "temporal",
            unit: "share of the region's pixels",
            divisor: 1.0,
            depth: 1.0,
            share: n,
        };
        let levels =
            2.0_f64.powf(f64::from(ideal.pixel_bits()) - f64::from(candidate.pixel_bits()));
        let own = candidate.features().iter().enumerate();
        let find = |kind| own.clone().find(|(_, feature)| feature.kind() == kind);
        let mut pairs = Vec::new();
        for (at, feature) in ideal.features().iter().enumerate() {
            let kind = feature.kind();
            let Some((other, feature)) = find(kind) else { continue };
            let base = Self { places: Some((at, other)), name: kind.name(), ..hits };
            let measure = kind.measure();
            pairs.push(match measure {
                Measure::Pixels => base,
                Measure::Levels | Measure::SquaredLevels => Self {
                    unit: measure.name(),
                    divisor: real(feature.unit()),
                    depth: (0..measure.power()).map(|_| levels).product(),
                    share: 1.0,
                    ..base
                },
            });
        }
        pairs.push(hits);
        pairs
    }

    /// Creates the tally of this score.
    pub(crate) fn tally(&self) -> ScoreTally {
        let [max, sum, squares] = [Exact::default(); 3];
        let (feature, unit) = (self.name.to_owned(), self.unit.to_owned());
        ScoreTally { feature, unit, count: 0, max, sum, squares }
    }

    /// Adds one frame.
    pub(crate) fn add(
        &self,
        ideal: &IdealOutcome,
        candidate: &FrameOutcome,
        tally: &mut ScoreTally,
    ) {
        match self.places {
            Some((own, other)) => self.compare(
                &ideal.scores[own],
                candidate.scores[other].iter().map(|&score| real(score)),
                tally,
            ),
            None => self.compare(
                &ideal.changed,
                candidate.temporal_count.iter().map(|&count| f64::from(count)),
                tally,
            ),
        }
    }

    /// Adds the errors of all regions in their order. Frames may be added in any order, because the
    /// sums of a frame become whole numbers.
    fn compare(&self, ideal: &[f64], candidate: impl Iterator<Item = f64>, tally: &mut ScoreTally) {
        let (mut max, mut sum, mut squares) = (0.0_f64, 0.0, 0.0);
        for (ideal, candidate) in ideal.iter().zip(candidate) {
            let error = (ideal - candidate / self.divisor * self.depth).abs() / self.share;
            max = max.max(error);
            sum += error;
            squares += error * error;
        }
        tally.count += ideal.len() as u64;
        tally.max = tally.max.max(Exact::nearest(max));
        tally.sum.add(Exact::nearest(sum));
        tally.squares.add(Exact::nearest(squares));
    }
}
