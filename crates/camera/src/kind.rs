// SPDX-License-Identifier: MIT OR Apache-2.0
//! What sets a feature apart. Adding one starts here: every match below has to say what is new.

use crate::feature::{Mean, Variance};
use crate::width::{edge_magnitude_max, variance_score_max};
use crate::{FeatureKind, mad_score_max};

/// What a score counts or measures, and hence how it scales with the pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Measure {
    /// Pixels of the region that are hits.
    Pixels,
    /// Grey levels.
    Levels,
    /// Their squares.
    SquaredLevels,
}

impl Measure {
    /// What becomes of the score when every difference of pixels doubles: times 2 to this power.
    #[must_use]
    pub fn power(self) -> u32 {
        match self {
            Self::Pixels => 0,
            Self::Levels => 1,
            Self::SquaredLevels => 2,
        }
    }

    /// Whether it is a count: a whole number, which no scaling of pixels changes.
    #[must_use]
    pub fn is_count(self) -> bool {
        match self {
            Self::Pixels => true,
            Self::Levels | Self::SquaredLevels => false,
        }
    }

    /// The unit of `min_score`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels of a region",
            Self::Levels => "grey levels",
            Self::SquaredLevels => "squared grey levels",
        }
    }
}

/// The keys of a feature where the configuration leaves them out, for pixels of 8 bits; `None` where a
/// key does not apply.
pub(crate) struct Defaults {
    pub(crate) level: Option<u32>,
    pub(crate) min_score: u64,
    pub(crate) mean_fraction_bits: Option<u32>,
}

impl FeatureKind {
    /// How many features there are: the size of whatever has a place for each.
    pub const COUNT: usize = Self::ALL.len();

    /// Whether the feature looks at 3x3 windows, and counts those that are hits.
    #[must_use]
    pub fn has_window(self) -> bool {
        match self {
            Self::Edge | Self::Corner => true,
            Self::Mad | Self::Variance => false,
        }
    }

    /// Whether the score needs the region a second time, once its mean is known.
    #[must_use]
    pub fn has_second_pass(self) -> bool {
        match self {
            Self::Mad => true,
            Self::Edge | Self::Corner | Self::Variance => false,
        }
    }

    /// What the score counts or measures.
    #[must_use]
    pub fn measure(self) -> Measure {
        match self {
            Self::Edge | Self::Corner => Measure::Pixels,
            Self::Mad => Measure::Levels,
            Self::Variance => Measure::SquaredLevels,
        }
    }

    /// Per-pixel thresholds of pixels of 8 bits that are worth a try, the mildest first; none for a feature
    /// that has no such threshold.
    #[must_use]
    pub fn trial_levels(self) -> &'static [u32] {
        match self {
            Self::Edge => &[50, 75, 100, 150],
            Self::Corner => &[8, 12, 20, 30],
            Self::Mad | Self::Variance => &[],
        }
    }

    pub(crate) fn defaults(self) -> Defaults {
        let (level, min_score, mean_fraction_bits) = match self {
            Self::Edge => (Some(100), 5, None),
            Self::Corner => (Some(20), 5, None),
            Self::Mad => (None, 5, Some(0)),
            Self::Variance => (None, 50, None),
        };
        Defaults { level, min_score, mean_fraction_bits }
    }

    /// The largest per-pixel threshold, where the feature has one.
    pub(crate) fn level_max(self, pixel_max: u32) -> Option<u32> {
        match self {
            Self::Edge => Some(edge_magnitude_max(pixel_max)),
            Self::Corner => Some(pixel_max),
            Self::Mad | Self::Variance => None,
        }
    }

    /// Units of the score that are one unit of `min_score`, for regions of `n` pixels.
    pub(crate) fn unit(self, n: u64, fraction_bits: u32) -> u64 {
        match self {
            Self::Edge | Self::Corner => 1,
            Self::Mad => n << fraction_bits,
            Self::Variance => n * n,
        }
    }

    /// The largest score that a region of `n` pixels can have.
    pub(crate) fn score_max(self, n: u64, pixel_max: u64, fraction_bits: u32) -> u64 {
        match self {
            Self::Edge | Self::Corner => n,
            Self::Mad => mad_score_max(n, pixel_max, fraction_bits),
            Self::Variance => variance_score_max(n, pixel_max),
        }
    }

    /// How the mean is formed, where the feature has one; and its accumulators of squares.
    pub(crate) fn sums(
        self,
        n: u64,
        pixel_max: u64,
        fraction_bits: u32,
    ) -> (Option<Mean>, Option<Variance>) {
        match self {
            Self::Edge | Self::Corner => (None, None),
            Self::Mad => (Some(Mean::new(n, pixel_max, fraction_bits)), None),
            Self::Variance => (None, Some(Variance::new(n, pixel_max))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What asks only one of the two would forget the other.
    #[test]
    fn levels_belong_to_features_that_count_hits() {
        for kind in FeatureKind::ALL {
            let counts = kind.has_window();
            assert_eq!(kind.level_max(255).is_some(), counts, "{kind}");
            assert_eq!(kind.defaults().level.is_some(), counts, "{kind}");
            assert_eq!(kind.trial_levels().is_empty(), !counts, "{kind}");
            assert_eq!(kind.measure().is_count(), counts, "{kind}");
        }
    }
}
