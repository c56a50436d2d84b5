// SPDX-License-Identifier: MIT OR Apache-2.0
//! The differences between kinds of features, and between filters. Every match in this file must be
//! extended for a new kind.

use crate::feature::{MeanDivision, VarianceWidths};
use crate::ranges::largest_level;
use crate::width::{edge_magnitude_max, variance_score_max};
use crate::{DenoiseFilter, FeatureKind, mad_score_max};

/// The unit of a score, which says how the score scales with the pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ScoreUnit {
    /// Pixels of the region that count: hits, or pixels of the smaller part for `segment`.
    Pixels,
    /// Differences of pixels in grey levels.
    Levels,
    /// Squares of differences of pixels.
    SquaredLevels,
}

impl ScoreUnit {
    /// Returns the exponent e of the scaling: when every difference of pixels doubles, the score is
    /// multiplied by 2^e.
    #[must_use]
    pub fn scaling_exponent(self) -> u32 {
        match self {
            Self::Pixels => 0,
            Self::Levels => 1,
            Self::SquaredLevels => 2,
        }
    }

    /// Returns true if the score is a count of pixels: a whole number that does not depend on the
    /// scale of pixels.
    #[must_use]
    pub fn is_count(self) -> bool {
        match self {
            Self::Pixels => true,
            Self::Levels | Self::SquaredLevels => false,
        }
    }

    /// Returns the name of the unit of `min_score`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels of a region",
            Self::Levels => "grey levels",
            Self::SquaredLevels => "squared grey levels",
        }
    }
}

/// The values of keys that a configuration leaves out, for pixels of 8 bits. A key that does not
/// apply to the feature is `None`.
pub(crate) struct FeatureDefaults {
    pub(crate) level: Option<u32>,
    pub(crate) min_score: u64,
    pub(crate) mean_fraction_bits: Option<u32>,
    pub(crate) radius: Option<u32>,
}

impl DenoiseFilter {
    /// Returns true if the filter uses the 3x3 window of raw pixels around each pixel.
    #[must_use]
    pub fn has_window(self) -> bool {
        match self {
            Self::None => false,
            Self::Median3x3 | Self::Switching3x3 | Self::Binomial3x3 => true,
        }
    }
}

impl FeatureKind {
    /// Number of kinds, which is the length of arrays with one element per kind.
    pub const COUNT: usize = Self::ALL.len();

    /// Returns true if the feature uses the 3x3 window around each pixel.
    #[must_use]
    pub fn has_window(self) -> bool {
        match self {
            Self::Edge | Self::Corner | Self::Surface => true,
            Self::Mad | Self::Variance | Self::Range | Self::Segment | Self::Flow => false,
        }
    }

    /// Returns true if the score is the number of pixels whose 3x3 window is a hit.
    #[must_use]
    pub fn counts_window_hits(self) -> bool {
        match self {
            Self::Edge | Self::Corner => true,
            Self::Mad
            | Self::Variance
            | Self::Range
            | Self::Surface
            | Self::Segment
            | Self::Flow => false,
        }
    }

    /// Returns true if the score needs the pixels of the region a second time, once their mean is
    /// known.
    #[must_use]
    pub fn has_second_pass(self) -> bool {
        match self {
            Self::Mad | Self::Segment => true,
            Self::Edge
            | Self::Corner
            | Self::Variance
            | Self::Range
            | Self::Surface
            | Self::Flow => false,
        }
    }

    /// Returns true if the feature finds the displacement of a region from its reference.
    #[must_use]
    pub fn is_displacement(self) -> bool {
        match self {
            Self::Flow => true,
            Self::Edge
            | Self::Corner
            | Self::Mad
            | Self::Variance
            | Self::Range
            | Self::Surface
            | Self::Segment => false,
        }
    }

    /// Returns the unit of the score.
    #[must_use]
    pub fn score_unit(self) -> ScoreUnit {
        match self {
            Self::Edge | Self::Corner | Self::Segment => ScoreUnit::Pixels,
            Self::Mad | Self::Range | Self::Surface | Self::Flow => ScoreUnit::Levels,
            Self::Variance => ScoreUnit::SquaredLevels,
        }
    }

    /// Returns per-pixel thresholds, for pixels of 8 bits, that a search tries, from the lowest to
    /// the highest. The list is empty for a feature without such a threshold.
    #[must_use]
    pub fn trial_levels(self) -> &'static [u32] {
        match self {
            Self::Edge => &[50, 75, 100, 150],
            Self::Corner => &[8, 12, 20, 30],
            Self::Segment => &[4, 8, 12, 20],
            Self::Mad | Self::Variance | Self::Range | Self::Surface | Self::Flow => &[],
        }
    }

    pub(crate) fn defaults(self) -> FeatureDefaults {
        let (level, min_score, mean_fraction_bits) = match self {
            Self::Edge => (Some(100), 5, None),
            Self::Corner => (Some(20), 5, None),
            Self::Mad => (None, 5, Some(0)),
            Self::Variance => (None, 50, None),
            Self::Range => (None, 20, None),
            Self::Surface => (None, 5, None),
            Self::Segment => (Some(8), 8, Some(0)),
            Self::Flow => (None, 2, None),
        };
        let radius = self.is_displacement().then_some(1);
        FeatureDefaults { level, min_score, mean_fraction_bits, radius }
    }

    /// Returns the largest value that the per-pixel threshold is compared with, or `None` if the
    /// feature has no such threshold.
    pub(crate) fn level_max(self, pixel_max: u32) -> Option<u32> {
        match self {
            Self::Edge => Some(edge_magnitude_max(pixel_max)),
            Self::Corner | Self::Segment => Some(pixel_max),
            Self::Mad | Self::Variance | Self::Range | Self::Surface | Self::Flow => None,
        }
    }

    /// Returns the largest level with which a region can have a score above 0, or `None` if every
    /// region has the score 0 or the feature has no such threshold. A mean of `segment` must be
    /// more than the level away from both ends of the range of pixels; it is a whole number if
    /// `fraction_bits` is 0.
    pub(crate) fn largest_deciding_level(self, pixel_max: u32, fraction_bits: u32) -> Option<u32> {
        match self {
            Self::Edge | Self::Corner => {
                self.level_max(pixel_max).map(|max| largest_level(max, false))
            }
            Self::Segment => ((pixel_max - 1) / 2).checked_sub(u32::from(fraction_bits == 0)),
            Self::Mad | Self::Variance | Self::Range | Self::Surface | Self::Flow => None,
        }
    }

    /// Returns the number of score units in one unit of `min_score`, for regions of `n` pixels.
    pub(crate) fn unit(self, n: u64, fraction_bits: u32) -> u64 {
        match self {
            Self::Edge | Self::Corner | Self::Range | Self::Segment => 1,
            Self::Surface | Self::Flow => n,
            Self::Mad => n << fraction_bits,
            Self::Variance => n * n,
        }
    }

    /// Returns the largest score that a region of `n` pixels can have.
    pub(crate) fn score_max(self, n: u64, pixel_max: u64, fraction_bits: u32) -> u64 {
        match self {
            Self::Edge | Self::Corner => n,
            Self::Mad => mad_score_max(n, pixel_max, fraction_bits),
            Self::Variance => variance_score_max(n, pixel_max),
            Self::Range => pixel_max,
            Self::Surface | Self::Flow => n * pixel_max,
            Self::Segment => n / 2,
        }
    }

    /// Returns the arithmetic of the mean of `mad` and `segment`, and the accumulators of
    /// `variance`, each for these features only.
    pub(crate) fn mean_and_variance(
        self,
        n: u64,
        pixel_max: u64,
        fraction_bits: u32,
    ) -> (Option<MeanDivision>, Option<VarianceWidths>) {
        match self {
            Self::Edge | Self::Corner | Self::Range | Self::Surface | Self::Flow => (None, None),
            Self::Mad | Self::Segment => {
                (Some(MeanDivision::new(n, pixel_max, fraction_bits)), None)
            }
            Self::Variance => (None, Some(VarianceWidths::new(n, pixel_max))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Code that tests only one of these properties would miss a feature in which they differ.
    #[test]
    fn levels_belong_to_features_that_count_pixels() {
        for kind in FeatureKind::ALL {
            let counts = kind.score_unit().is_count();
            assert_eq!(kind.level_max(255).is_some(), counts, "{kind}");
            assert_eq!(kind.defaults().level.is_some(), counts, "{kind}");
            assert_eq!(kind.trial_levels().is_empty(), !counts, "{kind}");
        }
    }

    #[test]
    fn the_features_of_the_second_pass_have_a_mean() {
        for kind in FeatureKind::ALL {
            let (mean, _) = kind.mean_and_variance(64, 255, 0);
            assert_eq!(mean.is_some(), kind.has_second_pass(), "{kind}");
            assert_eq!(kind.defaults().mean_fraction_bits.is_some(), mean.is_some(), "{kind}");
        }
    }

    #[test]
    fn hits_of_windows_are_counts_of_pixels() {
        for kind in FeatureKind::ALL.iter().filter(|kind| kind.counts_window_hits()) {
            assert!(kind.has_window() && kind.score_unit().is_count(), "{kind}");
        }
    }
}
