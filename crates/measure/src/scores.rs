// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of the scores that both cameras have, region by region. They need regions of the same
//! size.

use foveate_camera::{Camera, ScoreUnit};
use foveate_engine::FrameOutcome;
use foveate_ideal::IdealOutcome;
use serde::{Deserialize, Serialize};

use super::fixed_point::{FixedPoint, count_to_f64};

/// The error of one score, summed over regions and frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ScoreTally {
    pub(crate) feature: String,
    pub(crate) unit: String,
    /// The number of regions times frames.
    pub(crate) count: u64,
    pub(crate) max: FixedPoint,
    pub(crate) sum: FixedPoint,
    pub(crate) squares: FixedPoint,
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
pub(crate) struct ScorePair {
    /// The indices of the feature in the ideal and in the candidate; `None` for the temporal score.
    feature_indices: Option<(usize, usize)>,
    name: &'static str,
    unit: &'static str,
    /// The divisor that converts a score of the candidate to the natural unit of the ideal.
    divisor: f64,
    /// The factor that converts grey levels of the candidate to those of the ideal. It is a power
    /// of two, so the conversion is exact.
    depth_factor: f64,
    /// The divisor of both scores, which makes shares of a region.
    share_divisor: f64,
}

impl ScorePair {
    /// Returns every score that can be compared, with the temporal score last; empty for regions of
    /// different sizes.
    pub(crate) fn comparable_pairs(ideal: &Camera, candidate: &Camera) -> Vec<Self> {
        if ideal.region_size() != candidate.region_size() {
            return Vec::new();
        }
        let n = f64::from(ideal.region_pixels());
        let hits = Self {
            feature_indices: None,
            name: "temporal",
            unit: "share of the region's pixels",
            divisor: 1.0,
            depth_factor: 1.0,
            share_divisor: n,
        };
        let levels =
            2.0_f64.powf(f64::from(ideal.pixel_bits()) - f64::from(candidate.pixel_bits()));
        let candidate_features = candidate.features().iter().enumerate();
        let find = |kind| candidate_features.clone().find(|(_, feature)| feature.kind() == kind);
        let mut pairs = Vec::new();
        for (at, feature) in ideal.features().iter().enumerate() {
            let kind = feature.kind();
            let Some((candidate_index, feature)) = find(kind) else { continue };
            let base =
                Self { feature_indices: Some((at, candidate_index)), name: kind.name(), ..hits };
            let measure = kind.score_unit();
            pairs.push(match measure {
                ScoreUnit::Pixels => base,
                ScoreUnit::Levels | ScoreUnit::SquaredLevels => Self {
                    unit: measure.name(),
                    divisor: count_to_f64(feature.unit()),
                    depth_factor: (0..measure.scaling_exponent()).map(|_| levels).product(),
                    share_divisor: 1.0,
                    ..base
                },
            });
        }
        pairs.push(hits);
        pairs
    }

    pub(crate) fn empty_tally(&self) -> ScoreTally {
        let [max, sum, squares] = [FixedPoint::default(); 3];
        let (feature, unit) = (self.name.to_owned(), self.unit.to_owned());
        ScoreTally { feature, unit, count: 0, max, sum, squares }
    }

    pub(crate) fn add_frame(
        &self,
        ideal: &IdealOutcome,
        candidate: &FrameOutcome,
        tally: &mut ScoreTally,
    ) {
        match self.feature_indices {
            Some((ideal_index, candidate_index)) => self.compare(
                &ideal.scores[ideal_index],
                candidate.scores[candidate_index].iter().map(|&score| count_to_f64(score)),
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
            let error =
                (ideal - candidate / self.divisor * self.depth_factor).abs() / self.share_divisor;
            max = max.max(error);
            sum += error;
            squares += error * error;
        }
        tally.count += ideal.len() as u64;
        tally.max = tally.max.max(FixedPoint::nearest(max));
        tally.sum.add(FixedPoint::nearest(sum));
        tally.squares.add(FixedPoint::nearest(squares));
    }
}
